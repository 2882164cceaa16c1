"""A trial of the judge: it names the causes that are its own, and never one that is not there."""

import pytest
from judge.trial import draw_file
from trials import choose

from symtop_ros.judge.causes import CHANGES, LEVELS
from symtop_ros.judge.fit import PARAMETERS
from symtop_ros.judge.search import find_causes

LONG = 60  # files of each half
SHORT = range(2)  # of them those that are tried by every run of the tests
OWN = (4, 8, 13, 29, 34, 40, 41)  # with every change, level and parameter


@pytest.mark.parametrize("number", choose(range(LONG), SHORT))
def test_no_cause_is_named_that_is_not_there(number):
    file = draw_file(number, own=False)
    found = find_causes(file.estimates, file.truth)
    assert not found.explained, (file.name, file.scene, found.best.kind)
    assert found.best.kind == ("", "none", ())


@pytest.mark.parametrize("number", choose(range(LONG), OWN))
def test_a_cause_of_its_own_is_named_with_its_size(number):
    file = draw_file(number, own=True)
    found = find_causes(file.estimates, file.truth)
    assert found.explained
    kinds = [each.kind for each in (found.best, *found.others)]
    (kind,) = file.kinds
    assert kind in kinds, (file.name, file.scene, kinds)
    if not file.truth.kind:  # a steady motion shows a conjugate as another cause
        assert {change for change, *_ in kinds} == {kind[0]}
    cause = (found.best, *found.others)[kinds.index(kind)]
    for name, deviation in zip(kind[2], cause.deviations, strict=False):
        # a drift about the vertical of north, east, down goes the other way round
        size = getattr(file.made, name) * (-1 if "ned" in kind[0] and name == "drift" else 1)
        assert getattr(cause.offset, name) == pytest.approx(size, rel=1e-6, abs=5 * deviation)


def test_the_trial_has_every_cause():
    files = [draw_file(k, own=True).kinds[0] for k in OWN]
    changes, levels, parameters = zip(*files, strict=True)
    assert set(changes) == {*CHANGES} - {"frame"}  # test_truth.py has it
    assert set(levels) == set(LEVELS)
    assert set(parameters) == {(), *((name,) for name in PARAMETERS)}
