"""The reference of the report agrees with independent formulas in mpmath."""

from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf
from speed.write_reference import DIGITS, solve

from symtop_ros.physics import Motion, State
from workshop.speed.reference import EPS, Reference, read_entries

pytestmark = pytest.mark.untraced

REFERENCE = Reference.read()
# Median and largest error in rad of heyoka 7.13.2 in each family of driven motions: doubles, the
# default tolerance, the quaternion and the angular velocity of the body as variables.
HEYOKA = {
    "plain": (8.6e-13, 4.6e-12),
    "strong friction": (4.5e-16, 1.5e-15),
    "overdamped": (3.4e-16, 9.0e-16),
    "tiny and long": (1.4e-12, 1.5e-10),
    "fast spin": (2.0e-14, 3.2e-13),
    "vertical torque": (2.9e-14, 1.4e-12),
    "horizontal torque": (2.3e-14, 1.2e-12),
    "torque with friction": (8.7e-15, 1.0e-13),
    "torque without friction": (1.8e-14, 9.6e-13),
    "weightless": (7.1e-15, 1.6e-13),
    "sleepers": (4.7e-13, 1.7e-11),
    "rods": (1.3e-12, 1.1e-11),
    "mixed": (7.2e-15, 6.6e-14),
    "tumbling": (1.1e-14, 2.8e-14),
}
ENTRIES, DIGIT = read_entries(), mpf(10) ** -DIGITS


# A few of the driven ones, which take the least time.
CHEAP = [each for each in ENTRIES["driven"] if each["name"] in ("strong friction", "weightless")]
CHECKED = [
    *((part, each, ()) for part in ("article", "hard") for each in ENTRIES[part][::10]),
    *(("driven", each, pytest.mark.long) for each in CHEAP),
]


@pytest.mark.parametrize(
    "data",
    [
        pytest.param(each, marks=marks, id=f"{part}: {each['name']}")
        for part, each, marks in CHECKED
    ],
)
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


@pytest.mark.parametrize("family", HEYOKA)
def test_driven_motions_are_more_exact_than_those_of_heyoka(family):
    errors = []
    for problem in REFERENCE.driven:
        if problem.name == family:
            task = problem.task
            motion = Motion(task.top, task.start, task.friction, task.torque)
            found = motion.at(problem.times).orientation
            errors.append(max(map(problem.error, problem.times, found)))
    median, largest = HEYOKA[family]
    # docs/accuracy.md says that its errors are larger in every family.
    assert np.median(errors) <= median / 2
    assert max(errors) <= largest / 2


def test_hard_cases_come_nearer_and_nearer():
    for family in {problem.name for problem in REFERENCE.hard}:
        steps = [problem.small for problem in REFERENCE.hard if problem.name == family]
        assert len(steps) == 9
        assert len({a > b for a, b in pairwise(steps)}) == 1


def test_a_start_is_what_is_written():
    for problem, data in zip(REFERENCE.hard, ENTRIES["hard"], strict=True):
        assert State(data["orientation"], data["angular_velocity"]).orientation.tolist() == (
            problem.task.start.orientation.tolist()
        )
