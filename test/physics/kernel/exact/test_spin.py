"""Reversal of the spin, precession in a nutation, and the approximations of the fast top."""

import math

import numpy as np
import pytest
from physics.tops import ARTICLE, EPS, random_case

from symtop_ros.physics import Motion, State, Top

CASES = [random_case(seed, "any") for seed in range(400)]
MOTIONS = [  # each fifth one without weight
    Motion(Top(case.top.Ix, case.top.Iz, case.top.Mgl if k % 5 else 0.0), case.start)
    for k, case in enumerate(CASES)
]
SAMPLES = 2001


def sampled_spin(motion):
    """psi' sin^2(theta) of a nutation: no quotient, so that poles do no harm."""
    period = motion.nutation_period
    states = motion.at(np.linspace(0.0, period if math.isfinite(period) else 0.0, SAMPLES))
    (gx, gy, gz), (wx, wy, wz) = states.vertical.T, states.angular_velocity.T
    spins = wz * (gx**2 + gy**2) - gz * (wx * gx + wy * gy)
    # A pendulum has no spin but that of rounding.
    spins[np.abs(spins) < 64 * EPS * np.hypot(wx, wy).max() * np.hypot(gx, gy).max()] = 0.0
    return spins


def test_the_spin_reverses_where_samples_of_a_nutation_have_both_signs():
    reversing = 0
    for motion in MOTIONS:
        spins = sampled_spin(motion)
        size = np.abs(spins).max()
        low, high = spins.min() / (size or 1.0), spins.max() / (size or 1.0)
        # within a millionth of zero 2001 samples may miss the extreme value
        if min(abs(low), abs(high)) > 1e-6:
            assert motion.spin_reverses == (low < 0 < high), motion
            reversing += motion.spin_reverses
    assert 40 < reversing < 300


def test_the_precession_of_a_nutation_is_the_mean_rate_over_its_period():
    for motion in MOTIONS:
        turns = motion.mean_precession_rate * motion.nutation_period / (2 * math.pi)
        if math.isfinite(turns):
            assert motion.precession_per_nutation == pytest.approx(turns, rel=4 * EPS)


@pytest.mark.parametrize("Mgl", [0.068, -0.068, 0.0])
@pytest.mark.parametrize("phi_dot", [5.0, -5.0, 90.0])
def test_a_spin_that_starts_at_zero_at_a_turning_point_does_not_reverse(Mgl, phi_dot):
    top = Top(ARTICLE.Ix, ARTICLE.Iz, Mgl)
    motion = Motion(top, State.from_euler(theta=0.5, phi_dot=phi_dot))
    spins = sampled_spin(motion)
    has_both = spins.min() < -1e-9 * abs(spins).max() and spins.max() > 1e-9 * abs(spins).max()
    assert motion.spin_reverses == has_both


def test_a_top_at_rest_and_a_sleeping_top_do_not_reverse():
    for top in (ARTICLE, Top(1.0, 0.5, 0.0)):
        for spin in (0.0, 200.0, -3.0):
            assert not Motion(top, State.from_euler(theta=0.0, psi_dot=spin)).spin_reverses
    resting = Motion(Top(1.0, 0.5, 0.0), State.from_euler(theta=1.0))
    assert not resting.spin_reverses
    assert math.isnan(resting.precession_per_nutation)


@pytest.mark.parametrize("psi_dot", [1e3, 1e4, 1e5, -1e5])
def test_the_approximations_become_exact_for_a_fast_top(psi_dot):
    motion = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=psi_dot))
    # the next terms of the expansions in 4 Ix Mgl/p_psi^2, with factors up to 1
    error = 4 * ARTICLE.Ix * ARTICLE.Mgl / (ARTICLE.Iz * psi_dot) ** 2
    rate = motion.mean_precession_rate
    assert motion.fast_top_precession_rate == pytest.approx(rate, rel=error)
    assert motion.fast_top_nutation_rate == pytest.approx(motion.nutation_rate, rel=error)


def test_without_spin_there_is_no_approximation():
    motion = Motion(ARTICLE, State.from_euler(theta=0.5))
    assert math.isnan(motion.fast_top_precession_rate)
    assert motion.fast_top_nutation_rate == 0.0
