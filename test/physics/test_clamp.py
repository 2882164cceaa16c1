"""A top whose precession is held: exact states, the hand's torque, the motion when it lets go."""

import copy
import math
import pickle

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.clamped import follow_clamped
from physics.tops import (
    ARTICLE,
    CUSPS,
    DISC,
    EPS,
    FAMILIES,
    attitude_error,
    error,
    exact_euler,
    random_case,
    random_states,
    turn,
)
from trials import seeds

from symtop_ros.physics import (
    ExactTimes,
    Friction,
    Motion,
    Pushes,
    State,
    Top,
    balance,
    set_precession_rate,
)

pytestmark = pytest.mark.numbers

TOPS = [ARTICLE, DISC, Top(2.0**-13, 3 * 2.0**-14, 0.0)]


def find_largest_rate(top, start):
    """The largest |theta'| of a motion."""
    with mp.workdps(50):
        _, (x, y, _) = follow_clamped(top, start, 0)
        w, *across, z = (mpf(each) for each in start.orientation.tolist())
        height = mp.hypot(w, z) if top.Mgl > 0 else mp.hypot(*across)
        return mp.sqrt(x * x + y * y + 4 * abs(mpf(top.Mgl) / mpf(top.Ix)) * height**2)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("first", seeds(1, 20))
def test_states_are_those_of_a_plane_pendulum_that_spins(family, first):
    """The promise of accuracy.md: both signs of Mgl, through the vertical, times up to 1e9 s."""
    for seed in range(40 * first, 40 * (first + 1)):
        case = random_case(seed, family)
        found = Motion(case.top, case.start, clamped=True).at(case.t)
        q, omega = follow_clamped(case.top, case.start, case.t)
        assert 2 * attitude_error(q, found.orientation) <= 20 * EPS, seed
        largest = find_largest_rate(case.top, case.start)
        assert error(omega[:2], found.angular_velocity[:2]) <= 10 * EPS * largest, seed
        assert found.angular_velocity[2] == case.start.angular_velocity[2]


@pytest.mark.parametrize("top", TOPS)
def test_the_torque_is_what_changes_the_angular_momentum(top):
    """That of the hand is across the axle, in its vertical plane."""
    step = mpf(10) ** -12
    for start in random_states(8, 3):
        motion = Motion(top, start, clamped=True)
        state = motion.at(0.0)
        with mp.workdps(40):
            change = [
                (after - before) / (2 * step)
                for before, after in zip(
                    *(find_momentum(top, start, t) for t in (-step, step)), strict=True
                )
            ]
            L = [mpf(each) for each in top.angular_momentum(state).tolist()]
            size = mp.norm(L) * (mp.norm(L) / mpf(top.Ix)) + abs(mpf(top.Mgl))
        assert error(change, motion.total_torque(state), size) <= 20 * EPS
        hand = motion.added_torque(state)
        axis = state.to_world(np.array([0.0, 0.0, 1.0]))
        assert abs(hand @ axis) <= 20 * EPS * np.linalg.norm(hand)
        assert abs(np.cross(axis, (0.0, 0.0, 1.0)) @ hand) <= 20 * EPS * np.linalg.norm(hand)


def find_momentum(top, start, t):
    q, omega = follow_clamped(top, start, t)
    moments = mpf(top.Ix), mpf(top.Ix), mpf(top.Iz)
    return turn(q, [moment * rate for moment, rate in zip(moments, omega, strict=True)])


def test_constants_are_those_of_a_pendulum_and_p_phi_is_none():
    clamped = Motion(ARTICLE, CUSPS, clamped=True)
    pendulum = Motion(ARTICLE, State.from_euler(theta=0.5))
    assert (clamped.kind, clamped.engine, clamped.is_driven) == ("clamped", "closed form", False)
    assert clamped.turning_angles == pendulum.turning_angles == (0.5, math.pi)
    assert clamped.nutation_period == pendulum.nutation_period
    assert not clamped.spin_reverses
    assert (clamped.mean_precession_rate, clamped.mean_spin_rate) == (0.0, 200.0)
    assert math.isnan(clamped.fast_top_precession_rate)
    assert math.isnan(clamped.fast_top_nutation_rate)
    times = np.linspace(0.0, 1.0, 9)
    states = clamped.at(times)
    energies = ARTICLE.energy(states)
    assert np.ptp(energies) <= 40 * EPS * energies.max()
    assert np.ptp(ARTICLE.axial_momentum(states)) == 0.0
    assert np.ptp(ARTICLE.vertical_momentum(states)) > ARTICLE.axial_momentum(CUSPS)


def test_the_rates_of_its_states_are_those_of_a_held_precession():
    clamped = Motion(ARTICLE, CUSPS, clamped=True)
    states = clamped.at(np.linspace(0.0, 1.0, 9))
    phi, theta, psi = clamped.euler_rates(states)
    assert (phi == 0.0).all()
    assert (psi == 200.0).all()
    assert (theta == states.euler_rates.theta_dot).all()
    assert np.abs(states.euler_rates.psi_dot - psi).max() > 0.0  # by rounding
    free = Motion(ARTICLE, CUSPS)
    assert free.euler_rates(CUSPS) == CUSPS.euler_rates


def test_the_clamp_takes_phi_dot_and_keeps_theta_dot_and_the_spin_momentum():
    start = State.from_euler(
        theta=0.5, phi=1.0, psi=-2.0, theta_dot=-3.0, phi_dot=30.0, psi_dot=50.0
    )
    state = Motion(ARTICLE, start, clamped=True).at(0.0)
    assert np.array_equal(state.orientation, start.orientation)
    _, omega = follow_clamped(ARTICLE, start, 0.0)
    assert error(omega, state.angular_velocity, 50.0) <= EPS
    stopped = set_precession_rate(start, 0.0, hold="spin_momentum")
    assert error(omega, stopped.angular_velocity, 50.0) <= 15 * EPS


@pytest.mark.parametrize("top", TOPS)
def test_a_top_that_is_let_go_on_its_way_has_no_precession(top):
    motion = Motion(top, State.from_euler(theta=0.5, theta_dot=-1.0, psi_dot=200.0), clamped=True)
    for t in (0.1, 0.7, 1e3):
        released = motion.restart(motion.at(t))
        assert not released.clamped
        assert released.kind in ("looping", "cusps", "through the pole")
        with mp.workdps(40):
            _, (phi_dot, *_) = exact_euler(*follow_clamped(top, motion.start, t))
        assert abs(phi_dot) < 1e-30


def test_on_the_separatrix_it_comes_to_rest_upright():
    """From the horizontal, theta'^2 = 2 Mgl/Ix, in numbers that doubles have."""
    start = State((0.5, 0.5, 0.5, 0.5), (-1.0, 0.0, 3.0))
    motion = Motion(Top(1.0, 0.5, 0.5), start, clamped=True)
    assert motion.nutation_period == math.inf
    with mp.workdps(30):
        theta = 4 * mp.atan(mp.tan(mp.pi / 8) * mp.exp(-60 / mp.sqrt(2)))
    assert motion.at(60.0).euler_angles.theta == pytest.approx(float(theta), rel=10 * EPS)


def test_the_same_bits_from_one_time_many_and_exact_ones_and_from_copies():
    rng = Numbers(4)
    times = rng.uniforms(-3, 3, 65)
    motion = Motion(DISC, random_states(1, 5)[0], clamped=True)
    many = motion.at(times)
    for each in (motion, copy.copy(motion), pickle.loads(pickle.dumps(motion)), eval(repr(motion))):
        assert all(each.at(t) == many[k] for k, t in enumerate(times.tolist()))
    stamps = np.array([0, 1, 10**9, 7 * 10**12])
    states = motion.at(ExactTimes(stamps))
    assert all(motion.at(ExactTimes(int(stamp))) == states[k] for k, stamp in enumerate(stamps))


UPRIGHT = State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 200.0))
HANGING = State((0.0, 0.6, 0.8, 0.0), (1.0, 0.0, 0.0))


@pytest.mark.parametrize("start", [UPRIGHT, HANGING])
@pytest.mark.parametrize("top", TOPS)
def test_a_vertical_axis_has_no_phi_to_hold(top, start):
    with pytest.raises(ValueError, match="a clamped motion must start with a tilted axis"):
        Motion(top, start, clamped=True)


def test_what_cannot_be_clamped_is_refused():
    with pytest.raises(ValueError, match="must start with a tilted axis, without friction, torque"):
        Motion(ARTICLE, CUSPS, Friction(axial=1e-6), clamped=True)
    with pytest.raises(ValueError, match="without friction, torque"):
        Motion(ARTICLE, CUSPS, torque=(0.0, 0.0, 1e-6), clamped=True)
    with pytest.raises(ValueError, match="pushes must be None for a clamped motion"):
        Motion(ARTICLE, CUSPS, pushes=Pushes(1e-5, 20.0, 3), clamped=True)
    with pytest.raises(ValueError, match="clamped must be True or False, got 1"):
        Motion(ARTICLE, CUSPS, clamped=1)
    with pytest.raises(ValueError, match="start must be one state"):
        Motion(ARTICLE, random_states(3), clamped=True)
    motion = Motion(ARTICLE, CUSPS, clamped=True)
    with pytest.raises(ValueError, match="clamped must be False for derivatives, got True"):
        motion.jacobian(1.0)


@pytest.mark.parametrize("top", TOPS)
def test_energy_and_angular_momentum_change_as_the_torques_say(top):
    start = State.from_euler(theta=0.5, theta_dot=-1.0, psi_dot=200.0)
    found = balance(Motion(top, start, clamped=True), end=2.0, longest=0.1)
    size = float(np.linalg.norm(top.angular_momentum(start)))
    assert abs(found.energy) <= 1e-13 * float(top.energy(start) - top.Mgl)
    assert np.abs(found.angular_momentum).max() <= 1e-12 * size
