"""Arguments of all types, and numbers of all sizes: served, or refused on one short line."""

import math
import re
from fractions import Fraction

import numpy as np
import pytest
from drawn import Numbers, normalize
from physics.refusals import FINITE_ARRAY, meet, refused
from physics.tops import ARTICLE, CUSPS, EPS, distance, ending
from trials import seeds

from symtop_ros.base.refusals import refuse
from symtop_ros.physics import (
    EffectivePotential,
    ExactTimes,
    Friction,
    Motion,
    State,
    Top,
    apply_impulse,
    compare_hurried,
    hurry,
    kick_verdict,
    perrys_rule,
    theta_acceleration,
)
from symtop_ros.physics.values import validate_array, validate_number

pytestmark = pytest.mark.numbers

TWO = 2, 2.0, np.float32(2), np.int8(2), np.array(2.0), np.array(2), Fraction(4, 2)
MASKED = np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0])
NO_NUMBERS = [1, 2, "3"], [1j, 2, 3], [True, False, True], [1, None, 3], [[1], [2, 3]]
NOT_FINITE = [1, 2, math.nan], [1, 2, 10**400]
YEAR = 365 * 86_400 * 10**9  # ns
FACTORS = [1.0, 1e-3, 0.1, 1 / 3, 7.0, 100.0]
ELAPSED = Fraction(987_654_321_987_654_321, 2**40)
WITH_UNITS = np.array([1, 2, 3], dtype="timedelta64[ms]")


@pytest.mark.parametrize("value", [*TWO, np.longdouble(2)])
def test_a_number_of_any_real_type_becomes_a_float(value):
    found = validate_number("x", value)
    assert type(found) is float
    assert found == 2.0


VECTORS = [[1, 2, 3], (1.0, 2.0, 3.0), np.arange(1, 4), [1, Fraction(2), 3]]


@pytest.mark.parametrize("value", VECTORS)
def test_an_array_of_any_real_type_becomes_new_doubles(value):
    found = validate_array("x", value, 3)
    assert found.dtype == np.float64
    assert found.tolist() == [1.0, 2.0, 3.0]
    assert not np.shares_memory(found, np.asarray(value))


@pytest.mark.parametrize("value", [*NO_NUMBERS, *NOT_FINITE, MASKED, WITH_UNITS])
def test_an_array_that_does_not_hold_finite_numbers_is_refused(value):
    with refused("x", FINITE_ARRAY):
        validate_array("x", value, 3)


def test_a_long_value_is_shortened_to_one_line():
    text = str(refuse("x", "short", np.zeros((30, 30))))
    assert text.isprintable()
    assert len(text) < 100
    assert text.endswith("...")


def test_a_float_is_shown_with_all_its_digits():
    assert str(refuse("x", "< 2", 2.0000000000000004)) == "x must be < 2, got 2.0000000000000004"
    assert str(refuse("x", "< 2", np.float64(3.0))) == "x must be < 2, got 3"


class Quantity:
    """A number with a unit, as pint and astropy have them."""

    units = "g cm^2"

    def __array__(self, dtype=None, copy=None):
        return np.array(2280.0)

    def __float__(self):
        return 2280.0


@pytest.mark.parametrize("value", [Quantity(), [Quantity(), Quantity()], [[1.0, Quantity()]]])
@pytest.mark.parametrize("name", ["Ix", "Mgl"])
def test_quantities_with_units_are_refused(name, value):
    moments = {"Ix": 1.0, "Iz": 1.0, "Mgl": 1.0, name: value}
    with refused(name, "plain numbers, converted to SI units"):
        Top(**moments)


def test_the_first_odd_number_of_an_array_is_located():
    times = np.zeros((40, 50))
    times[30, 2] = np.nan
    with refused("t", "an array of finite numbers (s)", "nan at [30, 2]"):
        Motion(ARTICLE, CUSPS).at(times)


def test_nothing_underflows_into_an_error():
    with np.errstate(all="raise"):
        State.from_euler(theta=0.5, phi_dot=5e-324)
        motion = Motion(ARTICLE, CUSPS)
        motion.at(ExactTimes(np.array([1, 2]), 1e-90))
        upright = Motion(Top(1, 1, 1), State((0, 1, 0, 0), (2, 0, 0)))
        states = upright.at([360.0, 3600.0])
        upright.top.energy(states)
        upright.total_torque(states)
        states.table([360.0, 3600.0])
        compare_hurried(ARTICLE, [0, 1e-170, 0.5], [3, 3, 0], 200)
        EffectivePotential.from_state(ARTICLE, CUSPS).at([0, 1e-170, 1e-160])
        theta_acceleration(ARTICLE, [1e-300, 1e-170], [1e-300, 3.0], 1e-200)
        hurry(State.from_euler(theta=[1e-90, 1.0], phi_dot=1e-200), [1e-300, 1.0])
        apply_impulse(ARTICLE, states, (1e-300, 0, 1e-320))


@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("elapsed", [Fraction(0), ELAPSED])
def test_seconds_are_the_nearest_doubles(factor, elapsed):
    stamps = np.array([0, 1, -5, YEAR + 1, 2**63 - 1])
    times = ExactTimes(stamps, factor, elapsed)
    for stamp, seconds in zip(stamps.tolist(), times.seconds.tolist(), strict=True):
        exact = (elapsed + Fraction(factor) * stamp) / 10**9
        assert seconds == float(exact)
        assert ExactTimes(stamp, factor, elapsed).seconds == seconds
        assert times.advance(stamp) == exact * 10**9


def test_shapes_follow_those_of_the_nanoseconds():
    motion = Motion(Top(1.0, 0.5, 0.0), CUSPS)
    assert motion.at(ExactTimes(1)).orientation.shape == (4,)
    assert motion.at(ExactTimes(np.array([], dtype=np.int64))).orientation.shape == (0, 4)
    assert motion.at(ExactTimes(np.array([1, 2], dtype=np.uint32))).orientation.shape == (2, 4)


RATES = [0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-30, 1e-9, 1.0, -3.0, 200.0, 1e5, -1e9, 1e9]
TILTS = [0.0, 1e-300, 1e-160, 1e-12, 0.5, math.pi / 2, 3.0, math.pi - 1e-12, math.pi]
PARTS = [0.0, 1.0, -1.0, 0.5, 1e-9, 1e-160, 1e-300]
WEIGHTS = [0.0, 5e-324, 1e-300, -1e-15, 0.068, -0.068, 1e30]


def draw_extreme(rng):
    """A top, a start and a time of numbers that decide something."""
    Ix = rng.choice([1e-30, 1e-6, 2.28e-4, 1.0, 1e30])
    Mgl = rng.choice([*WEIGHTS, Ix, -Ix, 1e4 * Ix])
    top = Top(Ix, Ix * rng.choice([1e-6, 0.25, 1.0, 1.0 + 1e-12, 2.0]), Mgl)
    if rng.random() < 0.5:
        rates = {f"{name}_dot": rng.choice(RATES) for name in ("theta", "phi", "psi")}
        start = State.from_euler(theta=rng.choice(TILTS), phi=rng.choice([0, 1, 3]), **rates)
        return top, start, 1e9
    q = np.array([rng.choice(PARTS) for _ in range(4)])
    q[rng.randrange(4)] = 1.0
    return top, State(normalize(q), [rng.choice(RATES) for _ in range(3)]), 1e9


def draw_any(rng):
    """A top, a start and a time over hundreds of decades, of which some are refused."""
    Ix = rng.power(-100, 100)
    Mgl = rng.choice([-1, 0, 1]) * rng.power(-320, 100)
    q = np.array([rng.gauss(0, 1) * rng.choice([1, 1, 0, 1e-9, 1e-90]) for _ in range(4)])
    q = normalize(q) if q.any() else np.array([1.0, 0, 0, 0])
    omega = [rng.choice([-1, 0, 1]) * rng.power(-320, 100) for _ in range(3)]
    t = rng.choice([-1, 1]) * rng.power(-320, 308)
    return Top(Ix, Ix * rng.power(-60, 0.3), Mgl), State(q, omega), t


def ask(draw, rng):
    """A motion, its states and the answer to a kick, or the words of a refusal."""
    try:
        top, start, t = draw(rng)
        motion = Motion(top, start)
        latest = meet(motion, t)
        states = motion.at([0.0, 1e-9 * latest, -latest, 1e-18 * latest, latest])
        assert str(perrys_rule(top, start))
    except ValueError as refusal:
        return str(refusal)
    try:
        return motion, states, str(kick_verdict(Motion(top, hurry(start)), start, "spin_rate"))
    except ValueError as refusal:
        return motion, states, str(refusal)


# Each motion takes some milliseconds; the machine may stand still meanwhile.
DRAWS = [(draw_extreme, 120, 120), (draw_any, 400, 240)]


@pytest.mark.parametrize("block", seeds(1, 40))
@pytest.mark.parametrize(("draw", "count", "least"), DRAWS)
def test_numbers_of_all_sizes_are_served_or_refused_in_words(draw, count, least, block):
    rng = Numbers(block)
    served = 0
    for _ in range(count):
        with ending():
            found = ask(draw, rng)
        if isinstance(found, str):
            assert " must be " in found
            continue
        motion, states, answer = found
        served += 1
        assert np.isfinite(states.angular_velocity).all()
        assert np.abs(np.linalg.norm(states.orientation, axis=1) - 1).max() <= 4 * EPS
        assert distance(states[0], motion.start) <= 16 * EPS
        low, high = motion.turning_angles
        assert 0.0 <= low <= high + 8 * EPS
        assert high <= math.pi
        assert answer
    assert served >= least


def test_the_separatrix_rests_at_its_end_at_any_time():
    upright = Motion(Top(1.0, 1.0, 1.0), State((0, 1, 0, 0), (2, 0, 0)))
    for t in (1e14, -1e14, ExactTimes(2**63 - 1, 1e4)):
        assert upright.at(t).euler_angles.theta == 0.0
    assert upright.at([1e14, 0.0]).euler_angles.theta[0] == 0.0


def test_a_friction_that_makes_a_time_too_far_is_refused_with_a_limit():
    start = State.from_euler(theta=0.5, psi_dot=200.0)
    motion = Motion(ARTICLE, start, Friction(100.0, 100.0))
    words = "t must be within 0.0572 s of the start (friction stops the top in 5.72e-07 s"
    with ending(), pytest.raises(ValueError, match=re.escape(words)):
        motion.at(10.0)
    with ending():
        assert np.isfinite(motion.at(0.057).orientation).all()
