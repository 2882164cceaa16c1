"""Mean phi' and psi' keep their digits, however much of their terms cancels."""

import math

import pytest
from drawn import ten_to
from mpmath import mp, mpf
from physics.tops import EPS, FAMILIES, random_case

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.reference import ClosedForm, Inputs

WEIGHTS = [ten_to(-n) for n in (20, 30, 35, 40, 50, 100, 150, 190)]
OMEGA = (1.0, 2.0, -0.5)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_the_mean_spin_of_a_sphere_is_proportional_to_a_weak_weight(weight):
    q = State((0.8, 0.36, -0.24, 0.416), OMEGA).orientation
    rate = Motion(Top(1, 1, weight), State(q, OMEGA)).mean_spin_rate
    assert rate / weight == pytest.approx(0.21389419546691283, rel=4 * EPS)  # by 110 digits


@pytest.mark.parametrize("weight", WEIGHTS)
@pytest.mark.parametrize("Iz", [1.0, 1.0 + 2.0**-52, 0.5])
def test_mean_rates_under_a_weak_weight_are_exact(weight, Iz):
    top, start = Top(1.0, Iz, weight), State((0.8, 0.36, -0.24, 0.416), OMEGA)
    assert_exact(Motion(top, start), ClosedForm(Inputs.of(top, start), 300))


@pytest.mark.parametrize("family", FAMILIES)
def test_mean_rates_of_random_tops_are_exact(family):
    compared = 0
    for seed in range(12):
        case = random_case(seed, family)
        if math.isfinite(case.motion.mean_precession_rate):  # nan through a pole
            assert_exact(case.motion, ClosedForm(case.inputs, 80))
            compared += 1
    assert compared > 6


def assert_exact(motion, exact):
    """Assert rates of one rounding each, unless a rate is zero but for the digits of the other."""
    assert motion.nutation_period == pytest.approx(float(exact.period), rel=2 * EPS)
    found = motion.mean_precession_rate, motion.mean_spin_rate
    with mp.workdps(60):
        for rate, right in zip(found, exact.mean_rates, strict=True):
            assert abs(mpf(rate) - right) <= EPS * abs(right), (rate, right)
