"""The compute budget: how much work a motion needs, and how fast it can be followed."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

from symtop_ros.simulation.segment import Segment

STEPS_AT_ONCE = (
    15  # integration steps in one call, about 1 ms: requests wait no longer for the lock
)
FREE_WORK = 0.02  # s of work that is allowed for any stretch
SHARE = 0.25  # share of one core for a motion that cannot be followed in real time


class Shortfall(NamedTuple):
    """A motion that cannot be followed."""

    reached: float  # time up to which it is integrated, s of the motion
    factor: float  # real-time factor that can be kept with the CPU time of `SHARE`


class ComputeBudget:
    """Prepares a motion stretch by stretch and measures the time which that takes.

    Only integrated motions (friction, applied torque) need work; closed forms are always ready.
    """

    def __init__(self, stamp: int, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self.spent = 0.0  # work so far in s
        self.shortfall: Shortfall | None = None  # set if the last stretch took longer than it lasts
        self._prepared = stamp  # ns: end of the last stretch
        self._stretch: tuple[Segment, int] | None = None

    def prepare(self, segment: Segment, stamp: int) -> bool:
        """Work for about 1 ms towards a stamp (ns); return True if its state is ready."""
        if not segment.motion.is_driven:
            self._prepared, self._stretch = stamp, None
            return True
        end = segment.time_at(stamp)
        if self._stretch != (segment, stamp):
            self._stretch, self.shortfall = (segment, stamp), None
            self._progress, self._spent_before = 0.0, self.spent
        # The progress is counted call by call: a state that was asked for in between may have moved
        # the integration back to an earlier point.
        begin, before = segment.motion.reach(end, 0), self._clock()
        reached = segment.motion.reach(end, STEPS_AT_ONCE)
        self.spent += self._clock() - before
        self._progress += reached - begin
        work = self.spent - self._spent_before
        if reached == end:
            self._prepared, self._stretch = stamp, None
        elif work > max(FREE_WORK, (stamp - self._prepared) * 1e-9):
            self.shortfall = Shortfall(reached, SHARE * self._progress / work)
        return bool(reached == end)
