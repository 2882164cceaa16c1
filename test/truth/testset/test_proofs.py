"""Digits that are stored are proved, and a wrong one is noticed."""

from collections import Counter
from collections.abc import Sequence
from decimal import Decimal, localcontext

import pytest
from trials import trials

from symtop_ros.physics.reference.proved import prove_states
from workshop import proofs
from workshop.proofs import NOT_PROVED, Stored, judge, list_motions, list_problems, prove

pytestmark = pytest.mark.untraced
PROBLEMS, MOTIONS = list(list_problems()), list(list_motions())
FALLS = [each for each in MOTIONS if each.store == "table, gravity alone"]
DRIVEN = [each for each in MOTIONS if each.store == "table, driven"]


@pytest.mark.slow
def test_every_number_of_the_test_set_is_in_its_ball() -> None:
    counts = sum(map(prove, PROBLEMS), Counter())
    assert counts == {"nearest": 9100, "zero": 700}


@pytest.mark.parametrize("step", trials(10, 1))
def test_states_under_gravity_that_the_tests_compare_with_are_proved(step: int) -> None:
    counts = sum(map(prove, FALLS[::step]), Counter())
    assert counts.total() == 7 * sum(len(each.times) for each in FALLS[::step])
    assert not counts[NOT_PROVED]


@pytest.mark.parametrize("stored", DRIVEN[::40], ids=lambda each: each.name)
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


def spoil(row: Sequence[str], place: int, digits: int) -> list[str]:
    """Return a state with another last digit."""
    part = row[:4] if place < 4 else row[4:]
    size = max(abs(Decimal(each)) for each in part)
    with localcontext(prec=50):
        other = Decimal(row[place]) + Decimal(10) ** (size.adjusted() - digits + 1)
    return [*row[:place], str(other), *row[place + 1 :]]


@pytest.mark.parametrize("stores", [PROBLEMS, FALLS, DRIVEN], ids=lambda each: each[0].store)
def test_a_wrong_last_digit_is_noticed(stores: list[Stored]) -> None:
    stored = next(
        each
        for each in map(shorten, stores)
        if all(abs(float(text)) > 0.01 for text in each.states[0])
    )
    row = stored.states[0]
    digits = stored.digits
    (exact,) = prove_states(stored.inputs, stored.times, digits + 10, *stored.drive)
    assert NOT_PROVED not in judge(row, exact, digits)
    for place in range(6):
        assert list(judge(spoil(row, place, digits), exact, digits)).count(NOT_PROVED) == 1


def test_a_wrong_digit_is_found_among_all_of_a_motion_and_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    right, other = PROBLEMS[:2]
    states = [*right.states[:-1], spoil(right.states[-1], 0, right.digits)]
    assert not prove(right)[NOT_PROVED]
    monkeypatch.setattr(proofs, "MOST", 50)
    tasks = [right._replace(states=states), other]
    assert proofs.report(tasks, map(prove, tasks)) == 1
    assert capsys.readouterr().out.splitlines()[-1].endswith(" 1 not proved")
