"""The events of a whole run, and which of them can hold at a stamp.

The node publishes its events in their order, but a recorder may log them after their first samples.
The stamps then decide. After a jump of the clock back they are repeated: several events can hold.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Stamps
from symtop_ros.simulation.events import MAX_STAMP, Event

MAX_CANDIDATES = 1000  # events that are tried for one sample; a log may be hostile
MAX_SEGMENTS = 100  # that are in memory


class Course:
    """The events of a run in the order of the log.

    If some could not be read, it is not known how long the last one holds.
    """

    def __init__(self, events: Sequence[Event], all_readable: bool = True) -> None:
        self._events = events
        # Kept, because a driven motion is integrated from its start.
        self.segment = lru_cache(MAX_SEGMENTS)(lambda number: events[number].segment())
        self._begins = np.array([event.stamp for event in events], dtype=np.int64)
        ends = [*(event.previous_end for event in events[1:]), MAX_STAMP]
        self._ends = np.array(ends[: len(events)], dtype=np.int64)
        numbers = [event.number for event in events]
        self._present = set(numbers)
        # True for an event after which others are missing: what holds then is known in part.
        gaps = [bool(self._find_missing(*pair)) for pair in pairwise(numbers)]
        self.has_gap = np.array([*gaps, not all_readable][: len(numbers)], dtype=np.bool_)
        # True if no stamp is repeated, so that the stamps alone decide.
        self.is_ordered = bool((self._begins[1:] >= self._ends[:-1]).all())
        self.is_ordered &= bool((self._begins <= self._ends).all())

    def list_missing(self) -> list[str]:
        """Describe the events that are missing between others, with the stamps around them."""
        found = []
        for place in np.flatnonzero(self.has_gap[:-1]).tolist():
            before, after = self._events[place], self._events[place + 1]
            missing = self._find_missing(before.number, after.number)
            first, last = missing[0], missing[-1]
            which = f"event {first} is" if first == last else f"events {first} to {last} are"
            found.append(
                f"{which} missing, between {before.stamp} and {after.stamp} ns; samples that "
                "follow from what is missing are not judged"
            )
        return found

    def list_repeated(self, allowed: int) -> list[str]:
        """Describe the events that are repeated.

        Each file of a run but the first may begin with the last event of the one before: `allowed`
        are the files that may.
        """
        keys = [(event.number, event.stamp) for event in self._events]
        allowed = min(allowed, sum(before == after for before, after in pairwise(keys)))
        repeated = len(keys) - len(set(keys)) - allowed
        return [f"{repeated} events are repeated"] if repeated > 0 else []

    def list_unknown(self) -> Iterator[tuple[int, int]]:
        """Yield the stretches of stamps (ns) in which events are missing."""
        for place in np.flatnonzero(self.has_gap).tolist():
            end = self._begins[place + 1] if place + 1 < len(self._begins) else MAX_STAMP
            yield int(self._begins[place]), int(end)

    def count_holding(self, stamps: Stamps) -> NDArray[np.intp]:
        """Return the number of events that can hold at each stamp, if none is missing."""
        ends = np.sort(np.maximum(self._begins, self._ends))
        begun = np.searchsorted(np.sort(self._begins), stamps, side="right")
        return np.asarray(begun - np.searchsorted(ends, stamps, side="right"))

    def _find_missing(self, before: int, after: int) -> list[int]:
        """Return numbers between those of two events that no event has; the ends of many."""
        if after - before > MAX_SEGMENTS + len(self._present):  # a number may be a hostile one
            return [before + 1, after - 1]
        # A log that was sorted by time may have events in another order.
        return [number for number in range(before + 1, after) if number not in self._present]

    def holds(self, number: int, stamps: Stamps, in_order: bool = True) -> NDArray[np.bool_]:
        """Return the mask of the stamps at which an event can hold.

        If it is not taken for granted that the events are in order, that is at any later stamp.
        """
        later = stamps >= self._begins[number]
        return np.asarray(later & (stamps < self._ends[number]) if in_order else later)

    def find_owners(self, stamps: Stamps, places: NDArray[np.intp]) -> NDArray[np.intp]:
        """Return the number of the event to which each sample belongs; -1: before all of them.

        `places` (n,) are the numbers of events before the samples in the log; they decide if the
        stamps do not.
        """
        by_stamp = np.searchsorted(self._begins, stamps, side="right") - 1
        if self.is_ordered:
            return by_stamp
        first = self._begins.min(initial=MAX_STAMP)
        return np.where(stamps < first, -1, np.maximum(places - 1, 0))

    def candidates(
        self, stamps: Stamps, owners: NDArray[np.intp], in_order: bool = True
    ) -> Iterator[int]:
        """Yield the events that can hold at any of the stamps; the owners, or near ones, first."""
        if self.is_ordered:
            yield from np.unique(owners[owners >= 0]).tolist()
            return
        possible = self._begins <= stamps.max()
        if in_order:
            possible &= self._ends > stamps.min()
        numbers = np.flatnonzero(possible)
        low, high = owners.min(), owners.max()
        distance = np.maximum(low - numbers, 0) + np.maximum(numbers - high, 0)
        yield from numbers[np.argsort(distance, kind="stable")][:MAX_CANDIDATES].tolist()
