import numpy as np
import pytest

from symtop_ros.physics import Friction, Motion, Top
from workshop.article import torque
from workshop.article.motions import TOP, cusps, regular, start

DISC = Top(1.0, 1.9, 0.5)


@pytest.mark.parametrize("top", [TOP, DISC, Top(2.0, 2.0, 1.0)], ids=["article", "disc", "sphere"])
def test_inertia_and_its_change_agree_with_euler_for_any_top(top):
    assert torque.inertia_has_its_components(top).holds
    assert torque.fixed_frame_agrees_with_euler(top).holds


def test_the_change_of_inertia_is_the_derivative_of_its_formulas():
    motion, step = cusps(), 1e-6
    times = np.linspace(0.0, 0.1, 20)
    before, after = (
        torque.inertia_in_world(TOP, *motion.at(times + h).euler_angles[:2]) for h in (-step, step)
    )
    found = torque.inertia_change(TOP, motion.at(times))
    # a central difference: its error is the step squared, times rates of 40 rad/s cubed, and
    # rounding over the step
    np.testing.assert_allclose((after - before) / (2 * step), found, rtol=0, atol=1e-8 * TOP.Ix)


def test_a_formula_with_one_wrong_sign_is_detected(monkeypatch):
    right = torque.inertia_in_world

    def wrong(*arguments):
        inertia = right(*arguments)
        inertia[:, 0, 1] *= -1
        return inertia

    monkeypatch.setattr(torque, "inertia_in_world", wrong)
    assert not torque.inertia_has_its_components(TOP).holds
    assert not torque.fixed_frame_agrees_with_euler(TOP).holds


def test_the_inertial_torque_is_the_difference_under_friction_too():
    rubbing = Motion(TOP, start(0.0), Friction(axial=2e-6, transverse=1e-5))
    assert torque.inertial_torque_is_the_difference(rubbing).holds


def test_cusps_are_not_taken_for_regular_precession():
    assert not torque.torque_is_across_momentum(cusps()).holds
    assert not torque.precession_alone_balances_gravity(cusps(), cusps()).holds
    assert not torque.precession_alone_balances_gravity(regular(), regular()).holds
