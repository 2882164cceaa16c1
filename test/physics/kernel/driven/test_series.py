"""The engine for friction and applied torques against formulas, the closed form, and itself.

test_exact_motions.py compares it with many digits.
"""

import math
import shutil
import subprocess
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from drawn import Numbers
from physics.exact_motions import read_motions
from physics.tops import (
    ARTICLE,
    CUSPS,
    EPS,
    attitude_error,
    distance,
    error,
    follow_exactly,
)
from trials import choose, seeds

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top
from symtop_ros.physics.kernel import library

pytestmark = pytest.mark.untraced
FRICTION = Friction(2e-6, 1e-5)
CASES = 500  # of a seed


# It changes no bit of a state, and makes a motion under gravity one that is integrated.
HARDLY_ANY = Friction(1e-300, 1e-300)


def steps_to(motion, t):
    """Return the number of steps on the way to t."""
    steps = 0
    while motion._reach(t, 1) != t:
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
    assert motion._reach(1e300, 0) == 1e300
    assert motion.at([1e300, -1e9]).orientation.tolist() == [[1, 0, 0, 0]] * 2


@pytest.mark.parametrize("nanoseconds", choose((999_999_937, 9_999_999_967), (999_999_937,)))
def test_exact_times_are_not_rounded_to_doubles(nanoseconds):
    times = ExactTimes(np.array([5, nanoseconds]), factor=0.7, elapsed=Fraction(1, 4))
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    t = (times.elapsed + Fraction(times.factor) * nanoseconds) / 10**9
    # as at times that are doubles; as a double the time would be off by 400 eps in the second case
    exact = State(*(list(map(float, part)) for part in follow_exactly(motion).at(t)))
    assert distance(motion.at(times)[1], exact) < 2 * EPS
    assert motion.at(ExactTimes(nanoseconds, times.factor, times.elapsed)) == motion.at(times)[1]


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


def test_a_state_is_the_same_bit_for_bit_whatever_was_asked_before():
    times = np.random.default_rng(1).uniform(-8.0, 12.0, 60)  # beyond what is kept at first
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    assert motion.at(0.0) == CUSPS
    together = motion.at(times)
    for k in (0, 7, 33, 59):
        for alone in (motion.at(times[k]), Motion(ARTICLE, CUSPS, FRICTION).at(times[k])):
            assert alone == together[k]


@pytest.mark.parametrize("count", [2, 3, 8, 63, 1000, 3000])
def test_a_state_is_the_same_bit_for_bit_among_any_number_of_others(count):
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    times = np.linspace(0.001, 0.04, count)  # of one step
    together = motion.at(times)
    for k in {0, 1, count // 2, count - 1}:
        alone = motion.at(times[k])
        assert alone == together[k]


# Backwards the spin grows, and the steps become shorter: of the 512 points that are kept every
# other one is dropped twice in 45 s, and four times in 75 s.
@pytest.mark.parametrize("end", choose((75.0, -45.0, -75.0), (75.0, -45.0)))
def test_one_can_come_back_from_anywhere(end):
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    early = 0.321 if end > 0 else -0.321
    first, far = motion.at(early), motion.at(end)
    assert motion.at(early) == first
    assert motion.at(end) == far == Motion(ARTICLE, CUSPS, FRICTION).at(end)


@pytest.mark.parametrize("t", [3.0, -3.0])
def test_reach_goes_as_far_as_its_steps_and_then_the_rest(t):
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    reached = [motion._reach(t, 5) for _ in range(30)]  # which takes 110 steps or so
    assert all(0 < a / t < b / t <= 1 or a == b == t for a, b in pairwise(reached))
    assert reached[0] != t
    assert reached[-1] == t
    assert motion.at(t) == Motion(ARTICLE, CUSPS, FRICTION).at(t)


@pytest.mark.skipif(not shutil.which("g++"), reason="no C++ compiler")
def test_products_by_halves_lose_the_doubles_that_fused_products_lose(tmp_path):
    program, source = tmp_path / "products", Path(__file__).with_name("products.cpp")
    options = ("-std=c++17", "-O2", "-ffp-contract=off", "-Wno-psabi", "-I", library.FILE.parent)
    subprocess.run(["g++", *options, source, "-o", program], check=True)
    printed = subprocess.check_output([program], text=True)
    assert printed == "0 wrong, 1000000 taken, others refused\n"


KINDS = "friction", "a torque", "both", "friction next to the vertical"
FARTHEST = 50  # rad that a body turns, or so: the digits of it take some tenths of a second


def draw_driven(rng, kind):
    """A driven motion of some kind, and a time."""
    Ix = rng.power(-4, -3)
    top = Top(Ix, Ix * rng.uniform(0.05, 1.95), rng.power(-2, -1) * rng.choice([-1, -1, 1, 1, 1]))
    theta = rng.power(-9, -2) if "vertical" in kind else rng.uniform(0.05, 3.1)
    across = theta if "vertical" in kind else rng.uniform(0.0, 20.0)
    spin = rng.uniform(-200.0, 200.0)
    rates = across * rng.uniform(-1.0, 1.0), across * rng.uniform(-1.0, 1.0), spin
    start = State(State.from_euler(theta=theta, phi=rng.uniform(-3, 3)).orientation, rates)
    rubs, pushes = kind != "a torque", kind in ("a torque", "both")
    friction = Friction(rubs * rng.power(-9, -4), rubs * rng.power(-9, -4))
    torque = [pushes * abs(top.Mgl) * rng.uniform(-1.0, 1.0) for _ in range(3)]
    fastest = max(math.sqrt(abs(top.Mgl) / min(*top.moments[:2])), abs(spin), across)
    return Motion(top, start, friction, torque), rng.uniform(0.1, 1.0) * FARTHEST / fastest


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", seeds(2, 500))
def test_random_driven_motions_are_as_right_as_the_docs_say(kind, seed):
    motion, t = draw_driven(Numbers(seed), kind)
    exact = follow_exactly(motion, digits=45).at(t)
    found = motion.at(t)
    fastest = np.abs(motion.at(np.linspace(0.0, t, 50)).angular_velocity).max()
    # docs/accuracy.md, where the growth is about the angle by which the body turns
    promised = EPS * (4 + fastest * t / 10)
    assert 2 * attitude_error(exact.orientation, found.orientation) < promised
    assert error(exact.angular_velocity, found.angular_velocity) < promised * fastest


def draw(rng):
    """A small number of any size, or zero."""
    return rng.choice([0.0, rng.power(-320, 0), rng.power(-120, -60)])


def random_motion(rng):
    Ix = rng.power(-3, 3)
    top = Top(Ix, Ix * rng.uniform(0.1, 2.0), draw(rng) * rng.choice([-1, 1]))
    q = rng.choice([(1, 0, 0, 0), (0.6, 0.8, 0, 0), (0.5, 0.5, 0.5, 0.5)])
    start = State(q, [draw(rng) for _ in range(3)])
    friction = Friction(draw(rng) * Ix, draw(rng) * Ix)
    return top, start, friction, [draw(rng) * Ix for _ in range(3)]


WEAK_TORQUES = [
    (Top(1, 1, 0), (0, 0, 1e-99), (1e-170, 0, 0), 2.5e-171),
    (Top(1, 1, 1e-250), (0, 0, 0), (1e-200, 0, 0), 2.5e-201),
]


@pytest.mark.parametrize(("top", "omega", "torque", "turned"), WEAK_TORQUES)
def test_a_torque_of_which_the_square_is_zero_turns_the_top(top, omega, torque, turned):
    state = Motion(top, State((1, 0, 0, 0), omega), torque=torque).at(1.0)
    assert state.orientation[1] == pytest.approx(turned, rel=1e-15)  # torque t^2/(4 Ix)


@pytest.mark.parametrize("seed", seeds(2, 100))
def test_weak_motions_are_finite_and_have_norm_one(seed):
    rng = Numbers(seed)
    for _ in range(CASES):
        arguments = random_motion(rng)
        state = Motion(*arguments).at(rng.choice([1e-3, 1.0, 30.0]))
        assert np.isfinite(state.angular_velocity).all(), arguments
        assert abs(np.linalg.norm(state.orientation) - 1) < 1e-15, arguments
