"""The trial of docs/trials.md: pulls of what is said to be known, and no wrong minimum unsaid."""

from itertools import product

import pytest
from trials import choose

from symtop_ros.truth.fit.check import HOLDS
from symtop_ros.truth.fit.kinds import READ
from workshop.fit.records import NOISES
from workshop.fit.trial import FIRST, SEEDS, list_unsaid, measure_pulls, run_trial, try_record

CASES = [*product(NOISES, READ)]


def assert_honest(rows, low, high):
    """Assert that pulls are those of honest deviations, and wrong minima say so."""
    assert list_unsaid(rows) == []
    assert low < measure_pulls(rows) < high


@pytest.mark.slow
def test_a_hundredth_of_the_trial_has_honest_deviations():
    rows = [try_record(kind, noise, 300) for noise, kind in CASES[::5]]  # each kind once
    # The numbers of one record are correlated: 6 records have some 24 independent pulls, whose
    # root mean square has a deviation of 15 %. The trial promises 0.8 to 1.25.
    assert_honest(rows, 0.5, 1.75)


@pytest.mark.parametrize("kind", choose(("rates", "inertial"), ("rates",), "slow"))
def test_a_constant_rate_that_is_rounded_is_no_motion_that_the_model_lacks(kind):
    """All of its rows have one error, which does not change from row to row."""
    assert try_record(kind, "rounded", FIRST)["verdict"] == HOLDS


@pytest.mark.long
def test_all_kinds_and_noises_have_honest_deviations():
    assert_honest(run_trial(range(FIRST, FIRST + SEEDS)), 0.8, 1.25)
