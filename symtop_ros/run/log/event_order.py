"""The events of a run in their order: which of them can hold at a stamp.

The node publishes its events in their order and numbers them, but a recorder may log them after
their first samples, repeat them in each file, or be sorted by time. The numbers decide, and stamps
say which event holds. After a jump of the clock back stamps are repeated: several events can hold.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Stamps
from symtop_ros.run.simulation.events import MAX_STAMP, RESTARTS, Event

MAX_CANDIDATES = 1000  # events that are tried for one sample; a log may be hostile
MAX_SEGMENTS = 100  # that are in memory
Placed = tuple[int, Event]  # with the place in the log


@dataclass(frozen=True)
class Ordered:
    """The events of a log, each once, in the order of the runs of the node."""

    events: tuple[Event, ...] = ()
    places: tuple[int, ...] = ()  # in the log
    runs: tuple[int, ...] = ()  # number of the run of each event: a restarted node begins a new run
    repeated: tuple[Placed, ...] = ()  # those that a recorder has repeated at the begin of a file
    doubled: int = 0  # events that are there twice in other places
    contradicting: tuple[Event, ...] = ()  # events that are repeated with different contents


def order_events(found: Sequence[Placed], begins: Sequence[int]) -> Ordered:
    """Return events in their order; `begins` are the places at which the files of the log begin."""
    runs: list[dict[object, Placed]] = []
    repeated: list[Placed] = []
    contradicting: list[Event] = []
    doubled = 0
    newest = -1  # the file in which the latest new event was found
    for place, event in found:
        file = bisect_right(begins, place)
        if not runs or _begins_run(event, runs[-1]):
            runs.append({})
        key = event.number or (event.stamp, event.name, tuple(event.values.items()))
        known = runs[-1].get(key)
        if known is None:
            runs[-1][key] = place, event
            newest = file
        elif known[1] != event:
            contradicting.append(event)
        elif file > max(newest, bisect_right(begins, known[0])):
            repeated.append((place, event))
        else:
            doubled += 1
    # The order is stable: events without numbers stay in that of the log.
    ordered = [sorted(run.values(), key=lambda each: each[1].number) for run in runs]
    return Ordered(
        tuple(event for run in ordered for _, event in run),
        tuple(place for run in ordered for place, _ in run),
        tuple(number for number, run in enumerate(ordered) for _ in run),
        tuple(repeated),
        doubled,
        tuple(contradicting),
    )


def _begins_run(event: Event, run: dict[object, Placed]) -> bool:
    """Return True if an event is not of the run before it: its node was started again."""
    if not event.number:
        return False
    known = run.get(event.number)
    if known is not None:  # simulated time may begin at 0 each time
        return known[1].stamp != event.stamp or (event.number == 1 and known[1] != event)
    is_first = event.number == 1 and event.name in RESTARTS
    return is_first and all(each.previous_end <= event.stamp for _, each in run.values())


def _find_end(event: Event, after: Event) -> int:
    """Return the stamp (ns) up to which an event holds; unlimited if events may be missing."""
    is_next = after.number <= event.number + 1  # a smaller number is that of another run
    return after.previous_end if is_next else MAX_STAMP


class EventOrder:
    """The events of a run in their order, with their places in the log."""

    def __init__(self, events: Sequence[Event], places: Sequence[int]) -> None:
        self._places = np.array(places, dtype=np.int64)
        self._by_place = np.argsort(self._places, kind="stable")
        # True if the log has the events in their order
        self.is_in_log_order = bool((np.diff(self._places) > 0).all())
        # Kept, because a driven motion is integrated from its start.
        self.segment = lru_cache(MAX_SEGMENTS)(lambda number: events[number].segment())
        self._begins = np.array([event.stamp for event in events], dtype=np.int64)
        ends = [*map(_find_end, events, events[1:]), MAX_STAMP]
        self._ends = np.array(ends[: len(events)], dtype=np.int64)
        # True if no stamp is repeated, so that the stamps alone decide.
        follows = self._begins[1:] >= self._ends[:-1]
        lasts = self._begins <= self._ends
        self.is_ordered = bool(follows.all() and lasts.all())

    def count_holding(self, stamps: Stamps) -> Places:
        """Return the number of events that can hold at each stamp."""
        ends = np.sort(np.maximum(self._begins, self._ends))
        begun = np.searchsorted(np.sort(self._begins), stamps, side="right")
        return np.asarray(begun - np.searchsorted(ends, stamps, side="right"))

    def holds(self, number: int, stamps: Stamps) -> Mask:
        """Return the mask of the stamps at which an event can hold."""
        return np.asarray((stamps >= self._begins[number]) & (stamps < self._ends[number]))

    def find_latest(self, places: Places) -> Places:
        """Return the number of the latest event before each place of the log; -1: none is."""
        count = np.searchsorted(self._places[self._by_place], places, side="right")
        return np.concatenate(([-1], self._by_place))[count]

    def find_owners(self, stamps: Stamps, places: Places) -> Places:
        """Return the number of the event to which each sample belongs; -1: before all of them.

        The places (n,) of the samples in the log decide if the stamps do not.
        """
        if self.is_ordered:
            return np.searchsorted(self._begins, stamps, side="right") - 1
        latest = np.maximum(self.find_latest(places), 0)
        return np.where(stamps < self._begins.min(initial=MAX_STAMP), -1, latest)

    def candidates(self, stamps: Stamps, owners: Places) -> Iterator[int]:
        """Yield the events that can hold at any of the stamps; the owners, or near ones, first."""
        if self.is_ordered:
            yield from np.unique(owners[owners >= 0]).tolist()
            return
        possible = (self._begins <= stamps.max()) & (self._ends > stamps.min())
        numbers = np.flatnonzero(possible)
        low, high = owners.min(), owners.max()
        distance = np.maximum(low - numbers, 0) + np.maximum(numbers - high, 0)
        yield from numbers[np.argsort(distance, kind="stable")][:MAX_CANDIDATES].tolist()
