"""Stamps of a topic in a whole log, in little memory: most are on a grid of equal steps."""

import itertools
from bisect import bisect_left
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from symtop_ros.base.arrays import Places, Stamps

ROUNDING = 1  # ns by which steps of one grid differ: stamps are rounded


class Row(NamedTuple):
    """Consecutive messages with equal steps, and no event between them."""

    first: int  # stamp in ns
    last: int
    first_place: int  # in the log
    last_place: int
    samples: int


@dataclass
class StampRows:
    """The stamps of a topic in the order of the log."""

    rows: list[Row] = field(default_factory=list)
    count: int = 0
    _events: int = 0  # number of events before the last sample

    def add(self, stamps: Stamps, places: Places, events: Places) -> None:
        """Add stamps (n,) in ns, with their places (n,) and the numbers of events before them."""
        is_open = self._events == int(events[0])
        self._events = int(events[-1])
        begins = [0, *self._find_cuts(stamps, events), len(stamps)]
        self.count += len(stamps)
        for begin, end in itertools.pairwise(begins):
            ends = [begin, end - 1]
            (first, last), (at, until) = stamps[ends].tolist(), places[ends].tolist()
            row = Row(first, last, at, until, end - begin)
            if begin == 0 and self.rows and is_open and self._continues(stamps, end):
                row = _join(self.rows.pop(), row)
            self.rows.append(row)

    def _continues(self, stamps: Stamps, end: int) -> bool:
        """Return True if stamps up to a place have the steps of the last row."""
        last = self.rows[-1]
        step = int(stamps[0]) - last.last
        own = (last.last - last.first) / (last.samples - 1) if last.samples > 1 else float(step)
        following = int(stamps[1] - stamps[0]) if end > 1 else step
        return step > 0 and abs(step - own) <= ROUNDING and abs(step - following) <= ROUNDING

    @staticmethod
    def _find_cuts(stamps: Stamps, events: Places) -> list[int]:
        """Return the places at which rows after the first begin: at other steps, and events."""
        steps = np.diff(stamps)
        differs = np.abs(np.diff(steps, prepend=steps[:1])) > ROUNDING
        must = (steps <= 0) | (np.diff(events) > 0)
        cuts: list[int] = []
        for place in (np.flatnonzero(differs | must) + 1).tolist():
            # The step after one that differs begins a grid, and differs from that one as well.
            if must[place - 1] or cuts[-1:] != [place - 1]:
                cuts.append(place)
        return cuts

    def expand(self) -> tuple[Stamps, Places]:
        """Return all stamps (n,), within the rounding of a grid, and their places (n,)."""
        rows = np.array(self.rows, dtype=np.int64).reshape(-1, 5)
        first, last, at, until, count = rows.T
        offsets = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        steps = np.maximum(count - 1, 1)

        def spread(begin: Stamps, end: Stamps) -> Stamps:
            """Return whole numbers at equal distances from the begin to the end of each row."""
            shares = np.rint(offsets * np.repeat((end - begin) / steps, count)).astype(np.int64)
            return np.asarray(np.repeat(begin, count) + shares)

        return spread(first, last), spread(at, until)

    def count_repeated(self, passes: Places) -> int:
        """Return how many samples have the stamp of another sample in the same pass (n,) of time.

        Two neighbours may be 1 ns apart. Within a row that is the rounding of a grid, by which one
        stamp may be in two rows.
        """
        stamps, _ = self.expand()
        counts = np.array([row.samples for row in self.rows], dtype=np.int64)
        is_end = np.zeros(len(stamps), dtype=np.bool_)
        is_end[np.cumsum(counts) - 1] = is_end[np.cumsum(counts) - counts] = True
        order = np.lexsort((stamps, passes))
        stamps, is_end, passes = stamps[order], is_end[order], passes[order]
        steps = np.diff(stamps)
        again = (steps == 0) | ((steps <= ROUNDING) & ~(is_end[1:] & is_end[:-1]))
        return int((again & (np.diff(passes) == 0)).sum())

    def find_stamp(self, since: int, place: int) -> int | None:
        """Return the stamp (ns) of the last sample between two places of the log; None if none is.

        If both ends of the interval are in one row, the stamp is computed from its grid.
        """
        for row in reversed(self.rows[: bisect_left(self.rows, place, key=_find_place)]):
            if row.last_place < place or row.samples == 1:
                return row.last if row.last_place > since else None
            share = (place - 1 - row.first_place) / (row.last_place - row.first_place)
            return row.first + int(share * (row.last - row.first))
        return None


def _find_place(row: Row) -> int:
    return row.first_place


def _join(before: Row, after: Row) -> Row:
    return before._replace(
        last=after.last, last_place=after.last_place, samples=before.samples + after.samples
    )
