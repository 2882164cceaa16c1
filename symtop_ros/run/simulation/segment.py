"""A stretch of a run between two changes: a motion, and the relation of its time to the stamps.

Stamps are integer nanoseconds of the simulation's clock, and times of the motion are exact: sums of
products of integers and doubles. So the state at a stamp is defined to the last bit, after any
number of pauses, steps and changes of the real-time factor. An event contains everything that its
segment holds, so that any state of a run can be computed again from the events, bit for bit.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from symtop_ros.base.refusals import require
from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top
from symtop_ros.run.simulation.sensor.imu import Rig
from symtop_ros.run.wire.layout import NANOSECONDS

START = Fraction(0)
NO_RIG = Rig()
BEYOND = 2.0**64  # ns, more than two stamps differ by


@dataclass(frozen=True)
class Segment:
    """One stretch of a run. Methods return the segment that follows."""

    motion: Motion  # the motion from its own start
    stamp: int  # first stamp of the segment in ns
    elapsed: Fraction  # time of the motion at that stamp in ns, exact
    factor: float  # real-time factor: seconds of the motion per second of the clock
    running: bool  # False while paused
    rig: Rig = NO_RIG  # gravity and the sensor on the top

    def __post_init__(self) -> None:
        """Refuse a motion with a tolerance: events contain none."""
        require(not self.motion.tolerance, "tolerance", "0 in a run", self.motion.tolerance)

    @classmethod
    def begin(cls, motion: Motion, stamp: int, factor: float, rig: Rig = NO_RIG) -> "Segment":
        """Return the first segment of a motion that starts at a stamp."""
        return cls(motion, stamp, START, factor, running=True, rig=rig)

    @property
    def begin_time(self) -> float:
        """Time of the motion (s) at the first stamp."""
        # Python's quotient of integers is the nearest double.
        return self.elapsed.numerator / (self.elapsed.denominator * NANOSECONDS)

    def times_at(self, stamp: Any) -> Any:
        """Return the exact times of the motion at a stamp (ns) or an array of stamps.

        While paused there is one time for all stamps.
        """
        return ExactTimes(stamp - self.stamp if self.running else 0, self.factor, self.elapsed)

    def elapsed_at(self, stamp: int) -> Fraction:
        """Return the exact time of the motion in ns at a stamp (ns)."""
        offset = stamp - self.stamp if self.running else 0
        return self.elapsed + Fraction(self.factor) * offset

    def stamp_at(self, time: float) -> int:
        """Return the last stamp (ns) up to a time of the motion (s), for the factor 1."""
        return self.stamp + math.floor(to_nanoseconds(time) - self.elapsed)

    @cached_property
    def last_stamp(self) -> float:
        """The last stamp (ns) with a state; beyond all stamps if there is no last one."""
        if not self.running:
            return math.inf
        # 2^-40 earlier than the last state: that covers the rounding of these doubles, and of the
        # kernel's own comparison.
        left = self.motion.farthest_time * (1 - 2**-40) - self.begin_time
        stamps = left / self.factor * NANOSECONDS
        return self.stamp + math.floor(max(-BEYOND, min(stamps, BEYOND)))

    def time_at(self, stamp: Any) -> Any:
        """Return the time of the motion (s) at a stamp (ns) or an array of stamps, rounded."""
        return self.times_at(stamp).seconds

    def state_at(self, stamp: Any) -> State:
        """Return the state at a stamp (ns) or an array of them; one state if paused."""
        # The first state comes right after an act, when it is waited for: it needs no exact time.
        is_start = isinstance(stamp, int) and stamp == self.stamp and not self.elapsed
        return self.motion.at(0.0 if is_start else self.times_at(stamp))

    def count_pushes(self, stamp: int) -> int | None:
        """Return how many pushes the motion got up to a stamp (ns); None if nothing pushes it."""
        return self.motion.piece_at(self.times_at(stamp)).number if self.motion.pushes else None

    @property
    def final_motion(self) -> Motion:
        """The motion that its pushes lead to; a driven motion itself, which would take work."""
        pushes = self.motion.pushes
        if not pushes or self.motion.is_driven:
            return self.motion
        return self.motion.piece_at(ExactTimes(pushes.last_time)).motion

    def without_pushes(self, stamp: int) -> "Segment":
        """Return the segment of what moves at a stamp (ns), from the last push on."""
        if not self.motion.pushes:
            return self
        piece = self.motion.piece_at(self.times_at(stamp))
        return replace(self, motion=piece.motion, elapsed=self.elapsed - piece.begin)

    def change(
        self,
        stamp: int,
        start: State,
        top: Top | None = None,
        friction: Friction | None = None,
        torque: Sequence[float] | None = None,
        clamped: bool | None = None,
    ) -> "Segment":
        """Continue from a state at a stamp, with another top, friction, torque or clamp."""
        motion = Motion(
            self.motion.top if top is None else top,
            start,
            self.motion.friction if friction is None else friction,
            self.motion.applied_torque if torque is None else torque,
            clamped=self.motion.clamped if clamped is None else clamped,
        )
        return self.replace_motion(motion, stamp)

    def replace_motion(self, motion: Motion, stamp: int) -> "Segment":
        """Continue with another motion from its start."""
        return Segment(motion, stamp, START, self.factor, self.running, self.rig)

    def pause(self, stamp: int) -> "Segment":
        """Stop the motion at its state at a stamp."""
        return replace(self, stamp=stamp, elapsed=self.elapsed_at(stamp), running=False)

    def resume(self, stamp: int) -> "Segment":
        """Continue a paused motion from where it stopped."""
        return replace(self, stamp=stamp, running=True)

    def step(self, duration: float, stamp: int) -> "Segment":
        """Advance a paused motion by `duration` (s of the motion)."""
        return replace(self, stamp=stamp, elapsed=self.elapsed_at(stamp) + to_nanoseconds(duration))

    def move(self, stamp: int, to: int) -> "Segment":
        """Continue the state of one stamp at the stamp `to`: the clock jumped."""
        return replace(self, stamp=to, elapsed=self.elapsed_at(stamp))

    def set_factor(self, factor: float, stamp: int) -> "Segment":
        """Continue at another real-time factor."""
        return replace(self, stamp=stamp, elapsed=self.elapsed_at(stamp), factor=factor)

    def slow_down(self, reached: float, factor: float, stamp: int) -> "Segment":
        """Continue at another factor, from the time (s) that the integration has reached."""
        elapsed = min(to_nanoseconds(reached), self.elapsed_at(stamp))
        return replace(self, stamp=stamp, elapsed=elapsed, factor=factor)


def to_nanoseconds(seconds: float) -> Fraction:
    """Return the exact value of a double in s as a number of ns."""
    return Fraction(seconds) * NANOSECONDS
