"""What the report compares with is what the tests' own mpmath says."""

import json
from itertools import pairwise

import numpy as np
import pytest
from exact_motion import Inputs, error_and_limit, exact_motion
from mpmath import mp, mpf
from report.precision.write_reference import DIGITS, TIMES, article, hard_cases

from symtop_ros.physics import State
from symtop_ros.report.precision.reference import EPS, FILE, FRICTION, Reference

REFERENCE = Reference.read()
ENTRIES = json.loads(FILE.read_text())


def exact(data, k):
    inputs = Inputs.of(
        *(data[name] for name in ("Ix", "Iz", "Mgl", "orientation", "angular_velocity"))
    )
    return inputs, exact_motion(inputs, data["t"][k])[0]


@pytest.mark.parametrize("data", ENTRIES["article"][:7], ids=lambda data: data["name"])
def test_the_articles_motions_are_exact_to_all_digits_written(data):
    for k, decimals in enumerate(data["exact"]):
        assert_same_digits(exact(data, k)[1], decimals)


@pytest.mark.parametrize("data", ENTRIES["hard"][::5], ids=lambda data: data["name"])
def test_hard_cases_are_exact_to_all_digits_written(data):
    inputs, right = exact(data, 0)
    assert_same_digits(right, data["exact"][0])
    limit = error_and_limit(inputs, data["t"][0], data["orientation"], [1.0, 0.0, 0.0])[2]
    assert data["limit"][0] == pytest.approx(limit, rel=1e-9)


def assert_same_digits(right, decimals):
    with mp.workdps(40):
        off = max(abs(a - mpf(b)) for a, b in zip(right, decimals, strict=True))
        assert off <= mpf(10) ** -DIGITS  # numbers below 1 with so many digits


def test_the_file_holds_what_its_program_writes():
    assert [problem.times for problem in REFERENCE.article[:7]] == [tuple(TIMES)] * 7
    assert REFERENCE.article[-1].friction == FRICTION
    written = [(family, small) for family, small, *_ in hard_cases()]
    assert [(each.name, each.small) for each in REFERENCE.hard] == written
    assert next(article())["exact"] == ENTRIES["article"][0]["exact"]


def test_an_error_is_a_distance_up_to_sign_below_rounding():
    problem = REFERENCE.article[0]
    right = [float(each) for each in ENTRIES["article"][0]["exact"][2]]
    rounding = problem.error(10.0, right)
    assert 0 < rounding <= EPS
    assert problem.error(10.0, np.negative(right)) == rounding
    off = np.add(right, [3e-9, 0.0, -4e-9, 0.0])
    assert problem.error(10.0, off) == pytest.approx(5e-9, rel=1e-6)


def test_hard_cases_come_nearer_and_nearer():
    for family in {problem.name for problem in REFERENCE.hard}:
        steps = [problem.small for problem in REFERENCE.hard if problem.name == family]
        assert len(steps) == 9
        assert len({a > b for a, b in pairwise(steps)}) == 1


def test_a_start_is_what_is_written():
    for problem, data in zip(REFERENCE.hard, ENTRIES["hard"], strict=True):
        assert State(data["orientation"], data["angular_velocity"]).orientation.tolist() == (
            problem.start.orientation.tolist()
        )
