"""Free motion with impulses of the torque."""

from symtop_ros.physics import Top
from workshop.article.answers import resolution
from workshop.article.motions import cusps


def test_with_another_torque_they_converge_to_another_motion(monkeypatch):
    right = Top.gravity_torque
    monkeypatch.setattr(Top, "gravity_torque", lambda top, state: 1.0001 * right(top, state))
    assert not resolution.resolution_converges(cusps()).holds


def test_a_step_that_is_not_symmetric_is_of_the_first_order(monkeypatch):
    right = resolution.find_errors
    monkeypatch.setattr(resolution, "find_errors", lambda motion, symmetric: right(motion, False))
    assert not resolution.resolution_converges(cusps()).holds
