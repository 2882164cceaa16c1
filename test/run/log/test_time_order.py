"""The passes of a log through time, found by the order of samples and by events."""

import numpy as np
import pytest
from run.log.test_event_order import START, event, order

from symtop_ros.run.log.time_order import TimeOrder

MS = 1_000_000
FIRST = [k * 10 * MS for k in range(100)]
SECOND = [(400 + k * 10) * MS for k in range(80)]
BACK = event(2, SECOND[0], "clock", **{"from": FIRST[-1] + 10 * MS, "to": SECOND[0]})
BACK_PLACE = 1 + len(FIRST)


def find(stamps, place=BACK_PLACE):
    """The passes of samples at the places 1, 2, ..., between which the jump has its own."""
    places = np.arange(1, len(stamps) + 1)
    places[places >= place] += 1
    ordered = order_at(place)
    return TimeOrder(ordered).find(np.array(stamps), places)


def order_at(place):
    from symtop_ros.run.log.event_order import order_events

    return order_events([(0, START), (place, BACK)], (0,))


def test_without_a_jump_there_is_one_pass_whatever_the_order():
    assert not TimeOrder(order(START)).find(np.array(FIRST[::-1]), np.arange(100)).any()


@pytest.mark.parametrize("late", [-30, -1, 0, 1, 30])
def test_an_event_may_come_early_or_late(late):
    found = find([*FIRST, *SECOND], BACK_PLACE + late)
    assert found.tolist() == [0] * len(FIRST) + [1] * len(SECOND)


def test_samples_next_to_a_jump_may_be_exchanged():
    stamps = [*FIRST, *SECOND]
    stamps[97], stamps[103] = stamps[103], stamps[97]
    found = find(stamps)
    assert [stamps[k] for k in np.flatnonzero(found == 0)] == sorted(FIRST, key=stamps.index)


def test_an_order_by_stamps_does_not_show_the_passes():
    assert find(sorted([*FIRST, *SECOND])) is None
