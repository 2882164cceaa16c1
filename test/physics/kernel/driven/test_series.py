"""The engine for friction and applied torques against formulas, the closed form, and itself.

test_exact_motions.py compares it with many digits.
"""

import math
from fractions import Fraction

import numpy as np
import pytest
from physics.exact_motions import read_motions
from physics.refusals import refused
from physics.tops import ARTICLE, CUSPS, EPS, distance, error, follow_exactly

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top

pytestmark = pytest.mark.untraced
LONG = pytest.mark.long
DRIVE = Friction(1e-6, 2e-5), (1e-3, -2e-3, 5e-4)


def exact(motion, t):
    """The state at t as doubles, from 30 digits."""
    return State(*(list(map(float, part)) for part in follow_exactly(motion).at(t)))


# It changes no bit of a state, and makes a motion under gravity one that is integrated.
HARDLY_ANY = Friction(1e-300, 1e-300)


def steps_to(motion, t):
    """Return the number of steps on the way to t."""
    steps = 0
    while motion.reach(t, 1) != t:
        steps += 1
    return steps + 1


@pytest.mark.parametrize(("tiny", "t"), [(1e-30, 1.0), (1e-300, 100.0)])
def test_friction_too_weak_to_be_felt_gives_what_the_closed_form_gives(t, tiny):
    motion = Motion(ARTICLE, CUSPS, Friction(tiny, tiny), (0.0, 0.0, tiny))
    assert motion.engine == "taylor"
    # an ulp of 200 rad/s turns the top by t ulps, of which a tenth is promised
    assert distance(motion.at(t), Motion(ARTICLE, CUSPS).at(t)) < EPS * (2 + 200 * t / 2 / 10)


def test_the_spin_of_a_rod_needs_no_steps():
    rod = Top(Ix=1.0, Iz=1e-8, Mgl=50.0)
    slow, fast = (State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=spin) for spin in (1.0, 1e5))
    friction = Friction(1e-9, 0.1)
    steps = [steps_to(Motion(rod, start, friction), 2.0) for start in (slow, fast)]
    assert steps[1] <= steps[0] + 1


def test_axial_momentum_is_kept_to_the_bit_and_vertical_momentum_to_rounding():
    times = np.linspace(0.0, 20.0, 200)
    found = Motion(ARTICLE, CUSPS, HARDLY_ANY).at(times)
    assert set(found.angular_velocity[:, 2]) == {200.0}
    vertical = ARTICLE.vertical_momentum(found)
    # products of rounded states
    assert np.abs(vertical / vertical[0] - 1).max() < 4 * EPS


def test_a_sleeping_top_spins_down_exponentially_and_stays_upright():
    friction = Friction(axial=1e-5, transverse=2e-5)
    state = Motion(ARTICLE, State.from_euler(theta=0.0, psi_dot=200.0), friction).at(3.0)
    assert state.angular_velocity.tolist()[:2] == [0.0, 0.0]
    assert state.euler_angles.theta == 0.0
    expected = 200 * math.exp(-1e-5 / 5.72e-5 * 3.0)
    assert state.angular_velocity[2] == pytest.approx(expected, rel=2 * EPS)


def test_a_top_at_rest_stays_there_at_any_time_in_one_step():
    motion = Motion(ARTICLE, State.from_euler(theta=0.0), Friction(1e-6, 1e-5))
    assert motion.reach(1e300, 0) == 1e300
    assert motion.at([1e300, -1e9]).orientation.tolist() == [[1, 0, 0, 0]] * 2


@pytest.mark.parametrize("nanoseconds", [999_999_937, pytest.param(9_999_999_967, marks=LONG)])
def test_exact_times_are_not_rounded_to_doubles(nanoseconds):
    times = ExactTimes(np.array([5, nanoseconds]), factor=0.7, elapsed=Fraction(1, 4))
    motion = Motion(ARTICLE, CUSPS, Friction(2e-6, 1e-5))
    t = (times.elapsed + Fraction(times.factor) * nanoseconds) / 10**9
    # as at times that are doubles; as a double the time would be off by 400 eps in the second case
    assert distance(motion.at(times)[1], exact(motion, t)) < 2 * EPS
    assert motion.at(ExactTimes(nanoseconds, times.factor, times.elapsed)) == motion.at(times)[1]


@pytest.mark.parametrize(
    "elapsed", [sum(Fraction(1, 2**n) for n in range(0, 400, 80)), Fraction(1, 2**400)]
)
def test_an_elapsed_time_of_more_digits_than_four_doubles_is_refused(elapsed):
    times = ExactTimes(np.array([10**8, 2 * 10**8]), elapsed=elapsed)
    with refused("elapsed", "a sum of four doubles"):
        Motion(ARTICLE, CUSPS, *DRIVE).at(times)


def test_a_swing_near_the_vertical_is_right_to_rounding_of_itself():
    swings = [each for each in read_motions() if each.family == "driven, a swing near the vertical"]
    assert len(swings) == 16
    for each in swings:
        (t,), (exact,) = each.times, each.states
        across = each.motion.at(np.linspace(0.0, t, 400)).angular_velocity[:, :2]
        off = error(exact.angular_velocity[:2], each.motion.at(t).angular_velocity[:2])
        # two roundings; a body that spins turns by 150 rad, of which the rounding of its spin, half
        # an ulp at the start, is 75 eps of the direction
        spins = each.motion.start.angular_velocity[2] != 0
        assert off < (2 + (100 if spins else 0)) * EPS * np.abs(across).max()
