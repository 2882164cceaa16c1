"""Samples that are missing or repeated: the node publishes on a grid of stamps.

Every event that changes the grid names it, and so does the metadata of each recording. Two
neighbours that are further apart than a period have lost those between them: in the node, which
counts them as missed, or afterwards.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from symtop_ros.arrays import Mask, Places, Real, Stamps
from symtop_ros.log.batch import TF
from symtop_ros.log.course import Course, Ordered
from symtop_ros.log.source import MessageSource
from symtop_ros.log.stamps import StampRows
from symtop_ros.log.writer import BEGUN_ENTRY, METADATA
from symtop_ros.simulation.events import MAX_STAMP, WHOLE, Event
from symtop_ros.wire.layout import NANOSECONDS

Interval = tuple[int, int]  # two stamps in ns
MIN_RATE, MAX_RATE = 1e-3, 1e6  # Hz; a log may be hostile
RATE, TF_SWITCH = "publish_rate", "publish_tf"
WIDE = 1.5  # periods: neighbours that are further apart have lost samples


@dataclass(frozen=True, slots=True)
class Gap:
    """Neighbours between which samples are missing."""

    before: int  # stamps in ns
    after: int
    place: int  # of the later one in the log
    missing: int  # samples


@dataclass(frozen=True, slots=True)
class GridFindings:
    """What is missing of the samples of a topic, or there too often."""

    gaps: tuple[Gap, ...] = ()
    repeated: int = 0
    rate: float | None = None  # samples per s, of the first ones

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


def list_recordings(file: MessageSource) -> list[Recording]:
    """Return the recordings of a log; files of other recorders are one."""
    found: dict[str, Recording] = {}
    for place, each in zip(file.begins, file.files, strict=False):
        values = each.metadata.get(METADATA, {})
        recording = Recording(place, values.get(f"parameter.{RATE}", ""), values.get("missed", ""))
        found.setdefault(values.get(BEGUN_ENTRY, ""), recording)
    return list(found.values())


class Grid:
    """The grid of stamps of a log."""

    def __init__(
        self, ordered: Ordered, recordings: Sequence[Recording], unknown: Sequence[Interval] = ()
    ) -> None:
        self._course = Course(ordered.events, ordered.places)
        self._periods = np.array([*_list_periods(ordered, recordings)])  # first before all events
        empty = [*_list_jumps(ordered.events), *unknown]
        self._empty = merge(empty)
        self._empty_of_tf = merge([*empty, *_list_times_without_tf(ordered.events)])

    def judge(self, name: str, rows: StampRows) -> GridFindings:
        """Return what is missing and repeated in a topic."""
        if not rows.rows:
            return GridFindings()
        stamps, places = rows.expand()
        # In time that went back, a stamp may be there once for each event that holds at it.
        repeated = rows.count_repeated(self._course.count_holding)
        if self._course.is_ordered:  # whatever the order of the chunks of a file is
            order = np.argsort(stamps, kind="stable")
            stamps, places = stamps[order], places[order]
        usual = _find_usual_period(rows)
        periods = self._find_periods(stamps, places, usual)
        gaps = self._find_gaps(name, stamps, places, periods)
        rate = float(NANOSECONDS / periods[0]) if periods[0] else None
        return GridFindings(tuple(gaps), repeated, rate)

    def _find_periods(self, stamps: Stamps, places: Places, usual: float) -> Real:
        """Return the period (ns) of the grid at each stamp."""
        owners = self._course.find_owners(stamps, places)
        periods = self._periods[owners + 1]
        if not self._course.is_ordered:  # the next event may have come late
            following = np.minimum(owners + 2, len(self._periods) - 1)
            periods = np.fmax(periods, self._periods[following])
        return np.where(np.isnan(periods), usual, periods)

    def _find_gaps(self, name: str, stamps: Stamps, places: Places, periods: Real) -> Iterator[Gap]:
        before, after = stamps[:-1], stamps[1:]
        period = np.maximum(periods[:-1], periods[1:])
        is_wide = (period > 0) & (after - before > WIDE * period)
        before, after, period, place = (e[is_wide] for e in (before, after, period, places[1:]))
        empty = self._empty_of_tf if name == TF else self._empty
        lost = after - before - measure_overlap(empty, before, after)
        missing = np.maximum(np.rint(lost / period) - 1, 0).astype(np.int64)
        some: Mask = missing > 0
        columns = (each[some].tolist() for each in (before, after, place, missing))
        return map(Gap, *columns)


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
    """Return the period in ns of a rate; nan if it is none."""
    try:
        rate = float(text)
    except ValueError:
        return float("nan")
    return NANOSECONDS / rate if MIN_RATE <= rate <= MAX_RATE else float("nan")


def _list_jumps(events: Sequence[Event]) -> Iterator[Interval]:
    """Yield the times in which a run has no samples: jumps, steps, and pauses of a recording."""
    for event in events:
        if event.name == "clock":
            yield event.previous_end, event.stamp
        to = event.request.get("to", "")
        if event.name == "step" and WHOLE.fullmatch(to):
            yield event.stamp, min(int(to), MAX_STAMP)
    for before, after in pairwise(event for event in events if event.name == "record"):
        if after.values.get("outcome.kind") == "begun":
            yield before.stamp, after.stamp


def _list_times_without_tf(events: Sequence[Event]) -> Iterator[Interval]:
    """Yield the times in which /tf was switched off: only a log of the node has its samples."""
    changes = [event for event in events if TF_SWITCH in event.request]
    for before, after in pairwise([*changes, None]):
        if before and before.request[TF_SWITCH] == "false":
            yield before.stamp, after.stamp if after else MAX_STAMP


def merge(intervals: Sequence[Interval]) -> Stamps:
    """Return disjoint intervals (n, 2) in their order, that cover the same stamps."""
    merged: list[list[int]] = []
    for begin, end in sorted(intervals):
        if merged and begin <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], end)
        elif begin < end:
            merged.append([begin, end])
    return np.array(merged, dtype=np.int64).reshape(-1, 2)


def measure_overlap(intervals: Stamps, begins: Stamps, ends: Stamps) -> Stamps:
    """Return how much (ns) of each stretch between two stamps is in disjoint intervals."""
    lengths = np.concatenate(([0], np.cumsum(intervals[:, 1] - intervals[:, 0])))

    def measure_before(stamps: Stamps) -> Stamps:
        """Return how much of all time before some stamps is in the intervals."""
        place = np.searchsorted(intervals[:, 1], stamps)  # of the first that ends later
        inside = np.zeros_like(stamps)
        is_open = place < len(intervals)
        inside[is_open] = np.maximum(stamps[is_open] - intervals[place[is_open], 0], 0)
        return np.asarray(lengths[place] + inside)

    return measure_before(ends) - measure_before(begins)
