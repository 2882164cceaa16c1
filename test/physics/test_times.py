"""Exact times: what they hold and refuse, and phases and states that are exact at the stamp."""

from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.tops import ARTICLE, CUSPS, EPS, attitude_error

from symtop_ros.physics import ExactTimes, Motion, State, Top
from symtop_ros.physics.reference import ClosedForm, Inputs

YEAR = 365 * 86_400 * 10**9  # ns
FACTORS = [1.0, 1e-3, 0.1, 1 / 3, 7.0, 100.0]
ELAPSED = Fraction(987_654_321_987_654_321, 2**40)
STARTS = {"closed form": CUSPS, "free": State.from_euler(theta=0.0, psi_dot=200.0)}


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


@pytest.mark.parametrize("name", STARTS)
@pytest.mark.parametrize("factor", FACTORS)
def test_states_at_exact_times_are_right_to_five_eps(name, factor):
    motion = Motion(ARTICLE, STARTS[name])
    exact = ClosedForm(Inputs.of(ARTICLE, motion.start), 80)
    for stamp in (0, -5, YEAR + 1, 100 * YEAR + 3):
        times = ExactTimes(stamp, factor, ELAPSED)
        with mp.workdps(80):
            t = times.advance(stamp) / 10**9
            q, _ = exact.at(mpf(t.numerator) / t.denominator)
        assert attitude_error(q, motion.at(times).orientation) <= 5 * EPS


def test_shapes_follow_those_of_the_nanoseconds():
    motion = Motion(Top(1.0, 0.5, 0.0), CUSPS)
    assert motion.at(ExactTimes(1)).orientation.shape == (4,)
    assert motion.at(ExactTimes(np.array([], dtype=np.int64))).orientation.shape == (0, 4)
    assert motion.at(ExactTimes(np.array([1, 2], dtype=np.uint32))).orientation.shape == (2, 4)
