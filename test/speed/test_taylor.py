"""The Taylor integration agrees with formulas that are independent of it, to 20 digits."""

import pytest
from mpmath import mp, mpf

from workshop.speed.reference import Reference, integrate, read_entries, split_orientations

ARTICLE = Reference.read().article
DIGITS = read_entries()["article"]
# 32 digits, and an error of 1e-26 in each of a hundred steps that grows with the motion; the
# digits that are stored end at 1e-25.
SMALLEST = mpf(10) ** -24


def largest_difference(motion, times, exact):
    high, low = split_orientations(motion, times)
    with mp.workdps(40):
        found = [
            [mpf(a) + mpf(b) for a, b in zip(*q, strict=True)] for q in zip(high, low, strict=True)
        ]
        return max(
            min(max(abs(a + sign * b) for a, b in zip(q, p, strict=True)) for sign in (1, -1))
            for q, p in zip(found, exact, strict=True)
        )


@pytest.mark.parametrize(
    "number",
    [0, *(pytest.param(n, marks=pytest.mark.long) for n in range(1, 8)), 8, 9],
    ids=[problem.name for problem in ARTICLE],
)
def test_the_articles_motions_have_the_digits_that_were_stored(number):
    with mp.workdps(40):
        exact = [[mpf(each) for each in q] for q in DIGITS[number]["exact"][:2]]
    motion = integrate(ARTICLE[number].task)
    assert largest_difference(motion, ARTICLE[number].times[:2], exact) < SMALLEST
