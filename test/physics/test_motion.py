"""The motion as a function of time: shapes, signs, symmetries, constants."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.tops import EPS, distance, random_case

from symtop_ros.physics import State, Top, motion

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
SEEDS = range(25)


def case_and_path(seed):
    case = random_case(seed, "any")
    return case, motion(case.top, case.start)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_state_is_the_same_bit_for_bit_alone_and_among_others(seed):
    _, path = case_and_path(seed)
    times = np.linspace(-20.0, 30.0, 5001)  # more than one block
    together = path.at(times)
    for i in (0, 1, 7, 4095, 4096, 5000):
        alone = path.at(times[i])
        assert alone.orientation.tolist() == together.orientation[i].tolist()
        assert alone.angular_velocity.tolist() == together.angular_velocity[i].tolist()


@pytest.mark.parametrize("shape", [(), (0,), (1,), (7,), (2, 3)])
def test_shapes_follow_those_of_the_times(shape):
    state = motion(ARTICLE, CUSPS).at(np.ones(shape))
    assert state.orientation.shape == (*shape, 4)
    assert state.angular_velocity.shape == (*shape, 3)


def test_lists_of_times_and_unpacking_work():
    orientation, angular_velocity = motion(ARTICLE, CUSPS).at([0.0, 1.0])
    assert orientation.shape == (2, 4)
    assert angular_velocity.shape == (2, 3)


@pytest.mark.parametrize("t", [math.nan, math.inf, -math.inf, [0.0, math.nan]])
def test_a_time_that_is_not_finite_is_refused(t):
    with pytest.raises(ValueError, match=r"t: got .*, allowed are finite times in s"):
        motion(ARTICLE, CUSPS).at(t)


def test_many_states_are_no_start():
    with pytest.raises(ValueError, match="start: got 2 states, allowed is one"):
        motion(ARTICLE, motion(ARTICLE, CUSPS).at([0.0, 1.0]))


@pytest.mark.parametrize("Mgl", [0.0, 5e-324, 1e-300, -1e-15, 1e300])
@pytest.mark.parametrize("t", [1e-300, -1e17, 1.7e308, -1.7e308])
def test_no_number_is_too_large_or_too_small(Mgl, t):
    state = motion(Top(1e-6, 2e-6, Mgl), State.from_euler(theta=1.0, psi_dot=1e7)).at(t)
    assert np.linalg.norm(state.orientation) == pytest.approx(1.0, abs=8 * EPS)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_start_is_met_at_time_zero(seed):
    case, path = case_and_path(seed)
    assert distance(path.at(0.0), case.start) <= 8 * EPS  # a few roundings


@pytest.mark.parametrize("seed", SEEDS)
def test_two_stretches_are_one(seed):
    case, path = case_and_path(seed)
    scale = rate_of(case)
    first, second = 0.7 / scale, 1.9 / scale
    there = motion(case.top, path.at(first)).at(second)
    # the state between is rounded, which an unstable axis magnifies in these 2.6 rad by exp(2.6)
    assert distance(there, path.at(first + second)) <= 16 * EPS * math.exp(2.6)


def rate_of(case):
    """Largest rate of a motion in rad/s."""
    return max(
        np.abs(case.start.angular_velocity).max(), math.sqrt(abs(case.top.Mgl) / case.top.Ix)
    )


@pytest.mark.parametrize("seed", SEEDS)
def test_time_runs_backwards_when_the_rates_do(seed):
    case, path = case_and_path(seed)
    back = motion(case.top, State(case.start.orientation, -case.start.angular_velocity))
    assert distance(path.at(-3.0), back.at(3.0)) <= 16 * EPS  # two results of 8 eps each


@pytest.mark.parametrize("seed", SEEDS)
def test_scaled_units_give_the_same_motion(seed):
    case, path = case_and_path(seed)
    scaled = motion(Top(*(4.0 * moment for moment in case.top.moments)), case.start)
    assert path.at(5.0) == scaled.at(5.0)  # a power of two: bit for bit


@pytest.mark.parametrize("seed", SEEDS)
def test_a_world_turned_over_has_gravity_turned_over(seed):
    case, path = case_and_path(seed)
    Ix, Iz, Mgl = case.top.moments
    w, x, y, z = case.start.orientation
    over = motion(Top(Ix, Iz, -Mgl), State((-x, w, -z, y), case.start.angular_velocity)).at(5.0)
    w, x, y, z = over.orientation
    back = State((x, -w, z, -y), over.angular_velocity)
    assert distance(back, path.at(5.0)) <= 16 * EPS  # signs are exact: two results of 8 eps


@pytest.mark.parametrize("seed", SEEDS)
def test_the_constants_of_motion_are_constant(seed):
    case, path = case_and_path(seed)
    top, start = case.top, case.start
    states = path.at(np.linspace(0.0, 100.0 / rate_of(case), 500))
    size = np.linalg.norm(top.angular_momentum(start))
    largest = float(np.abs(states.angular_velocity).max())
    momentum = max(size, top.Ix * largest)
    energy = momentum * largest + abs(top.Mgl)
    # products of quantities that are right to 8 eps, and to 16 near the separatrix
    assert np.ptp(top.vertical_momentum(states)) <= 64 * EPS * momentum
    assert np.ptp(top.axial_momentum(states)) == 0.0
    assert np.ptp(top.energy(states)) <= 64 * EPS * energy


@pytest.mark.parametrize("seed", SEEDS)
def test_theta_stays_between_the_turning_angles_and_reaches_them(seed):
    case, path = case_and_path(seed)
    period = path.nutation_period
    if not math.isfinite(period):
        return
    theta = path.at(np.linspace(0.0, period, 2001)).euler_angles.theta
    low, high = path.turning_angles
    assert theta.min() >= low - 1e-7 * (high - low) - 16 * EPS  # acos near its end: sqrt(eps)
    assert theta.max() <= high + 1e-7 * (high - low) + 16 * EPS
    near_pole = path.nutation_period * rate_of(case) / 2001
    assert theta.min() - low <= (high - low) * min(1.0, near_pole)
    assert high - theta.max() <= (high - low) * min(1.0, near_pole)


def test_the_nutation_period_and_the_mean_rates_are_those_of_the_motion():
    path = motion(ARTICLE, CUSPS)
    period = path.nutation_period
    start, later = path.at(0.0), path.at(1000 * period)
    assert later.euler_angles.theta == pytest.approx(start.euler_angles.theta, abs=1e-10)
    turns = np.unwrap(path.at(np.linspace(0.0, period, 1001)).euler_angles.phi)
    assert turns[-1] - turns[0] == pytest.approx(path.mean_precession_rate * period, rel=1e-11)
    turns = np.unwrap(path.at(np.linspace(0.0, period, 1001)).euler_angles.psi)
    assert turns[-1] - turns[0] == pytest.approx(path.mean_spin_rate * period, rel=1e-11)


def test_the_nutation_period_agrees_with_quadrature():
    with mp.workdps(30):
        Ix, Iz, Mgl = (mpf(x) for x in ARTICLE.moments)
        u0 = mp.cos(mpf(0.5))
        p_psi = Iz * 200
        a, b = 2 * Mgl / Ix, p_psi / Ix
        # let go at rest: du/dt^2 = (u0 - u) (a (1 - u^2) - b^2 (u0 - u)); its lower root
        u1 = (b**2 - mp.sqrt(b**4 + 4 * a * (a - b**2 * u0))) / (2 * a)

        def speed(angle):
            u = (u0 + u1) / 2 - (u0 - u1) / 2 * mp.cos(angle)
            return 1 / mp.sqrt(a * (b**2 / a - u1 - u))

        exact = float(2 * mp.quad(speed, [0, mp.pi]))
    assert motion(ARTICLE, CUSPS).nutation_period == pytest.approx(exact, rel=4 * EPS)
