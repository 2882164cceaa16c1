"""The tilt of an axis near the vertical keeps its digits (test_exact_motions.py has the rest)."""

import random

import pytest
from mpmath import mp
from physics.tops import ARTICLE, EPS, Case, exact_euler

from symtop_ros.physics import Motion, State

pytestmark = pytest.mark.untraced


@pytest.mark.parametrize("theta_dot", [-20.0, 30.0, -60.0])
def test_an_axis_that_passes_the_pole_keeps_the_digits_of_its_tilt(theta_dot):
    start = State.from_euler(theta=0.9, theta_dot=theta_dot, phi=0.3)
    motion, chance = Motion(ARTICLE, start), random.Random(theta_dot)
    times = [chance.uniform(1.0, 1e6) for _ in range(1000)]
    tilts = zip(times, motion.at(times).euler_angles.theta.tolist(), strict=True)
    for t, tilt in [each for each in tilts if 1e-3 < each[1] < 0.05][:8]:
        with mp.workdps(30):
            (_, theta, _), _ = exact_euler(*Case(ARTICLE, start, t).exact)
            # As promised. Below 1e-3 rad 2^-62 of a turn, to which phases are known, counts.
            assert abs(tilt - theta) <= 4 * EPS * theta
