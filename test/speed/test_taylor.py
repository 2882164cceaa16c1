"""The Taylor integration agrees with formulas that are independent of it, to 20 digits."""

import numpy as np
import pytest
from mpmath import mp, mpf

from symtop_ros.physics import Friction, State, Top
from workshop.speed.peers.peer import Task
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


def test_a_sphere_without_weight_turns_evenly():
    omega = (1.0, 2.0, -2.0)  # rad/s, of size 3
    motion = integrate(Task(Top(0.5, 0.5, 0.0), State((1.0, 0.0, 0.0, 0.0), omega)))
    with mp.workdps(40):
        half = mpf(3) * 7 / 2
        exact = [[mp.cos(half), *(mp.sin(half) * rate / 3 for rate in map(mpf, omega))]]
        assert largest_difference(motion, [7.0], exact) < SMALLEST


def test_friction_alone_slows_the_spin_exponentially():
    task = Task(Top(1.0, 0.5, 0.0), State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 4.0)), Friction(0.25))
    with mp.workdps(40):
        half = 2 * (1 - mp.exp(mpf(-1) / 2 * 3)) / (mpf(1) / 2)
        exact = [[mp.cos(half), mpf(0), mpf(0), mp.sin(half)]]
        assert largest_difference(integrate(task), [3.0], exact) < SMALLEST


def test_times_may_come_in_any_order_and_again():
    motion = integrate(ARTICLE[0].task)
    late, early, again = np.transpose(split_orientations(motion, [0.2, 0.01, 0.2]), (1, 0, 2))
    assert (late == again).all()
    alone = split_orientations(integrate(ARTICLE[0].task), [0.01])
    assert (early == np.transpose(alone, (1, 0, 2))[0]).all()


def test_a_top_that_rests_on_the_vertical_stays():
    task = Task(Top(1.0, 0.5, 2.0), State((1.0, 0.0, 0.0, 0.0), (0.0,) * 3))
    high, low = split_orientations(integrate(task), [50.0])
    assert high.tolist() == [[1.0, 0.0, 0.0, 0.0]]
    assert (low == 0).all()
