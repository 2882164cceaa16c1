"""A motion that is pushed again and again: equal impulses on the axle, and exact motion between."""

import math
from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics import ExactTimes, Motion, State, Top, push_axle
from symtop_ros.simulation.validation import number, reject
from symtop_ros.wire.layout import NANOSECONDS

# A run waits while they are computed, for up to 0.1 s.
MOST = 1000  # pushes of one request
RATES = (0.01, 1000.0)  # per s
LARGEST = 1e30  # N m s


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
            piece = Motion(self.top, push_axle(self.top, state, self.pushes.impulse))
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
        pushes = self.pushes._replace(number=self.count(elapsed))
        return PushedMotion(self.top, self.start, pushes)

    def piece_at(self, elapsed: Fraction) -> tuple[Motion, int]:
        """Return the piece at a time in ns, and the time in ns at which it begins."""
        place = self.count(elapsed) - 1
        return self.pieces[place], self._begins[place]

    def _compute_one(self, time: float) -> State:
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
