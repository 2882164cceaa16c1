"""Digits that are stored are proved, and a wrong one is noticed."""

from collections import Counter
from decimal import Decimal, localcontext

import pytest
from trials import trials

from workshop import proofs
from workshop.proofs import NOT_PROVED, Stored, list_motions, list_problems, prove

pytestmark = pytest.mark.untraced
PROBLEMS, MOTIONS = list(list_problems()), list(list_motions())
FALLS = [each for each in MOTIONS if each.store == "table, gravity alone"]
DRIVEN = [each for each in MOTIONS if each.store == "table, driven"]


def test_every_number_of_the_test_set_is_in_its_ball() -> None:
    counts = sum(map(prove, PROBLEMS), Counter())
    assert counts == {"nearest": 9100, "zero": 700}


@pytest.mark.parametrize("step", trials(10, 1))
def test_states_under_gravity_that_the_tests_compare_with_are_proved(step: int) -> None:
    counts = sum(map(prove, FALLS[::step]), Counter())
    assert counts.total() == 7 * sum(len(each.times) for each in FALLS[::step])
    assert not counts[NOT_PROVED]


@pytest.mark.parametrize("stored", DRIVEN[::20], ids=lambda each: each.name)
def test_a_state_with_friction_or_a_torque_is_proved(stored: Stored) -> None:
    assert not prove(shorten(stored))[NOT_PROVED]


@pytest.mark.long
def test_all_that_is_stored_is_proved() -> None:
    assert proofs.main() == 0


def shorten(stored: Stored) -> Stored:
    """Return a motion with its nearest time only."""
    place = min(range(len(stored.times)), key=lambda k: abs(stored.times[k]))
    part = slice(place, place + 1)
    return stored._replace(times=stored.times[part], states=stored.states[part])


@pytest.mark.parametrize("place", range(6))
@pytest.mark.parametrize("store", ["test set", "gravity alone", "driven"])
def test_a_wrong_last_digit_is_noticed(place: int, store: str, monkeypatch) -> None:
    monkeypatch.setattr(proofs, "MOST", 20)
    lists = {"test set": PROBLEMS, "gravity alone": FALLS, "driven": DRIVEN}
    stored = next(
        each
        for each in map(shorten, lists[store])
        if all(abs(float(text)) > 0.01 for text in each.states[0])
    )
    row = list(stored.states[0])
    part = row[:4] if place < 4 else row[4:]
    size = max(abs(Decimal(each)) for each in part)
    with localcontext(prec=50):
        row[place] = str(Decimal(row[place]) + Decimal(10) ** (size.adjusted() - stored.digits + 1))
    assert not prove(stored)[NOT_PROVED]
    assert prove(stored._replace(states=[row]))[NOT_PROVED] == 1
