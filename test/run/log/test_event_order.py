"""Events in the order of the runs of a node: repeated, sorted by time, of several runs."""

from dataclasses import replace

import numpy as np
import pytest

from symtop_ros.physics import Motion, State, Top
from symtop_ros.run.log.event_order import EventOrder, order_events
from symtop_ros.run.simulation.events import start_event

FIRST = start_event(Motion(Top(2e-4, 1e-4, 0.05), State.from_euler(theta=0.5, psi_dot=100.0)))


def event(number, stamp, name="kick", **request):
    """An event of a run, which asked for something."""
    asked = {f"request.{key}": str(value) for key, value in request.items()}
    values = {**FIRST.values, **asked, "number": str(number)}
    return replace(FIRST, name=name, stamp=stamp, values=values)


START = event(1, 0, "start")
KICKS = [event(number, 10 * number) for number in (2, 3, 4)]


def order(*events, begins=(0,)):
    return order_events([*enumerate(events)], begins)


def test_events_of_a_log_that_was_sorted_are_in_the_order_of_their_numbers():
    back = event(3, 5, "clock", **{"from": 40, "to": 5})
    found = order(START, back, KICKS[0])
    assert [each.number for each in found.events] == [1, 2, 3]
    assert (found.places, found.runs, found.doubled) == ((0, 2, 1), (0, 0, 0), 0)


@pytest.mark.parametrize(("begins", "doubled", "repeated"), [((0,), 1, 0), ((0, 2), 0, 1)])
def test_an_event_may_be_repeated_at_the_begin_of_a_file_alone(begins, doubled, repeated):
    found = order(START, KICKS[0], KICKS[0], KICKS[1], begins=begins)
    assert (found.doubled, len(found.repeated)) == (doubled, repeated)
    assert [each.number for each in found.events] == [1, 2, 3]


def test_after_a_new_event_of_a_file_none_may_be_repeated():
    found = order(START, KICKS[0], KICKS[1], KICKS[0], begins=(0, 2))
    assert (found.doubled, found.repeated) == (1, ())


def test_a_start_after_the_end_of_a_run_begins_another_one():
    found = order(START, KICKS[0], event(1, 50, "start"), event(2, 60))
    assert found.runs == (0, 0, 1, 1)
    late = order(KICKS[0], START)  # the log begins with a message that came too early
    assert (late.runs, late.places) == ((0, 0), (1, 0))


def test_events_without_numbers_stay_in_the_order_of_the_log():
    old = [event(0, stamp) for stamp in (0, 20, 10)]
    assert order(*old).events == tuple(old)


def test_the_latest_event_before_a_place_is_that_of_the_log():
    found = order(START, KICKS[1], KICKS[0])
    event_order = EventOrder(found.events, found.places)
    assert not event_order.is_in_log_order
    assert event_order.find_latest(np.array([-1, 0, 1, 2, 9])).tolist() == [-1, 0, 2, 1, 1]


def test_an_event_before_others_that_are_missing_may_hold_at_any_later_stamp():
    stamps = np.array([0, 25, 35, 99])
    whole, part = (
        EventOrder(each, range(len(each))) for each in ([START, *KICKS], [START, KICKS[2]])
    )
    assert whole.holds(0, stamps).tolist() == [True, False, False, False]
    assert part.holds(0, stamps).tolist() == [True] * 4
    assert (whole.is_ordered, part.is_ordered) == (True, False)


def test_stamps_are_repeated_between_the_end_of_a_jump_and_its_begin():
    back = event(2, 5, "clock", **{"from": 40, "to": 5})
    event_order = EventOrder([START, back], [0, 1])
    assert not event_order.is_ordered
    assert event_order.count_holding(np.array([0, 4, 5, 39, 40])).tolist() == [1, 1, 2, 2, 1]
    assert list(event_order.candidates(np.array([3]), np.array([0]))) == [0]
    assert set(event_order.candidates(np.array([20]), np.array([0]))) == {0, 1}
