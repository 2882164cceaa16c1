"""For each interval of time of a log, the motion that is known, or why none is.

An event says how the motion continues until the next one. If messages are lost an event may be
among them, and another motion may have followed. Events are numbered, and diagnostics name the
number of the latest one: they prove that none was lost, or that one was.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, islice, pairwise
from operator import itemgetter

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Stamps
from symtop_ros.run.log.event_order import Ordered
from symtop_ros.run.log.stamps import Row, StampRows
from symtop_ros.run.simulation.events import MAX_STAMP, Event

NOT_RECORDED = "the recording was off"
NO_BEGINNING = "the beginning is missing"
NO_PROOF = "an event may be lost, and no later event number shows otherwise"
NO_NUMBERS = "the diagnostics of this log do not number the events"
NO_EVENTS = "the log has no events"
REPEATED = "the clock has shown these times more than once, and the log is not in the run's order"
NOWHERE = 2**62  # a place after the end of every log


@dataclass(frozen=True, slots=True)
class Interval:
    """An interval of stamps in which one motion is known, or none."""

    begin: int  # stamps in ns: from `begin` on, and before `end`
    end: int
    # the last one, whose segment is the motion and its times; None: the motion is not known
    event: Event | None
    reason: str = ""  # why it is not known
    # if nothing is known: places of the first message, and after the last one
    places: tuple[int, int] = (0, 0)


def partition(intervals: Sequence[Interval]) -> Iterator[tuple[int, list[Interval]]]:
    """Yield the stamps at which other intervals hold, and these: none, one, or several."""
    spans = [each for each in intervals if each.begin < each.end]
    changes = [(each.begin, True, k) for k, each in enumerate(spans)]
    changes += [(each.end, False, k) for k, each in enumerate(spans)]
    holding: dict[int, Interval] = {}
    for stamp, group in groupby(sorted(changes), key=itemgetter(0)):
        for _, begins, k in group:
            if begins:
                holding[k] = spans[k]
            else:
                del holding[k]
        yield stamp, [*islice(holding.values(), 2)]


@dataclass(frozen=True, slots=True)
class Mark:
    """A place of the log, with the stamp (ns) of the run there."""

    place: int
    stamp: int
    number: int = 0  # of the latest event there; 0: it is not known


@dataclass(frozen=True, slots=True)
class MissingEvents:
    """Events of a run that a log does not have."""

    first: int  # their numbers
    last: int
    before: Event  # the events around them
    after: Event | None
    is_off: bool  # True if the recording was off, so that none was lost

    def describe(self) -> str:
        """Return what is missing, in a sentence."""
        are = "is" if self.first == self.last else "are"
        which = f"event {self.first}" if self.first == self.last else self._describe_several()
        if self.is_off:
            return f"{which} {are} not in the log: {NOT_RECORDED}"
        where = (
            f"between {self.before.stamp} and {self.after.stamp} ns"
            if self.after
            else f"after {self.before.stamp} ns"
        )
        return (
            f"{which} {are} missing, {where}; samples that follow from what is missing are not "
            "judged"
        )

    def _describe_several(self) -> str:
        return f"events {self.first} to {self.last}"


class Proofs:
    """Numbers of the latest event that diagnostics and repeated events show at their places."""

    def __init__(
        self, ordered: Ordered, marks: Sequence[Mark], has_diagnostics: bool = True
    ) -> None:
        self._ordered = ordered
        self.lacks_numbers = has_diagnostics and not marks
        self.begins = _find_begins(ordered)  # the first place of each run
        self._highest: dict[int, int] = {}  # numbers by runs
        self._latest: dict[tuple[int, int], Mark] = {}  # marks by runs and numbers
        for mark in marks:
            run = max(0, bisect_right(self.begins, mark.place) - 1)
            self._highest[run] = max(self._highest.get(run, 0), mark.number)
            self._latest[run, mark.number] = mark

    def find_highest(self, k: int) -> int:
        """Return the highest number that is shown in the run of an event."""
        return self._highest.get(self._ordered.runs[k], 0)

    def find_last(self, k: int) -> Mark:
        """Return the last place at which an event was the latest: its own place, or a later one."""
        event, place = self._ordered.events[k], self._ordered.places[k]
        found = self._latest.get((self._ordered.runs[k], event.number or -1))
        own = Mark(place, event.stamp, event.number)
        return found if found and found.place > place else own


def _find_begins(ordered: Ordered) -> list[int]:
    """Return the first place of each run."""
    begins: dict[int, int] = {}
    for run, place in zip(ordered.runs, ordered.places, strict=True):
        begins[run] = min(place, begins.get(run, place))
    return [*begins.values()]


def find_missing(ordered: Ordered, proofs: Proofs) -> dict[int, MissingEvents]:
    """Return the events that are missing after others, by the places of these in their order."""
    found = {}
    for k, event in enumerate(ordered.events):
        after = _next_of_run(ordered, k)
        highest = after.number - 1 if after else proofs.find_highest(k)
        if 0 < event.number < highest:
            is_off = after is not None and _ends_recording(event)
            found[k] = MissingEvents(event.number + 1, highest, event, after, is_off)
    return found


class Finder:
    """Finds the intervals of a log."""

    def __init__(
        self,
        ordered: Ordered,
        proofs: Proofs,
        breaks: Iterable[int],
        rows: StampRows,
        end: int | None = None,  # stamp (ns) of the last sample
        doubts: Iterable[int] = (),
    ) -> None:
        self._ordered, self._proofs, self._rows = ordered, proofs, rows
        # Places of the log at which messages are lost, of all topics or of some; at the latter an
        # event that is missing need not be among them.
        losses = set(breaks)
        self._doubts = {*doubts} - losses
        self._breaks = sorted(losses | self._doubts)
        self._missing = find_missing(ordered, proofs)
        self._begin = min((row.first for row in rows.rows), default=None)
        self._end = MAX_STAMP if end is None else end + 1

    def list_intervals(self) -> Iterator[Interval]:
        """Yield the intervals in the order of the run."""
        events = self._ordered.events
        first = min((event.stamp for event in events), default=self._end)
        if self._begin is not None and self._begin < first:
            reason, place = (NO_BEGINNING, 0) if events else (NO_EVENTS, NOWHERE)
            yield Interval(self._begin, first, None, reason, (0, place))
        if events and (end := self._find_end_before()) > first:
            yield Interval(first, end, None, NO_BEGINNING)
        for k in range(len(events)):
            yield from self._list_parts(k)

    def _find_end_before(self) -> int:
        """Return the stamp (ns) before which samples may be those of events before all of them.

        If the clock has gone back since then, these samples may have stamps after the first event.
        """
        event, place = self._ordered.events[0], self._ordered.places[0]
        rows = [row for row in self._rows.rows if row.first_place < place]
        lasts = [before.last + 1 for before, after in pairwise(rows) if after.first <= before.last]
        lasts += [event.previous_end] if rows else []
        return max(lasts, default=event.stamp) if event.number != 1 else event.stamp

    def _list_parts(self, k: int) -> Iterator[Interval]:
        """Yield the intervals between an event and the next one."""
        events, places = self._ordered.events, self._ordered.places
        event = events[k]
        has_next = k + 1 < len(events)
        end = self._find_end(k)
        proof, gap = self._proofs.find_last(k), self._missing.get(k)
        until = places[k + 1] if has_next else NOWHERE
        lost = self._find_break(proof.place, until)
        if gap is None and (lost is None or (event.number and _next_of_run(self._ordered, k))):
            yield Interval(event.stamp, end, event)
            return
        begin = proof.stamp
        unknown = (proof.place + 1, until)
        # An event that is missing may have been lost alone, before the samples of a gap.
        if lost is not None and (gap is None or lost not in self._doubts):
            last = self._rows.find_stamp(proof.place, lost)
            begin = proof.stamp if last is None else last + 1
            unknown = (lost, until)
        begin = max(begin, event.stamp)
        yield Interval(event.stamp, begin, event)
        for first, last in _list_pieces(self._rows, unknown, begin, end):
            yield Interval(first, last, None, self._explain(gap), unknown)

    def _find_end(self, k: int) -> int:
        """Return the stamp (ns) before which the motion after an event holds."""
        events, places = self._ordered.events, self._ordered.places
        if k + 1 == len(events):
            return max(self._end, events[k].stamp)
        following = events[k + 1]
        if _next_of_run(self._ordered, k):
            return following.previous_end
        # No node publishes between two runs, so the samples show how long the earlier run was.
        first = places[self._ordered.runs.index(self._ordered.runs[k])]
        is_later = following.stamp > events[k].stamp
        lasts = [
            row.last
            for row in self._rows.rows
            if first < row.last_place and row.first_place < places[k + 1]
            if not is_later or row.last < following.stamp
        ]
        none = following.stamp if is_later else MAX_STAMP
        return max([events[k].stamp, *(last + 1 for last in lasts)]) if self._rows.count else none

    def _find_break(self, after: int, until: int) -> int | None:
        place = bisect_right(self._breaks, after)
        found = self._breaks[place : place + 1]
        return found[0] if found and found[0] <= until else None

    def _explain(self, gap: MissingEvents | None) -> str:
        if gap:
            return NOT_RECORDED if gap.is_off else gap.describe()
        return f"{NO_PROOF}: {NO_NUMBERS}" if self._proofs.lacks_numbers else NO_PROOF


def _list_pieces(
    rows: StampRows, places: tuple[int, int], begin: int, end: int
) -> list[tuple[int, int]]:
    """Return the intervals of stamps that messages in a range of places have.

    There are several if an event that was lost is a jump of the clock.
    """
    pieces = [[begin, begin]]
    first, last = (bisect_left(rows.rows, place, key=_find_last_place) for place in places)
    for row in rows.rows[first:last]:
        if places[0] <= row.first_place and row.first < pieces[-1][1]:
            pieces.append([row.first, row.first])
        pieces[-1][1] = row.last + 1
    pieces[-1][1] = max(end, pieces[-1][1])
    found = [(since, until) for since, until in pieces if since < until]
    return found or [(begin, begin)]  # the range of places has only messages of other topics


def _find_last_place(row: Row) -> int:
    return row.last_place


def _next_of_run(ordered: Ordered, k: int) -> Event | None:
    """Return the next event of the same run of the node."""
    if k + 1 < len(ordered.events) and ordered.runs[k + 1] == ordered.runs[k]:
        return ordered.events[k + 1]
    return None


def _ends_recording(event: Event) -> bool:
    return event.name == "record" and event.values.get("outcome.kind") == "ended"


class Unknown:
    """Samples of which the motion is not known, by their stamps or by their places in the log."""

    def __init__(self, intervals: Iterable[Interval]) -> None:
        self._unknown = [each for each in intervals if each.event is None]
        self._stamps = _merge([(each.begin, each.end) for each in self._unknown])
        self._places = _merge([each.places for each in self._unknown])

    def find(self, stamps: Stamps, places: Places) -> Mask:
        """Return the mask of some samples, (n,)."""
        return _is_inside(self._stamps, stamps) | _is_inside(self._places, places)

    def explain(self, stamp: int, place: int) -> str:
        """Return why the motion is not known at one of them; empty if it is."""
        reasons = (
            each.reason
            for each in self._unknown
            if each.begin <= stamp < each.end or each.places[0] <= place < each.places[1]
        )
        return next(reasons, "")


def _merge(intervals: Sequence[tuple[int, int]]) -> Stamps:
    """Return disjoint intervals (n, 2) in their order, that cover the same numbers."""
    merged: list[list[int]] = []
    for begin, end in sorted(intervals):
        if merged and begin <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], end)
        elif begin < end:
            merged.append([begin, end])
    return np.array(merged, dtype=np.int64).reshape(-1, 2)


def _is_inside(intervals: Stamps, numbers: Stamps | Places) -> Mask:
    """Return the mask of the numbers (n,) that are in one of some disjoint intervals."""
    begun = np.searchsorted(intervals[:, 0], numbers, side="right")
    return np.asarray(begun > np.searchsorted(intervals[:, 1], numbers, side="right"))
