"""A series of pushes: exact states, pieces and refusals at every time, with any forces."""

import copy
import itertools
import math
import pickle
from dataclasses import astuple
from fractions import Fraction

import numpy as np
import pytest
from drawn import Numbers
from physics.tops import ARTICLE, CUSPS
from trials import trials

from symtop_ros.physics import (
    ExactTimes,
    Friction,
    Motion,
    Pushes,
    State,
    Top,
    balance,
    push_axle,
    regular_precession_rates,
)
from symtop_ros.physics.reference.series import Inputs
from workshop.digits import Series

pytestmark = pytest.mark.numbers

EPS = 2.0**-52
START = push_axle(ARTICLE, CUSPS, 2.0**-15)
PUSHES = Pushes(2.0**-15, 30.0, 7)  # a third of a second is no whole number of ns
MOTION = Motion(ARTICLE, START, pushes=PUSHES)
BEGINS = [0, 33_333_333, 66_666_667, 100_000_000, 133_333_333, 166_666_667, 200_000_000]
STAMPS = [-(10**8), 0, 7, 33_333_332, 33_333_333, 66_666_667, 10**8, 199_999_999, 10**9]
SLEEPING = State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 200.0))


def find_stretch(motion, stamp):
    """The motion of a stamp, one push after the other, and its begin in ns."""
    now = motion.restart(motion.start)
    begin = 0
    for each in BEGINS[1:]:
        if each > stamp:
            break
        state = now.at(ExactTimes(each - begin))
        now, begin = now.restart(push_axle(motion.top, state, motion.pushes.impulse)), each
    return now, begin


FORCES = [(), (Friction(2.0**-20, 2.0**-18),), (Friction(), (0.0, 0.0, 2.0**-12))]
TOPS = [ARTICLE, Top(*ARTICLE.moments[:2], 0.0), Top(2.0**-13, 3 * 2.0**-14, -0.0625)]


@pytest.mark.parametrize("forces", FORCES)
@pytest.mark.parametrize("top", TOPS)
def test_states_and_pieces_are_those_of_one_push_after_the_other(top, forces):
    """At a stamp of a push it has been given; before the first one the motion goes back in time.

    The start of a piece is that of doubles that are pushed one after the other, to their rounding,
    which a chain of six adds up. The states of the piece alone are those of its start, which is
    rounded: by half an eps of the rates, and so of the attitude for each radian.
    """
    motion = Motion(top, START, *forces, pushes=PUSHES)
    found = motion.at(ExactTimes(np.array(STAMPS)))
    for place, stamp in enumerate(STAMPS):
        now, begin = find_stretch(motion, stamp)
        piece = motion.piece_at(ExactTimes(stamp))
        assert (piece.begin, piece.number) == (begin, BEGINS.index(begin) + 1)
        assert distance(piece.motion.start, now.start) <= 20 * EPS
        own = piece.motion.at(ExactTimes(stamp - begin))
        turned = np.linalg.norm(piece.motion.start.angular_velocity) * abs(stamp - begin) / 1e9
        assert distance(found[place], own) <= (20 + turned) * EPS
        assert found[place] == motion.at(ExactTimes(stamp))
        slow = ExactTimes(4 * stamp - 4, 0.25, Fraction(1))
        assert distance(motion.at(slow), found[place]) <= 20 * EPS


def distance(one, other):
    """Return how far two states are apart, of a quaternion, and of the largest rate."""
    attitude = min(abs(one.orientation - sign * other.orientation).max() for sign in (1, -1))
    rates = abs(one.angular_velocity - other.angular_velocity).max()
    return max(attitude, rates / abs(other.angular_velocity).max())


def draw_chains(count):
    """Tops of either sign of Mgl and of Iz - Ix, on roots and cusps.

    From one push to the next there is a twelfth of a nutation, or thirty.
    """
    rng = Numbers("chains of pushes")
    for _ in range(count):
        Ix, unit = rng.power(-4, -1), rng.power(0, 0.7)
        Iz = Ix * rng.choice([rng.uniform(0.1, 1.0), rng.uniform(1.0, 1.9)])
        top = Top(Ix, Iz, rng.choice([1, -1]) * Ix * unit * unit)
        theta, spin = rng.uniform(0.4, 2.7), rng.uniform(2, 9) * Ix / Iz * unit
        roots = regular_precession_rates(top, theta=theta, psi_dot=spin)
        rate = rng.choice([0.0, *(each for each in roots if math.isfinite(each))])
        start = State.from_euler(theta=theta, phi_dot=rate, psi_dot=spin)
        period = Motion(top, start).nutation_period
        pushes = Pushes(2.0**-9 * Ix * unit, min(rng.power(-1.5, 1.08) / period, 1000.0), 27)
        yield Motion(top, start, pushes=pushes)


def follow_chain(motion, digits=45):
    """Return the exact states at the pushes and a nanosecond before, by Taylor series."""
    inputs = Inputs.of(motion.top, motion.start)
    _, rate, number = astuple(motion.pushes)
    begins = [Pushes(0.0, rate, k + 1).last_time for k in range(number)]
    states = []
    for before, begin in itertools.pairwise(begins):
        series = Series(inputs, digits)
        last, found = (read(series, begin - before - ns) for ns in (1, 0))
        states.append((begin - 1, *last))
        inputs = inputs._replace(
            orientation=found[0], angular_velocity=push(motion, *found, series)
        )
        states.append((begin, inputs.orientation, inputs.angular_velocity))
    return states


def read(series, ns):
    """Return the quaternion and the angular velocity at a time as fractions."""
    scale = Fraction(1, 2**series.bits)
    found = [Fraction(int(each)) * scale for each in series.find(Fraction(ns, 10**9))]
    return found[:4], [each * series.second for each in found[4:]]


def push(motion, q, omega, series):
    w, x, y, z = q
    across = [x * z - w * y, y * z + w * x]
    square = across[0] ** 2 + across[1] ** 2
    sine = Fraction(math.isqrt(int(square * 2 ** (4 * series.bits))), 2 ** (2 * series.bits))
    change = Fraction(motion.pushes.impulse) / Fraction(motion.top.Ix)
    pushed = [rate + change * part / sine for rate, part in zip(omega, across, strict=False)]
    return [*pushed, omega[2]]


@pytest.mark.parametrize("count", trials(1, 300))
def test_states_of_a_chain_are_as_exact_as_those_of_one_motion(count):
    """Pieces carry more digits than a double has: rounding does not add up, nor grow in a piece.

    The promise of any motion is 20 eps of the quaternion and 10 eps of the rates.
    """
    for motion in draw_chains(count):
        assert_promise_is_kept(motion, follow_chain(motion)[::13])


@pytest.mark.parametrize("top", TOPS)
def test_pushes_that_are_nutations_apart_are_as_exact(top):
    """Of either sign of the weight, and without one. The quaternion goes on with its sign."""
    motion = Motion(top, START, pushes=Pushes(2.0**-15, 7.0, 4))
    states = follow_chain(motion)
    assert_promise_is_kept(motion, states)
    for stamp, q, _ in states:
        assert np.dot(motion.at(ExactTimes(stamp)).orientation, [float(each) for each in q]) > 0


@pytest.mark.slow
@pytest.mark.parametrize(("Mgl", "rate"), [(-0.0625, 0.125), (0.0, 0.03125)])
def test_pushes_that_are_a_hundred_nutations_apart_are_as_exact(Mgl, rate):
    """A start that is rounded would be off by half an eps a radian: some 700 rad a piece, or more.

    So would be a driven motion; friction as small as this changes no digit of it.
    """
    top, pushes = Top(2.0**-13, 3 * 2.0**-14, Mgl), Pushes(2.0**-11, rate, 3)
    start = State(START.orientation, (64.0, 32.0, 48.0))
    motion = Motion(top, start, pushes=pushes)
    states = follow_chain(motion, digits=30)
    assert_promise_is_kept(motion, states)
    assert_promise_is_kept(Motion(top, start, Friction(2.0**-900), pushes=pushes), states)


def assert_promise_is_kept(motion, states):
    for stamp, *exact in states:
        state = motion.at(ExactTimes(stamp))
        q, omega = (np.array([float(each) for each in part]) for part in exact)
        attitude = min(abs(state.orientation - sign * q).max() for sign in (1, -1))
        assert attitude <= 20 * EPS
        assert abs(state.angular_velocity - omega).max() <= 10 * EPS * abs(omega).max()


def test_a_time_in_seconds_is_exact_after_a_push_too():
    """The state is that of the exact time; the difference to the push would be rounded."""
    for t in (0.19, 0.2, 1000.1, 1e6 + 0.1, -0.3):
        nanoseconds = Fraction(t) * 10**9
        assert MOTION.at(t) == MOTION.at(ExactTimes(0, elapsed=nanoseconds)) == MOTION.at([t])[0]
        assert MOTION.piece_at(t).number == sum(each <= max(0, nanoseconds) for each in BEGINS)


def test_copies_pickles_and_a_text_have_the_pushes():
    for again in (copy.copy(MOTION), pickle.loads(pickle.dumps(MOTION)), eval(repr(MOTION))):
        assert again.pushes == PUSHES
        assert again.at(0.19) == MOTION.at(0.19)
    assert MOTION.restart(CUSPS).pushes is None


def test_pushes_hold_the_spin_momentum():
    momenta = {float(ARTICLE.axial_momentum(MOTION.piece_at(t).motion.start)) for t in (0, 0.1, 1)}
    assert max(momenta) - min(momenta) <= 8 * 2**-52 * max(momenta)


def test_what_is_constant_is_said_of_a_piece_alone():
    """The angles between which the axis moves are those of the last piece, not of the start."""
    assert (MOTION.kind, MOTION.engine) == ("driven", "closed form")
    low, high = MOTION.piece_at(1.0).motion.turning_angles
    tilts = MOTION.at(1.0 + np.arange(500) / 500).euler_angles.theta
    assert low - 1e-12 <= tilts.min() <= tilts.max() <= high + 1e-12  # rounding of the angles
    assert not MOTION.turning_angles[0] - 1e-6 <= tilts.min()
    assert Motion(ARTICLE, START, pushes=Pushes(1.0, 1.0, 1)).kind == Motion(ARTICLE, START).kind
    plain = Motion(ARTICLE, START)
    assert plain.piece_at(3.0) == (plain, 0, 0)


def test_pushes_that_end_earlier_are_the_same_up_to_then():
    ended = MOTION.end_pushes(3)
    times = ExactTimes(np.array([each for each in STAMPS if each < BEGINS[3]]))
    assert np.array_equal(ended.at(times).orientation, MOTION.at(times).orientation)
    assert ended.piece_at(1.0).begin == BEGINS[2]
    with pytest.raises(ValueError, match="number must be at most the 3 pushes of the mo"):
        ended.end_pushes(4)
    with pytest.raises(ValueError, match="number must be a whole number of 1 to 1000, got 0"):
        ended.end_pushes(0)


def test_a_push_that_cannot_be_ends_the_states_and_says_why():
    sleeping = Motion(ARTICLE, SLEEPING, pushes=Pushes(2.0**-15, 4.0, 3))
    assert sleeping.farthest_time == 0.25
    assert sleeping.at(0.25 - 2.0**-40).angular_velocity[2] == 200.0
    wild = Motion(Top(1.0, 1.0, 1.0), START, pushes=Pushes(4e99, 0.5, 1000))
    driven = Motion(ARTICLE, SLEEPING, Friction(2.0**-20), pushes=Pushes(2.0**-15, 4.0, 3))
    vertical = r"t must be before 0.25 s \(the push then cannot be made: the axis is vertical then"
    for motion, t, words in (
        (sleeping, 0.25, vertical),
        (driven, 0.5, vertical),
        (wild, 100.0, "t must be (before|less than)"),
    ):
        for ask in (motion.at, motion.piece_at, lambda t, motion=motion: motion.at([0.0, t])):
            with pytest.raises(ValueError, match=words):
                ask(t)
    assert driven._reach(0.5, math.inf) == 0.25


def test_what_asks_for_one_motion_without_pushes_says_so():
    with pytest.raises(ValueError, match="pushes must be none for derivatives: take a piece, got"):
        MOTION.jacobian(1.0)
    with pytest.raises(ValueError, match="pushes must be none for a balance: take a piece, got"):
        balance(MOTION, 1.0, 1.0)
    many = State(np.stack([START.orientation] * 2), np.stack([START.angular_velocity] * 2))
    with pytest.raises(ValueError, match="start must be one state"):
        Motion(ARTICLE, many, pushes=PUSHES)
    with pytest.raises(ValueError, match="pushes must be Pushes, got 3"):
        Motion(ARTICLE, START, pushes=3)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ((math.nan, 1.0, 1), "impulse must be a finite number"),
        ((1.0, 0.001, 1), "rate must be 0.01 to 1000 1/s, got 0.001"),
        ((1.0, 1.0, 2.5), "number must be a whole number of 1 to 1000, got 2.5"),
        ((1.0, 1.0, 1001), "number must be a whole number of 1 to 1000, got 1001"),
    ],
)
def test_pushes_that_no_motion_gets_are_refused(numbers, words):
    with pytest.raises(ValueError, match=words):
        Pushes(*numbers)


def test_a_driven_motion_is_pushed_in_as_many_steps_as_are_allowed():
    motion = Motion(ARTICLE, START, Friction(2.0**-20), pushes=PUSHES)
    reached = 0.0
    while reached < 1.0:
        before, reached = reached, motion._reach(1.0, 1.0)
        assert reached > before
    assert motion.at(1.0) == Motion(ARTICLE, START, Friction(2.0**-20), pushes=PUSHES).at(1.0)


def test_random_series_come_at_the_nearest_nanoseconds():
    rng = Numbers(5)
    for _ in range(50):
        rate, number = rng.uniform(0.01, 1000.0), rng.randint(2, 40)
        pushes = Pushes(2.0**-20, rate, number)
        motion = Motion(ARTICLE, START, pushes=pushes)
        piece = motion.piece_at(ExactTimes(pushes.last_time))
        assert (piece.number, piece.begin) == (number, pushes.last_time)
        exact = Fraction(number - 1) / Fraction(rate) * 10**9
        # half a ns, and two roundings of numbers below 2^42 ns
        assert abs(pushes.last_time - exact) <= Fraction(1, 2) + Fraction(1, 2**10)
        assert motion.piece_at(ExactTimes(pushes.last_time - 1)).number == number - 1


def test_rounding_is_not_said_to_show_in_a_motion_of_pushes():
    """The question is asked of a start under gravity alone, and of nothing that follows a push."""
    rate = 2 / math.sqrt(3)
    start = State.from_euler(theta=math.pi / 3, phi_dot=rate, psi_dot=rate)
    top = Top(1.0, 1.0, 1.0)
    assert math.isfinite(Motion(top, start).rounding_shows_at)
    assert Motion(top, start, pushes=Pushes(1e-3, 20.0, 5)).rounding_shows_at == math.inf
