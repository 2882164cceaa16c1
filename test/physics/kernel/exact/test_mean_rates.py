"""Mean phi' and psi' keep their digits, however much of their terms cancels."""

import pytest
from physics.tops import EPS

from symtop_ros.physics import Motion, State, Top

WEIGHTS = [10.0**-n for n in (20, 30, 35, 40, 50, 100, 150, 190)]
OMEGA = (1.0, 2.0, -0.5)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_the_mean_spin_of_a_sphere_is_proportional_to_a_weak_weight(weight):
    q = State((0.8, 0.36, -0.24, 0.416), OMEGA).orientation
    rate = Motion(Top(1, 1, weight), State(q, OMEGA)).mean_spin_rate
    assert rate / weight == pytest.approx(0.21389419546691283, rel=4 * EPS)  # by 110 digits
