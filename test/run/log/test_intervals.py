"""Intervals in which the motion is known, by events, losses and the numbers in diagnostics."""

import numpy as np
import pytest
from run.log.test_event_order import KICKS, START, event, order
from run.log.test_grid import rows_of

from symtop_ros.run.log.intervals import (
    NO_BEGINNING,
    NO_EVENTS,
    NO_NUMBERS,
    NO_PROOF,
    NOT_RECORDED,
    NOWHERE,
    Finder,
    Mark,
    Proofs,
    Unknown,
    find_missing,
)

STAMPS = range(60)  # ns; each has its place in the log, with events between them
SECOND, THIRD, _ = KICKS  # at 20 and 30 ns


def find(events, marks=(), breaks=(), stamps=STAMPS, places=None):
    """The begin, the end and the number, or the reason, of each interval."""
    places = places or [each.stamp for each in events]
    ordered = order_at(events, places)
    proofs = Proofs(ordered, [Mark(place, place, number) for place, number in marks])
    found = list(Finder(ordered, proofs, breaks, rows_of(stamps), max(stamps)).list_intervals())
    return [
        (each.begin, each.end, each.event.number if each.event else each.reason) for each in found
    ]


def order_at(events, places):
    from symtop_ros.run.log.event_order import order_events

    return order_events(list(zip(places, events, strict=True)), (0,))


def test_without_a_loss_each_event_holds_until_the_next():
    assert find([START, SECOND]) == [(0, 20, 1), (20, 60, 2)]


def test_a_loss_before_the_next_number_has_lost_no_event():
    assert find([START, SECOND], breaks=[10]) == [(0, 20, 1), (20, 60, 2)]


@pytest.mark.parametrize(("marks", "end"), [([], 39), ([(38, 2)], 39), ([(50, 2)], 60)])
def test_after_a_loss_the_latest_number_decides(marks, end):
    known, *unknown = find([START, SECOND], marks, breaks=[40])[1:]
    assert known == (20, end, 2)
    reason = NO_PROOF if marks else f"{NO_PROOF}: {NO_NUMBERS}"
    assert unknown == ([] if end == 60 else [(end, 60, reason)])


def test_after_an_event_that_is_missing_nothing_is_known_from_the_loss_on():
    lost = "event 2 is missing, between 0 and 30 ns; samples that follow from what is missing are "
    (first, second, third) = find([START, THIRD], breaks=[15])
    assert (first, third) == ((0, 14, 1), (30, 60, 3))
    assert second == (14, 30, f"{lost}not judged")
    # without a loss that is seen, from the last proof on
    assert find([START, THIRD], marks=[(12, 1), (25, 2)])[:2] == [(0, 12, 1), (12, 30, second[2])]


def test_diagnostics_show_that_the_last_event_is_missing():
    known, unknown = find([START], marks=[(10, 1), (50, 3)], breaks=[30])
    assert known == (0, 29, 1)
    assert unknown[:2] == (29, 60)
    assert unknown[2].startswith("events 2 to 3 are missing, after 0 ns; ")


def test_a_recording_that_was_off_has_lost_nothing():
    ended = event(2, 20, "record")
    ended.values["outcome.kind"] = "ended"
    events = START, ended, event(5, 40)
    assert find(events) == [(0, 20, 1), (20, 20, 2), (20, 40, NOT_RECORDED), (40, 60, 5)]
    (gap,) = find_missing(order(*events), Proofs(order(*events), [])).values()
    assert gap.describe() == "events 3 to 4 are not in the log: the recording was off"


def test_before_the_first_event_and_without_any_nothing_is_known():
    late = event(1, 10, "start")
    assert find([late]) == [(0, 10, NO_BEGINNING), (10, 60, 1)]
    assert find([]) == [(0, 60, NO_EVENTS)]


def test_a_jump_that_is_lost_leaves_two_intervals_that_are_not_known():
    back = [*range(30), *range(5, 15)]
    jumped = event(3, 20, "kick")
    found = find([START, jumped], breaks=[26], stamps=back, places=[0, 100])
    assert [each[:2] for each in found] == [(0, 25), (25, 30), (5, 20), (20, 30)]


def test_samples_are_unknown_by_their_stamps_and_by_their_places():
    ordered = order_at([START], [0])
    proofs = Proofs(ordered, [])
    intervals = list(Finder(ordered, proofs, [41], rows_of(STAMPS), 59).list_intervals())
    stamps = np.array([39, 40, 5, 50])
    places = np.array([40, 40, 45, NOWHERE])
    assert Unknown(intervals).find(stamps, places).tolist() == [False, True, True, True]
