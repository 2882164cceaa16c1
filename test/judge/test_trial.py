"""A trial of the judge: it names the causes that are its own, and never one that is not there."""

import pytest
from judge.trial import FOREIGN, draw_file

from symtop_ros.judge.search import find_causes

LONG, SHORT = 60, 6  # files of each half; the short part is tried by every run of the tests


def choose(count):
    return [pytest.param(k, marks=[pytest.mark.long] * (k >= SHORT)) for k in range(count)]


@pytest.mark.parametrize("number", choose(LONG))
def test_no_cause_is_named_that_is_not_there(number):
    file = draw_file(number, own=False)
    found = find_causes(file.estimates, file.truth)
    assert not found.explained, (file.name, file.scene, found.best.kind)


@pytest.mark.parametrize("number", choose(LONG))
def test_a_cause_of_its_own_is_named(number):
    file = draw_file(number, own=True)
    found = find_causes(file.estimates, file.truth)
    kinds = [each.kind for each in (found.best, *found.others)]
    assert found.explained
    assert set(file.kinds) <= set(kinds), (file.name, file.scene, kinds)


def test_the_trial_has_every_cause_that_is_not_its_own():
    assert {draw_file(k, own=False).name for k in range(LONG)} == set(FOREIGN)
