"""The passes of a log through time: a clock that goes back begins one, and so does another run.

Within a pass stamps alone give the order of samples. Which pass a sample belongs to is said by its
place in the log: that at which time goes back, near the event that says so.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Stamps
from symtop_ros.run.log.event_order import Ordered
from symtop_ros.run.log.stamps import ROUNDING
from symtop_ros.run.simulation.events import MAX_STAMP, Event

QUARTILES = 0.25, 0.75
NEAR = 20  # samples of a topic next to a jump: messages may be exchanged


class TimeOrder:
    """The passes of a log, of which the events say where they begin and end."""

    def __init__(self, ordered: Ordered) -> None:
        self._events, self._places = ordered.events, ordered.places
        # Numbers of the events with which passes begin.
        self._begins = [
            k + 1
            for k, (before, event) in enumerate(pairwise(ordered.events))
            if _begins_pass(before, event) or ordered.runs[k] != ordered.runs[k + 1]
        ]
        if any(event.previous_end > event.stamp for event in ordered.events[:1]):
            self._begins.insert(0, 0)

    @property
    def count(self) -> int:
        """Number of passes."""
        return 1 + len(self._begins)

    def find(self, stamps: Stamps, places: Places) -> Places | None:
        """Return the number of the pass of each sample (n,), in the order of the log.

        None if the order of the log does not show it, for example in a log that was sorted by time.
        """
        found = self.find_by_place(stamps, places)
        if found is not None:
            return found
        usual = float(np.median(np.abs(np.diff(stamps)))) if len(stamps) > 1 else 0.0
        passes = np.zeros(len(stamps), dtype=np.int64)
        for number, begin in zip(self._begins, self._find_begins(places).tolist(), strict=True):
            passes += self._find_later(stamps, usual, number, begin)
        is_near = _measure_disorder(stamps, passes) <= NEAR * usual
        return passes if is_near and self._agrees(stamps, passes) else None

    def find_by_place(self, stamps: Stamps, places: Places) -> Places | None:
        """Return the same; None if an event is not between the samples of its two passes."""
        passes = np.zeros(len(stamps), dtype=np.int64)
        for begin in self._find_begins(places):
            passes[begin:] += 1
        is_sound = self._agrees(stamps, passes) and _measure_disorder(stamps, passes) == 0
        return passes if is_sound or not self._begins else None

    def _find_begins(self, places: Places) -> Places:
        """Return which of the samples at some places is the first after each begin."""
        return np.searchsorted(places, [self._places[k] for k in self._begins])

    def _find_later(self, stamps: Stamps, period: float, number: int, begin: int) -> Mask:
        """Return the mask of the samples from the begin of a pass on, which is near a place.

        Messages may have been exchanged, and the event may have come late.
        """
        event = self._events[number]
        width = event.previous_end - event.stamp
        reach = NEAR
        if width > 0:
            begin = _find_return(stamps, begin, width)
            reach = min(NEAR, int(width / 4 / period) if period else 0)
            middle: float | None = event.stamp // 2 + event.previous_end // 2
        else:
            middle = _find_middle(stamps, begin)
        is_later = np.arange(len(stamps)) >= begin
        if middle is not None:
            near = slice(max(0, begin - reach), begin + reach)
            is_low = stamps[near] < middle
            has_been_high = np.maximum.accumulate(~is_low)
            goes_back = event.stamp < middle and stamps[begin - 1 : begin].max(initial=0) > middle
            is_later[near] = is_low & has_been_high if goes_back else ~is_low
        return np.asarray(is_later)

    def _agrees(self, stamps: Stamps, passes: Places) -> bool:
        """Return True if the samples of each pass are between its begin and its end.

        In a log that was sorted time goes back nowhere, and stamps are there twice.
        """
        is_sorted = (np.diff(stamps) >= 0).all()
        if is_sorted and (np.diff(stamps) <= ROUNDING).any():
            return False
        begins = np.array([-MAX_STAMP, *(self._events[k].stamp for k in self._begins)])
        ends = np.array([*map(self._find_end, self._begins), MAX_STAMP])
        return bool(((begins[passes] <= stamps) & (stamps < ends[passes])).all())

    def _find_end(self, number: int) -> int:
        """Return the end (ns) of the pass before an event; unlimited for a pass of another run."""
        event = self._events[number]
        return event.previous_end if event.previous_end > event.stamp else MAX_STAMP

    def find_owners(self, stamps: Stamps, passes: Places) -> Places:
        """Return the number of the event to which each sample belongs; -1: before all of them."""
        owners = np.full(len(stamps), -1, dtype=np.int64)
        bounds = [0, *self._begins, len(self._events)]
        for number, (first, last) in enumerate(pairwise(bounds)):
            chosen = passes == number
            begins = np.array([each.stamp for each in self._events[first:last]], dtype=np.int64)
            # An act holds at no stamp if one that follows it came before its stamp.
            begins = np.minimum.accumulate(begins[::-1])[::-1]
            owners[chosen] = first - 1 + np.searchsorted(begins, stamps[chosen], side="right")
        return owners

    def list_spans(self, first: int, last: int) -> Iterator[tuple[int, int]]:
        """Yield the intervals of time (ns) from an event to the next, for each pass one."""
        begin, end = self._events[first].stamp, self._events[last].stamp
        for since, until, _ in self.cut(first, last, begin, end):
            yield since, until

    def cut(
        self, owner: int, following: int, begin: int, end: int
    ) -> Iterator[tuple[int, int, bool]]:
        """Yield the intervals of time (ns) between two samples, of which the owners are given.

        The third value of each interval is True if a sample is at its begin.
        """
        is_sample = True
        for number in self._begins:
            if owner < number <= following:
                yield begin, self._events[number].previous_end, is_sample
                begin, is_sample = self._events[number].stamp, False
        yield begin, end, is_sample


def _begins_pass(before: Event, event: Event) -> bool:
    """Return True if the clock went back at an event, or may have gone back at one that is lost.

    A run in its own time pauses at once, so its stamp may be before that of the previous act.
    """
    is_next = event.number == before.number + 1
    return event.previous_end > event.stamp or (before.stamp > event.stamp and not is_next)


def _measure_disorder(stamps: Stamps, passes: Places) -> int:
    """Return by how much (ns) a sample is before another of its pass that is earlier in the log."""
    return max(
        int((np.maximum.accumulate(own) - own).max(initial=0))
        for own in (stamps[passes == number] for number in np.unique(passes))
    )


def _find_return(stamps: Stamps, begin: int, width: int) -> int:
    """Return the sample nearest to one at which time goes back by half a width (ns) or more."""
    found = 1 + np.flatnonzero(np.diff(stamps) < -width / 2)
    return int(found[np.argmin(np.abs(found - begin))]) if len(found) else begin


def _find_middle(stamps: Stamps, begin: int) -> float | None:
    """Return a stamp between those of two runs around a place; None if they are not apart."""
    around = stamps[max(0, begin - NEAR) : begin], stamps[begin : begin + NEAR]
    if not all(map(len, around)):
        return None
    (low, high), (first, last) = (np.quantile(each, QUARTILES) for each in around)
    is_apart = high < first or last < low
    return float(low + high + first + last) / 4 if is_apart else None
