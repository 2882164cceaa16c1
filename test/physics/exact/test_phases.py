from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.refusals import NOT_TOO_LATE, refused
from physics.tops import EPS

from symtop_ros.physics import ExactTimes
from symtop_ros.physics.exact.phases import Phase, Phases

RATES = (Decimal("6.49714481615578871234567890123456"), Decimal("-1234567890.123456789012345678"))


COUNTED = [0.0, 1e-9, 0.3, 1.0, 1e6, -1e9, 123456789012.345]
BEYOND = [1e14, -1e17, 1e20]  # the count of ticks


@pytest.mark.parametrize("t", [*COUNTED, *BEYOND])
def test_a_phase_is_reduced_without_loss_at_any_time(t):
    phases = Phases(*RATES)
    values, many = phases.at(t), phases.at(np.array([t, t]))
    assert_equal_bits(values, many)
    with mp.workdps(80):
        for rate, phase in zip(RATES, values, strict=True):
            exact, (high, low) = mpf(str(rate)) * mpf(t), phase.radians
            off = (exact - mpf(high) - mpf(low)) / (2 * mp.pi)
            assert abs(off - mp.nint(off)) <= 2.0**-62  # the carries that are left out
            assert abs(high) <= np.pi * (1 + 2.0**-9)  # and the rest of a tick
            for found, value in zip(phase.unit, (mp.cos(exact), mp.sin(exact)), strict=True):
                assert abs(found - value) <= 0.6 * EPS  # rounding is 0.5


def assert_equal_bits(one, many):
    """The phases at one time are those of the last of many."""
    for phase, phases in zip(one, many, strict=True):
        assert phase.radians == tuple(part[-1] for part in phases.radians)
        assert phase.unit == tuple(part[-1] for part in phases.unit)


@pytest.mark.parametrize("t", [1e-3, 1e-9, -1e-15, 1e-300])
def test_the_phase_of_a_short_time_keeps_its_digits(t):
    slow = Decimal("0.0123456789012345678901234567890123")
    phase, *_ = Phases(slow, *RATES).at(t)
    high, low = phase.radians
    with mp.workdps(60):
        # counts of ticks leave 2^-62 of a turn; within the first tick, 1e-13 s, nothing is lost
        lost = 2.0**-62 * 2 * np.pi if abs(t) > 1e-13 else 0.0
        exact = mpf(str(slow)) * mpf(t)
        assert abs(exact - mpf(high) - mpf(low)) <= lost + EPS * abs(exact)


def test_exact_times_and_doubles_give_the_same_phases():
    phases, t = Phases(*RATES), np.array([0.0, 1.0, -3.0, 1e9])
    exact = phases.at(ExactTimes((t * 1e9).astype(np.int64)))
    for one, other in zip(exact, phases.at(t), strict=True):
        (high, low), (other_high, other_low) = one.radians, other.radians
        # each leaves out carries of 2^-62 of a turn
        assert np.abs(high - other_high + (low - other_low)).max() <= 2.0**-61 * 2 * np.pi


@pytest.mark.parametrize("nanoseconds", [0, 7, -123_456_789, 2**32, -(2**62)])
def test_the_phases_of_one_exact_time_are_those_of_an_array(nanoseconds):
    phases, times = Phases(*RATES), np.array([nanoseconds, 5, nanoseconds])
    one = phases.at(ExactTimes(nanoseconds, 1 / 3, Fraction(5, 8)))
    many = phases.at(ExactTimes(times, 1 / 3, Fraction(5, 8)))
    assert_equal_bits(one, many)


@pytest.mark.parametrize("t", [1e60, np.array([1.0, -1.7e308]), ExactTimes(2**63 - 1, 1e40)])
def test_times_beyond_all_digits_are_refused(t):
    with refused("t", NOT_TOO_LATE):
        Phases(*RATES).at(t)
    assert Phases(Decimal(0)).at(t)[0].unit  # what rests has a phase at any time


def test_cosine_and_sine_are_right_everywhere_in_a_turn():
    turns = np.random.default_rng(3).integers(-(2**63), 2**63, 2000)
    turns = np.concatenate([turns, [0, 1, -1, 2**63 - 1, -(2**63), 2**54, 2**54 - 1, 2**62]])
    cosines, sines = Phase(turns).unit
    with mp.workdps(30):
        for turn, found in zip(turns.tolist(), zip(cosines, sines, strict=True), strict=True):
            angle = 2 * mp.pi * turn / mpf(2) ** 64
            exact = mp.cos(angle), mp.sin(angle)
            assert max(abs(a - b) for a, b in zip(found, exact, strict=True)) <= 0.6 * EPS
            assert Phase(turn).unit == found
