"""Samples that are missing or repeated: the node publishes on a grid of stamps.

Every event that changes the grid names it, and so does the metadata of each recording. Two
neighbours that are further apart than a period have lost those between them: in the node, which
counts them as missed, or afterwards.
"""

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Real, Stamps
from symtop_ros.run.log.batch import TF
from symtop_ros.run.log.event_order import EventOrder, Ordered
from symtop_ros.run.log.source import MessageSource
from symtop_ros.run.log.stamps import StampRows
from symtop_ros.run.log.time_order import TimeOrder
from symtop_ros.run.log.writer import BEGUN_ENTRY, FILE_ENTRY, METADATA
from symtop_ros.run.simulation.events import MAX_STAMP, WHOLE, Event
from symtop_ros.run.wire.layout import NANOSECONDS

Empty = tuple[int, int, int]  # number of an event, and two stamps in ns
MIN_RATE, MAX_RATE = 1e-3, 1e6  # Hz; a log may be hostile
RATE, TF_SWITCH, OWN_TIME = "publish_rate", "publish_tf", "publish_clock"
OFF_GRID = "clock", "pause", "resume", "step", "record"  # events
BEGUN = "begun"  # the outcome of an event with which a recording begins
MAX_FILES = 1000  # of a recording whose numbers are compared
WIDE = 1.5  # periods: neighbours that are further apart have lost samples


@dataclass(frozen=True, slots=True)
class Gap:
    """Neighbours between which samples are missing."""

    before: int  # stamps in ns
    after: int
    place: int  # in the log, right behind the earlier one
    missing: int  # samples
    has_event: bool = False  # True if an event in it may have had samples off the grid
    until: int = 0  # in the log: place of the later one

    @property
    def stamps(self) -> tuple[int, int]:
        """The stamps of both neighbours."""
        return self.before, self.after


@dataclass(frozen=True, slots=True)
class GridFindings:
    """Samples of a topic that are missing or repeated."""

    gaps: tuple[Gap, ...] = ()
    repeated: int = 0
    # places in the log at which time goes back without an event that says so
    returns: tuple[int, ...] = ()
    rate: float | None = None  # samples per s, of the first ones
    is_least: bool = False  # True if more may be missing, and repeated

    @property
    def missing(self) -> int:
        """Number of samples that are missing."""
        return sum(gap.missing for gap in self.gaps)


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording of the node in a log, which may have several files."""

    place: int  # of its first message in the log
    rate: str = ""  # parameter publish_rate, as the metadata has it
    missed: str = ""  # samples that the node had missed at its begin
    is_own_time: bool = False  # True if the run has its own time, which a pause stops


def list_recordings(file: MessageSource) -> list[Recording]:
    """Return the recordings of a log; files of other recorders are one."""
    found: dict[str, Recording] = {}
    for place, each in zip(file.begins, file.files, strict=False):
        values = each.metadata.get(METADATA, {})
        recording = Recording(
            place,
            values.get(f"parameter.{RATE}", ""),
            values.get("missed", ""),
            values.get(f"parameter.{OWN_TIME}") == str(True),
        )
        found.setdefault(values.get(BEGUN_ENTRY, ""), recording)
    return list(found.values())


def list_absent_files(file: MessageSource) -> list[int]:
    """Return the numbers of missing files of a recording, except files after the last one."""
    found: dict[str, set[int]] = {}
    for each in file.files:
        values = each.metadata.get(METADATA, {})
        number = values.get(FILE_ENTRY, "")
        if BEGUN_ENTRY in values and WHOLE.fullmatch(number) and int(number) <= MAX_FILES:
            found.setdefault(values[BEGUN_ENTRY], set()).add(int(number))
    return sorted({n for there in found.values() for n in {*range(1, max(there))} - there})


class Grid:
    """The grid of stamps of a log."""

    def __init__(self, ordered: Ordered, recordings: Sequence[Recording]) -> None:
        self._event_order = EventOrder(ordered.events, ordered.places)
        self._periods = np.array([*_list_periods(ordered, recordings)])  # first before all events
        is_own_time = any(each.is_own_time for each in recordings)
        self.passes = TimeOrder(ordered)
        # Times without samples, each with the number of the event that says so.
        empty = [
            *_list_jumps(ordered.events),
            *_list_pauses(ordered.events, self.passes),
            *(_list_resumptions(ordered.events, self._periods[1:]) if is_own_time else ()),
        ]
        self._jumps = _find_jumps(ordered)
        # One entry for each event, and one at the end (owner -1) for what is before all events.
        self._runs = np.array([*ordered.runs, *ordered.runs[:1]], dtype=np.int64)
        # Places at which recordings begin, and events that say so.
        self._recordings = [each.place for each in recordings[1:]]
        self._begun = {
            k for k, event in enumerate(ordered.events) if event.values.get("outcome.kind") == BEGUN
        }
        self._changes = {k for k, event in enumerate(ordered.events) if _changes_grid(event)}
        self._empty = sorted(empty)
        self._empty_of_tf = sorted([*empty, *_list_times_without_tf(ordered.events)])

    def judge(self, name: str, rows: StampRows) -> GridFindings:
        """Return what is missing and repeated in a topic."""
        if not rows.rows:
            return GridFindings()
        stamps, places = samples = rows.expand()
        returns = tuple(self._list_returns(*samples))
        passes = self.passes.find(stamps, places)
        if passes is None:
            # It is not known which samples are neighbours, but the number of extra samples is
            # known.
            repeated = self._count_too_many(stamps)
            return GridFindings((), repeated, returns, self._find_rate(rows), is_least=True)
        repeated = rows.count_repeated(passes)
        order = np.lexsort((stamps, passes))  # whatever the order of the chunks of a file is
        stamps, places, passes = stamps[order], places[order], passes[order]
        owners = self.passes.find_owners(stamps, passes)
        gaps = self._find_gaps(name, (stamps, places, owners, passes), _find_usual_period(rows))
        return GridFindings(tuple(gaps), repeated, returns, self._find_rate(rows))

    def _count_too_many(self, stamps: Stamps) -> int:
        """Return the number of extra samples: more than one for each event that holds then."""
        times, counts = np.unique(stamps, return_counts=True)
        allowed = np.maximum(self._event_order.count_holding(times), 1)
        return int(np.maximum(counts - allowed, 0).sum())

    def _find_rate(self, rows: StampRows) -> float | None:
        """Return the samples per s of the first ones."""
        stamps = np.array([row.first for row in rows.rows[:1]], dtype=np.int64)
        places = np.array([row.first_place for row in rows.rows[:1]], dtype=np.int64)
        owners = self._event_order.find_owners(stamps, places)
        (period,) = self._find_periods(owners, _find_usual_period(rows)).tolist()
        return NANOSECONDS / period if period else None

    def _list_returns(self, stamps: Stamps, places: Places) -> Iterator[int]:
        if not self._event_order.is_in_log_order:  # chunks or messages are in another order
            return
        latest = self._event_order.find_latest(places)
        for k in np.flatnonzero(stamps[1:] < stamps[:-1]).tolist():
            # An event may come late.
            if not self._explains_return(range(int(latest[k]) + 1, int(latest[k + 1]) + 2)):
                yield int(places[k]) + 1

    def _explains_return(self, numbers: range) -> bool:
        """Return True if one of some events sets the clock, or begins another run."""
        return any(number in self._jumps for number in numbers)

    def _find_periods(self, owners: Places, usual: float) -> Real:
        """Return the period (ns) of the grid at each sample, of which the owners are the events."""
        periods = self._periods[owners + 1]
        return np.where(np.isnan(periods), usual, periods)

    def _find_gaps(
        self, name: str, samples: tuple[Stamps, Places, Places, Places], usual: float
    ) -> Iterator[Gap]:
        stamps, places, owners, passes = samples
        periods = self._find_periods(owners, usual)
        before, after = stamps[:-1], stamps[1:]
        period = np.maximum(periods[:-1], periods[1:])
        # Between two runs no node published. A run begins like a log: with its first sample.
        is_one_run = self._runs[owners[:-1]] == self._runs[owners[1:]] if len(self._runs) else True
        is_wide = (after - before > WIDE * period) | (np.diff(passes) > 0)
        # Before the first event, a lost event may explain the gap.
        is_wide &= ~self._is_unsaid(places, owners) & (owners[:-1] >= 0)
        wide = np.flatnonzero((period > 0) & is_wide & is_one_run)
        columns = before, after, owners[:-1], owners[1:], period, places[:-1] + 1, places[1:]
        for begin, end, owner, next_owner, step, place, until in zip(
            *(each[wide].tolist() for each in columns), strict=True
        ):
            empty = self._empty_of_tf if name == TF else self._empty
            numbers = slice(
                *(bisect_right(empty, (each, MAX_STAMP)) for each in (owner, next_owner))
            )
            has_event = any(number in self._changes for number in range(owner + 1, next_owner + 1))
            # An event between two samples may have had a slower grid; an unknown period is nan.
            between = self._periods[owner + 1 : next_owner + 2]
            slowest = float(np.fmax.reduce(between, initial=step))
            for first, last, is_first in self.passes.cut(owner, next_owner, begin, end):
                lost = last - first - _measure(empty[numbers], first, last)
                # The first sample of a pass is at the stamp at which it begins.
                if (missing := round(lost / slowest) - is_first) > 0:
                    yield Gap(first, last, place, missing, has_event, until)

    def _is_unsaid(self, places: Places, owners: Places) -> Mask:
        """Return the mask of the gaps (n - 1,) between two recordings, if no event says so."""
        recordings = np.searchsorted(self._recordings, places, side="right")
        begun = np.searchsorted(sorted(self._begun), owners, side="right")
        return np.asarray((np.diff(recordings) > 0) & (np.diff(begun) == 0))


def _changes_grid(event: Event) -> bool:
    """Return True if samples may be off the grid at an event."""
    return event.name in OFF_GRID or RATE in event.request


def _measure(intervals: Iterable[Empty], begin: int, end: int) -> int:
    """Return how many ns of a stretch are inside intervals, which may overlap."""
    covered = 0
    reached = begin
    for first, last in sorted((first, min(last, end)) for _, first, last in intervals):
        covered += max(0, last - max(first, reached))
        reached = max(reached, last)
    return covered


def _find_usual_period(rows: StampRows) -> float:
    """Return the step (ns) that most samples have: the period of a grid that nothing names."""
    steps: dict[int, int] = {}
    for row in rows.rows:
        if row.samples > 1 and row.last > row.first:
            step = round((row.last - row.first) / (row.samples - 1))
            steps[step] = steps.get(step, 0) + row.samples - 1
    return float(max(steps, key=lambda step: steps[step], default=0))


def _list_periods(ordered: Ordered, recordings: Sequence[Recording]) -> Iterator[float]:
    """Yield the period (ns) of the grid before all events, and after each; nan if it is unknown."""
    begun = [*recordings]
    period = _read_period(begun[0].rate) if begun else float("nan")
    yield period
    for place, event in zip(ordered.places, ordered.events, strict=True):
        # The first event that is new in a recording was the latest one at its begin.
        while begun and begun[0].place <= place:
            period = _read_period(begun.pop(0).rate)
        if RATE in event.request:
            period = _read_period(event.request[RATE])
        yield period


def _read_period(text: str) -> float:
    """Return the period in ns of a rate; nan if the text is no rate."""
    try:
        rate = float(text)
    except ValueError:
        return float("nan")
    return NANOSECONDS / rate if MIN_RATE <= rate <= MAX_RATE else float("nan")


def _find_jumps(ordered: Ordered) -> set[int]:
    """Return the numbers of events at which time may go back: jumps, and the first of each run."""
    firsts = {ordered.runs.index(run) for run in set(ordered.runs)}
    return firsts | {k for k, event in enumerate(ordered.events) if event.name == "clock"}


def _list_jumps(events: Sequence[Event]) -> Iterator[Empty]:
    """Yield the times that a clock or a step has passed over."""
    for number, event in enumerate(events):
        if event.name == "clock":
            yield number, event.previous_end, event.stamp
        to = event.request.get("to", "")
        if event.name == "step" and WHOLE.fullmatch(to):
            yield number, event.stamp, min(int(to), MAX_STAMP)


def _list_pauses(events: Sequence[Event], passes: TimeOrder) -> Iterator[Empty]:
    """Yield the pauses of a recording."""
    records = (number for number, event in enumerate(events) if event.name == "record")
    for before, after in pairwise(records):
        if events[after].values.get("outcome.kind") == BEGUN:
            yield from ((after, *span) for span in passes.list_spans(before, after))


def _list_resumptions(events: Sequence[Event], periods: Real) -> Iterator[Empty]:
    """Yield the times around the end of a pause that have no samples, of a run in its own time.

    The grid begins anew a period after the end. An act right before the pause takes the stamp of a
    sample, which is then not sent. If a recording began in the pause, the sample at its beginning
    is not recorded.
    """
    is_begun = False
    for number, (event, period) in enumerate(zip(events, periods.tolist(), strict=True)):
        if event.name == "resume":
            if not math.isnan(period):
                after = int(period) if is_begun else 0
                yield number, event.stamp - int(period), event.stamp + after
            is_begun = False
        is_begun |= event.values.get("outcome.kind") == BEGUN


def _list_times_without_tf(events: Sequence[Event]) -> Iterator[Empty]:
    """Yield the times in which /tf was switched off: only a log of the node has its samples."""
    changes = [(number, event) for number, event in enumerate(events) if TF_SWITCH in event.request]
    for (number, before), (_, after) in pairwise([*changes, (-1, None)]):
        if before and before.request[TF_SWITCH] == "false":
            yield number, before.stamp, after.stamp if after else MAX_STAMP
