"""The reference of the report agrees with independent formulas in mpmath."""

import numpy as np
import pytest
from mpmath import mp, mpf
from speed.write_reference import DIGITS, solve

from workshop.speed.reference import EPS, Reference, read_entries

pytestmark = pytest.mark.untraced

REFERENCE = Reference.read()
ENTRIES = read_entries()
DIGIT = mpf(10) ** -DIGITS


# Each of these driven ones, which take the least time, is for the long trials.
CHEAP = [each for each in ENTRIES["driven"] if each["name"] in ("strong friction", "weightless")]
CHECKED = [*ENTRIES["article"][::10], *ENTRIES["hard"][::10]]
CHECKED += [pytest.param(each, marks=pytest.mark.long) for each in CHEAP]


@pytest.mark.parametrize("data", CHECKED, ids=lambda each: each["name"])
def test_motions_are_exact_to_all_digits_written(data):
    found = solve(data)
    with mp.workdps(40):
        for decimals, right in zip(data["exact"], found["exact"], strict=True):
            # numbers below 1 with so many digits, of which the last may be rounded otherwise
            assert max(abs(mpf(a) - mpf(b)) for a, b in zip(decimals, right, strict=True)) <= DIGIT
    limits = zip(data["limit"] or (), found["limit"] or (), strict=True)
    assert all(limit == pytest.approx(right, rel=1e-9) for limit, right in limits)


def test_an_error_is_an_angle_below_rounding_whatever_the_sign_of_the_quaternion():
    problem = REFERENCE.article[0]
    right = [float(each) for each in ENTRIES["article"][0]["exact"][1]]
    rounding = problem.error(1.0, right)
    assert 0 < rounding <= 2 * EPS
    assert problem.error(1.0, np.negative(right)) == rounding
    off = np.add(right, [3e-9, 0.0, -4e-9, 0.0])
    assert problem.error(1.0, off) == pytest.approx(1e-8, rel=1e-6)
    assert problem.errors([1.0], [off])[0] == pytest.approx(problem.error(1.0, off), rel=1e-12)
