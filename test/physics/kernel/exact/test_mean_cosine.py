"""The mean of cos(theta) over a nutation, compared with the complete elliptic integrals."""

import math

import numpy as np
import pytest
from physics.tops import EPS, FAMILIES, random_case
from trials import trials

from symtop_ros.physics import Motion, State, Top
from workshop.digits import ClosedForm

# The middle of both heights is rounded once; of the sum, which is at most 1, each of the few terms
# that count is a product of 5 rounded numbers, and the c in them have lost 3 roundings each.
PROMISE = 16 * EPS
DIGITS = 80  # u3 may exceed 1 by 30 digits, all of which E/K loses


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("count", trials(20, 400))
def test_it_is_that_of_the_elliptic_integrals(family, count):
    tried = 0
    for seed in range(count):
        case = random_case(seed, family)
        exact = ClosedForm(case.inputs, DIGITS).mean_cosine
        if math.isnan(exact):
            continue
        found = Motion(case.top, case.start).mean_cosine
        assert abs(found - exact) <= PROMISE, (seed, family)
        tried += 1
    assert tried > count / 2


@pytest.mark.parametrize("Mgl", [2.0, -2.0, 0.0])
@pytest.mark.parametrize("clamped", [False, True])
def test_it_is_that_of_the_states_at_equal_times(Mgl, clamped):
    """Equal steps over a period sum a smooth function to all digits; the states have some EPS."""
    start = State.from_euler(theta=1.0, phi_dot=0.5, psi_dot=1.0, theta_dot=0.25)
    motion = Motion(Top(1.0, 0.5, Mgl), start, clamped=clamped)
    times = np.linspace(0.0, motion.nutation_period, 512, endpoint=False)
    w, x, y, z = motion.at(times).orientation.T
    heights = (w * w + z * z) - (x * x + y * y)
    assert motion.mean_cosine == pytest.approx(math.fsum(heights) / 512, abs=64 * EPS)


@pytest.mark.parametrize("sign", [1, -1])
def test_an_axis_that_approaches_a_pole_for_ever_is_there_in_the_mean(sign):
    # horizontal, without momentum, with just the energy of the weight at its highest point
    start = State((0.5, 0.5, 0.5, 0.5), (-2.0 * sign, 0.0, 0.0))
    motion = Motion(Top(1.0, 0.5, 2.0 * sign), start)
    assert motion.kind == "asymptotic"
    assert motion.mean_cosine == sign


def test_an_axis_that_rests_on_a_pole_is_there_in_the_mean():
    sleeping = Motion(Top(1.0, 0.5, 1.0), State((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 3.0)))
    assert sleeping.mean_cosine == -1.0
