"""Budgets of work: only driven motions (friction, applied torque) need any, one step after another.

A `StepBudget` limits the steps that are taken for one request or one log. A `ComputeBudget` limits
the CPU time of a run, and says how fast the motion can be followed. The time on the wall is no
measure of work: on a busy machine the thread may get 10 % CPU (one core).
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from symtop_ros.base.arrays import Stamps
from symtop_ros.physics import Motion
from symtop_ros.run.simulation.segment import Segment

# Steps of the integration in one call, about 1 ms: requests wait no longer for the lock.
STEPS_AT_ONCE = 100
STEPS_OF_A_CHECK = 1500  # steps between two estimates of the steps that remain
# For a log, which may be hostile: it could ask for a motion that takes years to integrate.
FREE_STEPS = 1500  # for the samples of one event in a batch: about a tenth of a second
STEPS_PER_SAMPLE = 60  # a node may have taken as many for each sample
SPARE_STEPS = 3_000_000  # for what precedes the log
# A motion that slows down is followed in longer steps, so an estimate of the remaining work may be
# this many times too large.
OPTIMISM = 10.0
FREE_WORK = 0.02  # s of work that is allowed for any stretch
SHARE = 0.25  # share of one core for a motion that cannot be followed in real time
# A thread that gets too little of the processor falls further behind in each of some windows of
# real time. One long window may be a stop (SIGSTOP, a suspended machine) after which it catches up.
WINDOW, WINDOWS = 0.5, 3  # s


@dataclass
class StepBudget:
    """A number of spare steps, for all motions that are reached with it."""

    spare: int = 0

    def reach(self, motion: Motion, t: float, free: int) -> bool:
        """Integrate a motion to a time in s; return False if that takes too many steps.

        `free` steps are not counted. Work that would exceed the budget by far is not begun.
        """
        before = motion._reach(t, 0)
        while free + self.spare > 0:
            count = min(STEPS_OF_A_CHECK, free + self.spare)
            reached = motion._reach(t, count)
            if reached == t:
                return True
            self.spare -= max(0, count - max(0, free))
            free -= count
            left = max(0, free) + self.spare
            if abs(t - reached) * count > OPTIMISM * left * abs(reached - before):
                return False
            before = reached
        return before == t

    def reach_stamps(self, segment: Segment, stamps: Stamps) -> bool:
        """Integrate the motion of samples at stamps (ns) that a node has published."""
        free = FREE_STEPS + STEPS_PER_SAMPLE * len(stamps)
        ends = stamps.min(), stamps.max()
        if ends[1] > segment.last_stamp:
            return False
        return all(self.reach(segment.motion, segment.time_at(int(end)), free) for end in ends)


class Lack(NamedTuple):
    """CPU time that the thread of a motion gets and needs, in percent of one core."""

    got: float
    needed: float


class Shortfall(NamedTuple):
    """A motion that cannot be followed."""

    reached: float  # time up to which it is integrated, s of the motion
    factor: float  # real-time factor that can be kept
    lack: Lack | None = None  # if other programs have the processor; None: it is too fast


class Progress(NamedTuple):
    """The result of one call: how far a motion was integrated."""

    ready: bool  # the state that was asked for can be computed
    end: float | None = None  # s of the motion: its last time, if it has no further states
    shortfall: Shortfall | None = None  # if the stretch has taken longer than it lasts


READY = Progress(True)


class Pursuit:
    """Progress of a motion that is behind its clock, by windows of real time."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self.begin()

    def begin(self) -> None:
        """Begin with no window: the motion is where its clock is."""
        self._falling = 0  # windows in a row in which it fell further behind
        self._open()

    def _open(self) -> None:
        self._since = self._clock()
        self._moved = self._work = 0.0  # s of the motion, and of CPU time

    def note(self, moved: float, work: float, factor: float) -> tuple[float, Lack] | None:
        """Note the result of a call; return the factor to continue at if the thread lacks CPU time.

        `factor` is that of the motion, in seconds of it per second of real time.
        """
        self._moved += moved
        self._work += work
        passed = self._clock() - self._since
        if passed < WINDOW:
            return None
        pace, got = self._moved / passed, self._work / passed
        needed = got * factor / pace if pace > 0 else 0.0
        self._falling = self._falling + 1 if 0 < pace < factor else 0
        self._open()
        # Half of what was possible: the sender and its subscribers need the processor, too.
        return (pace / 2, Lack(100 * got, 100 * needed)) if self._falling >= WINDOWS else None


class ComputeBudget:
    """Prepares a motion stretch by stretch and measures the CPU time which that takes.

    `clock` is the CPU time of the thread that calls, and `real` the real time, both in s.
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.thread_time,
        real: Callable[[], float] = time.monotonic,
    ) -> None:
        self._clock = clock
        self._pursuit = Pursuit(real)
        self.spent = 0.0  # work so far in s of CPU time
        self._segment: Segment | None = None  # the last one
        self._prepared = 0  # ns: end of its last stretch
        self._stretch: tuple[Segment, int] | None = None
        self._progress, self._spent_before = 0.0, 0.0  # s of the motion and of work, of the stretch

    def prepare(
        self, segment: Segment, stamp: int, factor: float = 1.0, is_timed: bool = True
    ) -> Progress:
        """Work for about 1 ms towards the state at a stamp (ns).

        `factor` is the pace of the stamps: seconds of them per second of real time. `is_timed` is
        False if they do not follow the real time.
        """
        if not segment.motion.is_driven:
            if stamp <= segment.last_stamp:
                return READY
            return Progress(False, end=float(segment.time_at(int(segment.last_stamp))))
        if segment is not self._segment:
            self._segment = segment
            self._prepared = segment.stamp
        end = segment.time_at(stamp)
        if self._stretch != (segment, stamp):
            self._stretch = segment, stamp
            self._progress = 0.0
            self._spent_before = self.spent
            self._pursuit.begin()
        # The progress is counted call by call: a state that was asked for in between may have moved
        # the integration back to an earlier point.
        start = segment.motion._reach(end, 0)
        before = self._clock()
        reached = segment.motion._reach(end, STEPS_AT_ONCE)
        spent = self._clock() - before
        self.spent += spent
        self._progress += reached - start
        work = self.spent - self._spent_before
        if reached == end:
            self._prepared = stamp
            self._stretch = None
            return READY
        if reached == start:
            return Progress(False, end=reached)
        if work > max(FREE_WORK, (stamp - self._prepared) * 1e-9 / factor):
            return Progress(False, shortfall=Shortfall(reached, SHARE * self._progress / work))
        lacking = self._pursuit.note(reached - start, spent, factor * segment.factor)
        shortfall = Shortfall(reached, *lacking) if lacking and is_timed else None
        return Progress(False, shortfall=shortfall)
