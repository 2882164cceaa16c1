"""The events of a whole run: which of them can hold at a stamp, and which samples are missing.

The node publishes its events in their order, but a recorder may log them after their first samples.
The stamps then decide. After a jump of the clock back they are repeated: several events can hold.

Samples are on a grid of stamps, which every event that changes it names. Two neighbours that are
further apart than a period have lost those between them: in the node, which counts them as missed,
or afterwards.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, pairwise

import numpy as np

from symtop_ros.arrays import Mask, Places, Real, Stamps
from symtop_ros.log.batch import TF
from symtop_ros.log.top_log import SeveralFiles, TopLog
from symtop_ros.log.writer import ENDING, METADATA
from symtop_ros.simulation.events import MAX_STAMP, WHOLE, Event
from symtop_ros.simulation.topics import DIAGNOSTICS
from symtop_ros.wire.diagnostics import decode_statuses
from symtop_ros.wire.layout import NANOSECONDS, DecodeError

MAX_CANDIDATES = 1000  # events that are tried for one sample; a log may be hostile
MAX_SEGMENTS = 100  # that are in memory
Interval = tuple[int, int]  # two stamps in ns
MIN_RATE, MAX_RATE = 1e-3, 1e6  # Hz; a log may be hostile
RATE, TF_SWITCH = "publish_rate", "publish_tf"


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
        follows, lasts = self._begins[1:] >= self._ends[:-1], self._begins <= self._ends
        self.is_ordered = bool(follows.all() and lasts.all())

    def list_missing(self) -> Iterator[str]:
        """Describe the events that are missing between others, with the stamps around them."""
        for place in np.flatnonzero(self.has_gap[:-1]).tolist():
            before, after = self._events[place : place + 2]
            missing = self._find_missing(before.number, after.number)
            first, last = missing[0], missing[-1]
            which = f"event {first} is" if first == last else f"events {first} to {last} are"
            yield (
                f"{which} missing, between {before.stamp} and {after.stamp} ns; samples that "
                "follow from what is missing are not judged"
            )

    def list_repeated(self, allowed: int) -> Iterator[str]:
        """Describe the events that are repeated.

        Each file of a run but the first may begin with the last event of the one before: `allowed`
        are the files that may.
        """
        keys = [(event.number, event.stamp) for event in self._events]
        allowed = min(allowed, sum(before == after for before, after in pairwise(keys)))
        if (repeated := len(keys) - len(set(keys)) - allowed) > 0:
            yield f"{repeated} events are repeated"

    def list_unknown(self) -> Iterator[tuple[int, int]]:
        """Yield the stretches of stamps (ns) in which events are missing."""
        for place in np.flatnonzero(self.has_gap).tolist():
            end = self._begins[place + 1] if place + 1 < len(self._begins) else MAX_STAMP
            yield int(self._begins[place]), int(end)

    def count_holding(self, stamps: Stamps) -> Places:
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

    def holds(self, number: int, stamps: Stamps, in_order: bool) -> Mask:
        """Return the mask of the stamps at which an event can hold.

        If it is not taken for granted that the events are in order, that is at any later stamp.
        """
        later = stamps >= self._begins[number]
        return np.asarray(later & (stamps < self._ends[number]) if in_order else later)

    def find_owners(self, stamps: Stamps, places: Places) -> Places:
        """Return the number of the event to which each sample belongs; -1: before all of them.

        `places` (n,) are the numbers of events before the samples in the log; they decide if the
        stamps do not.
        """
        if self.is_ordered:
            return np.searchsorted(self._begins, stamps, side="right") - 1
        return np.where(stamps < self._begins.min(initial=MAX_STAMP), -1, np.maximum(places - 1, 0))

    def candidates(self, stamps: Stamps, owners: Places, in_order: bool = True) -> Iterator[int]:
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


@dataclass
class Gaps:
    """The missing and the repeated messages of one topic."""

    missing: int = 0  # samples
    widest: Interval = (0, 0)  # the neighbours between which most are missing
    repeated: int = 0  # samples whose stamp is not later than the one before
    last: int | None = None  # stamp
    period: float = 0.0  # ns; of the first samples, for logs that do not say it


class Grid:
    """The grid of stamps of a run."""

    def __init__(self, log: TopLog, events: Sequence[Event]) -> None:
        self._course = course = Course(events, log.has_readable_events)
        rates = {event.stamp: event.request[RATE] for event in events if RATE in event.request}
        first = log.file.metadata.get(METADATA, {}).get(f"parameter.{RATE}", "")
        self._rate_stamps = np.array(sorted(rates), dtype=np.int64)
        texts = [first, *(rates[stamp] for stamp in sorted(rates))]
        self._periods = np.array([_read_period(text) for text in texts])
        self.gaps: dict[str, Gaps] = {}  # by the name of the topic
        empty = [*_list_jumps(events), *course.list_unknown()]
        self._empty = _merge(empty)
        self._empty_of_tf = _merge([*empty, *_list_times_without_tf(events)])

    def add(self, name: str, stamps: Stamps) -> None:
        """Count the gaps and repetitions of a topic in its next stamps."""
        gaps = self.gaps.setdefault(name, Gaps())
        known = stamps if gaps.last is None else np.concatenate(([gaps.last], stamps))
        before, after = known[:-1], known[1:]
        gaps.last = int(stamps[-1])
        steps = after - before
        # In time that went back, a stamp may be there once for each event that holds at it.
        gaps.repeated += int((self._course.count_holding(after[steps <= 0]) < 2).sum())
        if not gaps.period:
            gaps.period = float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
        self._find_gaps(gaps, name, before, after)

    def _find_gaps(self, gaps: Gaps, name: str, before: Stamps, after: Stamps) -> None:
        period = np.maximum(self._find_period(before, gaps), self._find_period(after, gaps))
        is_wide = (period > 0) & (after - before > 1.5 * period)
        before, after, period = before[is_wide], after[is_wide], period[is_wide]
        empty = self._empty_of_tf if name == TF else self._empty
        lost = after - before - _measure_overlap(empty, before, after)
        missing = np.maximum(np.rint(lost / period) - 1, 0).astype(np.int64)
        if missing.any():
            place = int(missing.argmax())
            found = int(before[place]), int(after[place])
            gaps.widest = max(gaps.widest, found, key=lambda each: each[1] - each[0])
            gaps.missing += int(missing.sum())

    def _find_period(self, stamps: Stamps, gaps: Gaps) -> Real:
        periods = self._periods[np.searchsorted(self._rate_stamps, stamps, side="right")]
        return np.where(np.isnan(periods), gaps.period, periods)


def count_missed(log: TopLog, events: Sequence[Event]) -> int:
    """Return the samples that the node itself has counted as missed during a log."""
    files = log.file.sources if isinstance(log.file, SeveralFiles) else [log.file]
    counts = [*_read_counts(log), *(each.metadata.get(ENDING, {}) for each in files)]
    missed = [int(each["missed"]) for each in counts if WHOLE.fullmatch(each.get("missed", ""))]
    begins_later = bool(missed and events and events[0].number > 1)
    before = log.file.metadata.get(METADATA, {}).get("missed", "")
    at_begin = int(before) if WHOLE.fullmatch(before) else missed[0] if begins_later else 0
    return max(missed, default=0) - at_begin


def _read_counts(log: TopLog) -> Iterator[Mapping[str, str]]:
    """Yield the values of each status of the node's pace."""
    node = log.node or ""
    own, name = DIAGNOSTICS.resolve(node), f"{node.lstrip('/')}: pace"
    for message in chain.from_iterable(log.file.chunks()):
        channel = log.file.channels.get(message.channel_id)
        if channel and channel.topic == own:
            with suppress(DecodeError):  # found by the check of texts
                statuses = decode_statuses(message.data)
                yield from (each.values for each in statuses if each.name == name)


def describe_gaps(found: Mapping[str, Gaps], counted: int) -> list[str]:
    """Describe what is missing, beyond what the node has counted, and what is repeated.

    Topics of which the same is to be said share a line.
    """
    lines: dict[str, list[str]] = {}
    for name, gaps in found.items():
        if gaps.missing > counted:
            text = (
                f"{gaps.missing} samples are missing, most of them between {gaps.widest[0]} and "
                f"{gaps.widest[1]} ns; the node has counted {counted} as missed"
            )
            lines.setdefault(text, []).append(name)
        if gaps.repeated:
            text = f"{gaps.repeated} samples are repeated: their stamps are not later than before"
            lines.setdefault(text, []).append(name)
    return [f"{', '.join(names)}: {text}" for text, names in lines.items()]


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


def _merge(intervals: Sequence[Interval]) -> Stamps:
    """Return disjoint intervals (n, 2) in their order, that cover the same stamps."""
    merged: list[list[int]] = []
    for begin, end in sorted(intervals):
        if merged and begin <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], end)
        elif begin < end:
            merged.append([begin, end])
    return np.array(merged, dtype=np.int64).reshape(-1, 2)


def _measure_overlap(intervals: Stamps, begins: Stamps, ends: Stamps) -> Stamps:
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
