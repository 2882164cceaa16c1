"""How much work the engine has with a motion, and how fast a motion it can keep up with."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

from symtop_ros.run.segment import Segment

STEPS = 50  # of the engine at a time: about a millisecond, in which nobody else has a turn
PATIENCE = 0.02  # s of work that any stretch may take
SHARE = 0.25  # of a core that the engine may take where it cannot keep up


class Shortfall(NamedTuple):
    """Where the engine has got to (s of motion), and seconds of motion per second it can do."""

    reached: float
    factor: float


class Effort:
    """Lets the engine prepare stretch after stretch, and keeps account of the time that takes.

    Parameters
    ----------
    stamp : int
        Where the first stretch begins, in ns.
    clock : callable
        Returns s.

    Attributes
    ----------
    spent : float
        s of work so far.
    shortfall : Shortfall or None
        Set where the last stretch has taken longer than it lasts.
    """

    def __init__(self, stamp: int, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self.spent = 0.0
        self.shortfall: Shortfall | None = None
        self._prepared = stamp  # ns: end of the last stretch
        self._stretch: tuple[Segment, int] | None = None

    def prepare(self, segment: Segment, stamp: int) -> bool:
        """Go on towards a stamp (ns) for a moment; return whether the engine is there."""
        end = segment.time_at(stamp)
        if self._stretch != (segment, stamp):
            self._stretch, self.shortfall = (segment, stamp), None
            self._begin, self._begun = segment.path.reach(end, 0), self.spent
        before = self._clock()
        reached = segment.path.reach(end, STEPS)
        self.spent += self._clock() - before
        work = self.spent - self._begun
        if reached == end:
            self._prepared, self._stretch = stamp, None
        elif work > max(PATIENCE, (stamp - self._prepared) * 1e-9):
            self.shortfall = Shortfall(reached, SHARE * (reached - self._begin) / work)
        return bool(reached == end)
