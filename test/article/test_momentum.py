import pytest

from symtop_ros.physics import Friction, Motion, State
from workshop.article import momentum
from workshop.article.motions import TOP, cusps, start

RUBBING = Motion(TOP, start(0.0), Friction(axial=2e-6, transverse=1e-5))


@pytest.mark.parametrize("name", ["L_z (along the axis)", "The energy E"])
def test_friction_ends_the_constants(name):
    assert momentum.is_constant(name, [cusps()]).holds
    assert not momentum.is_constant(name, [cusps(), RUBBING]).holds


def test_a_torque_of_another_kind_is_not_along_the_line_of_nodes():
    claim = momentum.torque_is_along_the_line_of_nodes
    assert claim(cusps()).holds
    assert not claim(Motion(TOP, start(0.0), torque=(0.0, 0.0, 1e-4))).holds


@pytest.mark.parametrize("name", ["momentum_changes_by_gravity", "equations_hold"])
def test_under_friction_the_articles_equations_do_not_hold(name):
    claim = getattr(momentum, name)
    assert claim(cusps()).holds
    assert not claim(RUBBING).holds


def test_an_attitude_that_does_not_turn_with_the_angular_velocity_is_detected(monkeypatch):
    motion, at = cusps(), cusps().at
    claim = momentum.attitude_turns_with_the_angular_velocity
    assert claim(motion).holds
    monkeypatch.setattr(
        motion, "at", lambda t: State(at(t).orientation, at(t).angular_velocity + 1e-6)
    )
    assert not claim(motion).holds
