"""The motion as a function of time, its constants, and the effective potential."""

import copy
import math
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, EPS

from symtop_ros.physics import EffectivePotential, Friction, Motion, State, Top, balance
from symtop_ros.physics.dynamics import NODES

pytestmark = pytest.mark.numbers


@pytest.mark.parametrize("friction", [Friction(), Friction(2e-6, 1e-5)])
@pytest.mark.parametrize("shape", [(), (0,), (1,), (7,), (2, 3)])
def test_shapes_follow_those_of_the_times(shape, friction):
    state = Motion(ARTICLE, CUSPS, friction).at(np.ones(shape))
    assert state.orientation.shape == (*shape, 4)
    assert state.angular_velocity.shape == (*shape, 3)


COPIES = (
    copy.copy,
    copy.deepcopy,
    lambda m: pickle.loads(pickle.dumps(m)),
    lambda m: m.restart(CUSPS),
)


@pytest.mark.parametrize("make", COPIES)
def test_a_copy_shares_no_integration_and_gives_the_same_states(make):
    motion = Motion(ARTICLE, CUSPS, Friction(axial=2e-6))
    before = motion.at(0.7)
    other = make(motion)
    assert other._kernel is not motion._kernel
    assert other._reach(0.7, 0) < 0.7
    assert other.at(0.7) == before


def test_threads_share_a_motion_with_friction():
    motion = Motion(ARTICLE, CUSPS, Friction(axial=2e-6))
    times = np.random.default_rng(3).uniform(-0.5, 1.0, 120).tolist()
    expected = Motion(ARTICLE, CUSPS, Friction(axial=2e-6)).at(times)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)  # so that every call is interrupted
    try:
        with ThreadPoolExecutor(8) as pool:
            states = list(pool.map(motion.at, times))
    finally:
        sys.setswitchinterval(interval)
    for k, state in enumerate(states):
        assert state.orientation.tolist() == expected.orientation[k].tolist()


@pytest.mark.parametrize("top", [ARTICLE, Top(2e-4, 3e-4, -0.05)])
def test_the_start_has_the_same_signs_of_zero_alone_and_among_others(top):
    start = State((0.0, -1.0, 0.0, 0.0), (0.0, 1e-3, -0.0))
    motion = Motion(top, start)
    alone = motion.at(0.0)
    among = motion.at([0.0, 1e-9, 1.0])
    assert np.signbit(alone.orientation).tolist() == np.signbit(among.orientation[0]).tolist()
    assert alone.orientation.tolist() == among.orientation[0].tolist()


def test_tiny_turning_angles_of_a_hanging_top_are_right_to_their_rounding():
    start = State.from_euler(theta=1e-14, phi_dot=0.3, psi_dot=300.0)
    motion = Motion(Top(2e-4, 1e-4, -0.05), start)
    low, high = motion.turning_angles
    angles = motion.at(np.linspace(0, motion.nutation_period, 4001)).euler_angles.theta
    assert low * (1 - 8 * EPS) <= angles.min() <= angles.max() <= high * (1 + 8 * EPS)
    # between two of the samples theta changes by the square of a phase of 2 pi/4000, 2e-6 of it
    assert angles.min() == pytest.approx(low, rel=1e-5)
    assert angles.max() == pytest.approx(high, rel=1e-5)


MOTIONS = {
    "closed form": Motion(ARTICLE, CUSPS),
    "free": Motion(Top(ARTICLE.Ix, ARTICLE.Iz, 0.0), CUSPS),
    "friction": Motion(ARTICLE, CUSPS, Friction(2e-6, 1e-5)),
    "torque": Motion(ARTICLE, CUSPS, Friction(), (1e-3, -2e-3, 1e-4)),
    "both": Motion(ARTICLE, CUSPS, Friction(1e-5, 1e-4), (0.0, 0.01, 0.02)),
}
# a sum of 24 terms, each with the rounding of a state
ROUNDING = NODES * EPS


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("end", [0.05, 2.0, -1.0])
def test_energy_and_angular_momentum_balance(name, end):
    motion = MOTIONS[name]
    top = motion.top
    state = motion.at(end)
    found = balance(motion, end, longest=1.0)
    energy = np.abs(top.body_angular_momentum(state) * state.angular_velocity).sum() + abs(top.Mgl)
    assert abs(found.energy) < ROUNDING * energy
    momentum = np.linalg.norm(top.angular_momentum(state))
    assert np.abs(found.angular_momentum).max() < ROUNDING * momentum


def test_a_motion_that_is_wrong_does_not_balance():
    class Wrong(Motion):
        def at(self, t):
            return super().at(np.asarray(t) * (1 + 1e-9))

    found = balance(Wrong(ARTICLE, CUSPS), 2.0, longest=1.0)
    assert np.abs(found.angular_momentum).max() > 1e-10 * ARTICLE.Mgl / 50


STARTS = {
    "cusps": State.from_euler(theta=0.5, psi_dot=200.0),
    "looping": State.from_euler(theta=0.5, phi_dot=-3.0, psi_dot=200.0),
    "unidirectional": State.from_euler(theta=0.5, phi_dot=9.0, psi_dot=200.0),
    "through the pole": State.from_euler(theta=0.5, theta_dot=30.0),
    "small tilt": State.from_euler(theta=1e-4, theta_dot=1e-2, psi_dot=100.0),
}
TOPS = {"above": ARTICLE, "below": Top(ARTICLE.Ix, ARTICLE.Iz, -ARTICLE.Mgl)}


def everywhere(test):
    """Run a test with each top and each start."""
    tops = pytest.mark.parametrize("top", TOPS.values(), ids=TOPS)
    return tops(pytest.mark.parametrize("start", STARTS.values(), ids=STARTS)(test))


def terms(top, potential):
    """Size in J of the terms whose rounding is in U_eff and in E'."""
    kinetic = potential.energy + abs(top.Mgl)
    return abs(top.Mgl) + abs(kinetic) + potential.axial_momentum**2 / top.Ix


@everywhere
def test_the_energy_line_meets_the_potential_at_the_turning_angles(top, start):
    potential = EffectivePotential.from_state(top, start)
    for angle in Motion(top, start).turning_angles:
        if min(angle, math.pi - angle) > 1e-6:
            # near a pole the rounding of p_phi - p_psi is divided by sin^2
            margin = 16 * EPS * terms(top, potential) / math.sin(angle) ** 2
            assert potential.at(angle) == pytest.approx(potential.energy, abs=margin)


@everywhere
def test_the_cubic_is_the_square_of_the_rate_of_u(top, start):
    motion = Motion(top, start)
    potential = EffectivePotential.from_state(top, start)
    states = motion.at(np.linspace(0.0, 1.0, 50))
    rate = np.sin(states.euler_angles.theta) * states.euler_rates.theta_dot
    u = states.vertical[:, 2]
    scale = terms(top, potential) / top.Ix
    np.testing.assert_allclose(potential.cubic(u), rate**2, rtol=0, atol=32 * EPS * scale)


@everywhere
def test_the_cubic_vanishes_at_its_three_roots(top, start):
    motion = Motion(top, start)
    potential = EffectivePotential.from_state(top, start)
    low, high = motion.turning_angles
    third = potential.find_third_root(low, high)
    assert abs(third) >= 1 - 16 * EPS
    scale = terms(top, potential) / top.Ix
    for root in (math.cos(low), math.cos(high), third):
        # (1 - u^2)(alpha - beta u) grows with the cube of the third root
        assert abs(potential.cubic(root)) <= 64 * EPS * scale * max(1.0, abs(root)) ** 3


def test_a_top_without_weight_has_no_third_root():
    start = STARTS["looping"]
    top = Top(ARTICLE.Ix, ARTICLE.Iz, 0.0)
    assert EffectivePotential.from_state(top, start).find_third_root(0.5, 1.0) == math.inf
