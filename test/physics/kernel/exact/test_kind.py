"""The seven kinds of motion for either sign of Mgl, its mean rates, and reversal of the spin."""

import math

import numpy as np
import pytest
from drawn import PI, Numbers
from physics.tops import ARTICLE, EPS, SLOW, find_roots, random_case

from symtop_ros.physics import (
    Motion,
    State,
    Top,
    apply_impulse,
    perrys_rule,
)

KINDS = {
    "cusps": {"theta": 0.5, "psi_dot": 200.0},
    "looping": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": -8.0},
    "unidirectional": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": 9.0},
    "sleeping": {"theta": 0.0, "psi_dot": 200.0},
    "through the pole": {"theta": 1.0, "theta_dot": -20.0},
    "regular": {"theta": 0.5, "psi_dot": 200.0, "phi_dot": SLOW},
}


@pytest.mark.parametrize(("kind", "start"), KINDS.items())
def test_a_kind_is_the_same_upside_down(kind, start):
    upright = Motion(ARTICLE, State.from_euler(**start))
    Ix, Iz, Mgl = ARTICLE.moments
    w, x, y, z = upright.start.orientation
    motion = Motion(Top(Ix, Iz, -Mgl), State((-x, w, -z, y), upright.start.angular_velocity))
    assert motion.kind == upright.kind == kind
    low, high = upright.turning_angles
    assert motion.turning_angles == pytest.approx((math.pi - high, math.pi - low), abs=1e-15)


SLEEPERS = [
    (0.068, True, 1.0 + 1e-12, True),
    (0.068, True, 1.0 - 1e-12, False),
    (0.068, False, 0.0, True),
    (-0.068, False, 0.9, False),
    (-0.068, False, 1.1, True),
    (0.0, True, 0.0, False),
    (0.0, True, 1e-9, True),
    (0.0, False, 0.0, False),
]


@pytest.mark.parametrize(("Mgl", "upright", "factor", "stable"), SLEEPERS)
def test_stability_of_sleeping_is_told_for_either_pole(Mgl, upright, factor, stable):
    top = Top(0.000228, 0.0000572, Mgl)
    q = (1.0, 0.0, 0.0, 0.0) if upright else (0.0, 1.0, 0.0, 0.0)
    state = State(q, (0.0, 0.0, factor * ARTICLE.critical_spin))
    assert top.sleeping_is_stable(state) is stable
    assert perrys_rule(top, state).reason.kind == ("stable" if stable else "unstable")


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"sleeping"}))
def test_a_kind_is_the_same_from_any_state_of_the_motion(kind):
    motion = Motion(ARTICLE, State.from_euler(**KINDS[kind], phi=0.3, psi=-1.1))
    assert motion.kind == kind
    states = motion.at(np.linspace(0.0, 7.3 * motion.nutation_period, 1000))
    for q, omega in zip(*states._parts, strict=True):
        assert Motion(ARTICLE, State(q, omega)).kind == kind


def test_a_kind_is_the_same_from_any_state_within_rounding_of_a_turning_point():
    motion = Motion(ARTICLE, State.from_euler(**KINDS["cusps"], phi=0.3, psi=-1.1))
    times = motion.nutation_period * (3 + np.geomspace(1e-16, 1e-3, 300))
    for q, omega in zip(*motion.at(times)._parts, strict=True):
        assert Motion(ARTICLE, State(q, omega)).kind == "cusps"


def list_regular_starts(seed):
    """Tops within 0.05 rad of the horizontal on either root, and the number of the root."""
    rng = Numbers(seed)
    for _ in range(150):
        top = Top(ARTICLE.Ix, ARTICLE.Ix * rng.uniform(0.05, 1.9), rng.choice((0.068, -0.068)))
        theta = PI / 2 + rng.uniform(-0.05, 0.05)
        spin = rng.uniform(-400, 400)
        for root, phi_dot in enumerate(find_roots(top, theta, spin)):
            angles = {"theta": theta, "phi": rng.uniform(-3, 3), "psi": rng.uniform(-3, 3)}
            yield root, top, State.from_euler(**angles, phi_dot=phi_dot, psi_dot=spin)


def test_a_regular_precession_next_to_the_horizontal_is_regular_at_any_time():
    for _, top, start in list_regular_starts(70):
        motion = Motion(top, start)
        assert motion.kind == "regular"
        for state in motion.at(motion.nutation_period * np.array([0.3, 7.7, 1e3])):
            assert Motion(top, state).kind == "regular"


def test_a_rate_next_to_the_horizontal_is_found_at_its_root():
    for root, top, start in list_regular_starts(71):
        verdict = perrys_rule(top, start)
        assert verdict.reason.place.kind == ("slow", "fast")[root]
        assert verdict.reason.theta_ddot_without == 0
        assert verdict.direction == "stays"


def test_a_state_of_an_asymptotic_motion_belongs_to_one_that_passes_the_pole():
    # Exactly on the separatrix: u = 0, omega_y = Iz omega_z/Ix and omega_xy^2 = 2 Mgl/Ix.
    for x, y in ((2.0, 0.0), (1.5, -2.25), (0.25, 3.0), (-4.75, 1.0)):
        top = Top(1.0, 0.5, (x * x + y * y) / 2)
        motion = Motion(top, State((0.5, 0.5, 0.5, 0.5), (x, y, 2 * y)))
        assert motion.kind == "asymptotic"
        for state in motion.at([-1.7, -0.3, 0.1, 0.2, 0.6]):
            assert Motion(top, state).kind in ("asymptotic", "through the pole")


@pytest.mark.parametrize("phi", np.linspace(-3.0, 3.0, 40).tolist())
def test_a_plane_pendulum_goes_through_the_pole_in_any_direction(phi):
    for theta, theta_dot in ((0.7, 0.0), (2.0, 3.0), (1.0, -40.0)):
        start = State.from_euler(theta=theta, theta_dot=theta_dot, phi=phi, psi=2.2 * phi + 0.1)
        motion = Motion(ARTICLE, start)
        assert motion.kind == "through the pole"
        assert math.isnan(motion.mean_precession_rate)
        assert math.isnan(motion.mean_spin_rate)


@pytest.mark.parametrize("phi_dot", [1e-16, -1e-16, 1e-17])
def test_a_precession_of_rounding_size_is_a_cusp(phi_dot):
    start = State.from_euler(**KINDS["cusps"], phi=0.3, phi_dot=phi_dot)
    assert Motion(ARTICLE, start).kind == "cusps"


@pytest.mark.parametrize(("spin", "farthest"), [(0.0, math.pi), (1.0, 2e-6)])
def test_without_weight_only_a_spin_keeps_a_kicked_axis_near_the_vertical(spin, farthest):
    top = Top(1.0, 1.0, 0.0)
    state = State((1, 0, 0, 0), (0, 0, spin))
    kicked = Motion(top, apply_impulse(top, state, (1e-6, 0.0, 0.0)))
    assert kicked.turning_angles == pytest.approx((0.0, farthest), rel=1e-9, abs=1e-15)
    assert top.sleeping_is_stable(state) == (farthest < 1e-3)


@pytest.mark.parametrize("theta", [0.0, 0.5, math.pi])
def test_a_top_without_momentum_stays_at_its_tilt(theta):
    start = State.from_euler(theta=theta)
    angles = Motion(Top(1.0, 0.5, 0.0), start).turning_angles
    assert angles == pytest.approx((theta, theta), abs=4e-16)  # a rounding of pi
    hanging = Motion(Top(1.0, 0.5, 1.0), State((0, 1, 0, 0), (0, 0, 0)))
    assert hanging.turning_angles == (math.pi, math.pi)


def test_the_critical_spin_itself_is_stable():
    rng = np.random.default_rng(1)
    for Ix, ratio, Mgl in zip(*rng.uniform(0.01, 2.0, (3, 300)), strict=True):
        top = Top(Ix, Ix * ratio, Mgl)
        sleeping = State((1, 0, 0, 0), (0, 0, top.critical_spin))
        assert top.sleeping_is_stable(sleeping)
        assert not top.sleeping_is_stable(State((1, 0, 0, 0), (0, 0, top.critical_spin * 0.999)))
    huge = Top(1e100, 1e100, 1e-100)
    assert huge.sleeping_is_stable(State((1, 0, 0, 0), (0, 0, 1.0)))


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


@pytest.mark.parametrize("tilt", [1e-3, 1e-7, 1e-9, 1e-12])
@pytest.mark.parametrize("is_hanging", [False, True])
def test_without_weight_the_spin_reverses_next_to_the_vertical_as_anywhere(tilt, is_hanging):
    rng = Numbers(f"reversal {tilt} {is_hanging}")
    reversing = 0
    for _ in range(300):
        theta = tilt * rng.uniform(0.5, 2.0)
        spin = rng.choice([-1.0, 1.0]) * rng.power(-2, 2)
        rates = {name: spin * rng.uniform(-3.0, 3.0) for name in ("phi_dot", "psi_dot")}
        rates["theta_dot"] = spin * tilt * rng.uniform(-3.0, 3.0)
        start = State.from_euler(theta=PI - theta if is_hanging else theta, **rates)
        motion = Motion(Top(1.0, rng.uniform(0.05, 2.0), 0.0), start)
        spins = sampled_spin(motion)
        low, high = spins.min() / np.abs(spins).max(), spins.max() / np.abs(spins).max()
        if min(abs(low), abs(high)) > 1e-5:  # 2001 samples may miss less, as above
            assert motion.spin_reverses == (low < 0 < high), motion
            reversing += motion.spin_reverses
    assert 20 < reversing < 290


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
