"""A stretch of a run between two changes: a motion, and which of its times belongs to a stamp.

Stamps are integer nanoseconds of the simulation's clock, and times of the motion are exact: sums of
products of integers and doubles. So the state at a stamp is defined to the last bit, after any
number of pauses, steps and changes of the real-time factor. An event contains everything that its
segment holds, so that any state of a run can be computed again from the events, bit for bit.

A motion may be pushed again and again: by equal impulses on the axle, and exact motion between.
"""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top, push_axle
from symtop_ros.simulation.sensor.imu import Rig
from symtop_ros.simulation.validation import number, reject
from symtop_ros.wire.layout import NANOSECONDS

# A run waits while they are computed, for up to 0.1 s.
MOST = 1000  # pushes of one request
RATES = (0.01, 1000.0)  # per s
LARGEST = 1e30  # N m s
START = Fraction(0)
NO_RIG = Rig()


class Pushes(NamedTuple):
    """Horizontal pushes on the axle, each to the side to which phi grows at its instant."""

    impulse: float  # angular impulse of each in N m s
    rate: float  # pushes in a second of the motion
    number: int

    @classmethod
    def read(cls, impulse: object, rate: object, count: object) -> "Pushes":
        """Return the pushes with numbers that are asked for; RefusedError if no run has them."""
        whole = number("number", count, "", 1, MOST)
        if not whole.is_integer():
            raise reject("number", f"a whole number up to {MOST}", count)
        return cls(
            number("axle_impulse", impulse, "N m s", -LARGEST, LARGEST),
            number("rate", rate, "pushes per s of the motion", *RATES),
            int(whole),
        )

    @property
    def request(self) -> dict[str, float]:
        """The fields of ~/kick that ask for them."""
        return {"axle_impulse": self.impulse, "rate": self.rate, "number": self.number}

    def time(self, place: int) -> int:
        """Return the time of a push in ns since the first one; `push.js` rounds in the same way."""
        return math.floor(place * 1e9 / self.rate + 0.5)


class PushedMotion(Motion):
    """A motion under gravity alone, from the state after the first of its pushes.

    Its kind, its turning angles and its rates are those of the piece before the second push.
    """

    def __new__(cls, top: Top, start: State, pushes: Pushes) -> "PushedMotion":
        """Return the motion, of which there are no arrays."""
        return object.__new__(cls)

    def __init__(self, top: Top, start: State, pushes: Pushes) -> None:
        super().__init__(top, start)
        self.pushes = pushes
        self._begins = [pushes.time(place) for place in range(pushes.number)]  # ns
        self.pieces = list(self._follow())

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle a motion by its arguments."""
        return PushedMotion, (self.top, self.start, self.pushes)

    def _follow(self) -> Iterator[Motion]:
        piece = Motion(self.top, self.start)
        yield piece
        for place in range(1, self.pushes.number):
            state = piece.at(ExactTimes(self._begins[place] - self._begins[place - 1]))
            piece = piece.restart(push_axle(self.top, state, self.pushes.impulse))
            yield piece

    @cached_property
    def farthest_time(self) -> float:
        """Time in s from which on states are refused."""
        return self._begins[-1] / NANOSECONDS + self.pieces[-1].farthest_time

    def count(self, elapsed: Fraction | int) -> int:
        """Return the number of pushes up to a time in ns."""
        return max(1, bisect_right(self._begins, elapsed))

    def cut(self, elapsed: int) -> "PushedMotion":
        """Return the motion whose pushes end at a time in ns."""
        return PushedMotion(self.top, self.start, self.pushes._replace(number=self.count(elapsed)))

    def piece_at(self, elapsed: Fraction) -> tuple[Motion, int]:
        """Return the piece at a time in ns, and the time in ns at which it begins."""
        place = self.count(elapsed) - 1
        return self.pieces[place], self._begins[place]

    def _compute_one(self, time: float | ExactTimes) -> State:
        if isinstance(time, ExactTimes):
            piece, begin = self.piece_at(time.advance(int(time.nanoseconds)))
            return piece.at(replace(time, elapsed=time.elapsed - begin))
        piece, begin = self.piece_at(Fraction(time) * NANOSECONDS)
        return piece.at(time - begin / NANOSECONDS)

    def fill(self, times: Real | ExactTimes, orientation: Real, angular_velocity: Real) -> None:
        """Write the states at many times into arrays, as of any motion."""
        times = times.ravel()
        places = self._find_places(times)
        for place in np.unique(places).tolist():
            chosen, begin = places == place, self._begins[place]
            part = times[chosen]
            if isinstance(part, ExactTimes):
                part = ExactTimes(part.nanoseconds, part.factor, part.elapsed - begin)
            else:
                part = part - begin / NANOSECONDS
            states = self.pieces[place].at(part)
            orientation[chosen] = states.orientation
            angular_velocity[chosen] = states.angular_velocity

    def _find_places(self, times: Real | ExactTimes) -> NDArray[np.intp]:
        """Return the place of the piece of each time."""
        if isinstance(times, ExactTimes):
            # The first stamp at which the clock has reached each push.
            factor = Fraction(times.factor)
            firsts = [math.ceil((begin - times.elapsed) / factor) for begin in self._begins]
            stamps = np.asarray(times.nanoseconds).tolist()
            found = [bisect_right(firsts, stamp) - 1 for stamp in stamps]
        else:
            found = [self.count(Fraction(time) * NANOSECONDS) - 1 for time in times.tolist()]
        return np.maximum(np.array(found, dtype=np.intp), 0)


@dataclass(frozen=True)
class Segment:
    """One stretch of a run. Methods return the segment that follows."""

    motion: Motion  # the motion from its own start
    stamp: int  # first stamp of the segment in ns
    elapsed: Fraction  # time of the motion at that stamp in ns, exact
    factor: float  # real-time factor: seconds of the motion per second of the clock
    running: bool  # False while paused
    rig: Rig = NO_RIG  # gravity and the sensor on the top

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
        """The last stamp (ns) with a state; infinite if there is none."""
        farthest = self.motion.farthest_time
        if not self.running or math.isinf(farthest):
            return math.inf
        # within the rounding of the kernel's own comparison
        left = to_nanoseconds(farthest * (1 - 2**-40)) - self.elapsed
        return self.stamp + math.floor(left / Fraction(self.factor))

    def time_at(self, stamp: Any) -> Any:
        """Return the time of the motion (s) at a stamp (ns) or an array of stamps, rounded."""
        return self.times_at(stamp).seconds

    def state_at(self, stamp: Any) -> State:
        """Return the state at a stamp (ns) or an array of them; one state if paused."""
        return self.motion.at(self.times_at(stamp))

    def count_pushes(self, stamp: int) -> int | None:
        """Return how many pushes the motion got up to a stamp (ns); None if nothing pushes it."""
        return (
            self.motion.count(self.elapsed_at(stamp))
            if isinstance(self.motion, PushedMotion)
            else None
        )

    @property
    def final_motion(self) -> Motion:
        """The motion that its pushes lead to; without pushes the motion itself."""
        return self.motion.pieces[-1] if isinstance(self.motion, PushedMotion) else self.motion

    def without_pushes(self, stamp: int) -> "Segment":
        """Return the segment of what moves at a stamp (ns), from the last push on."""
        if not isinstance(self.motion, PushedMotion):
            return self
        piece, begin = self.motion.piece_at(self.elapsed_at(stamp))
        return replace(self, motion=piece, elapsed=self.elapsed - begin)

    def change(
        self,
        stamp: int,
        start: State,
        top: Top | None = None,
        friction: Friction | None = None,
        torque: Sequence[float] | None = None,
    ) -> "Segment":
        """Continue from a state at a stamp, with another top, friction or applied torque."""
        motion = Motion(
            self.motion.top if top is None else top,
            start,
            self.motion.friction if friction is None else friction,
            self.motion.applied_torque if torque is None else torque,
        )
        return self.replace_motion(motion, stamp)

    def replace_motion(self, motion: Motion, stamp: int) -> "Segment":
        """Continue with another motion from its start."""
        return replace(self, motion=motion, stamp=stamp, elapsed=START)

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
