"""Time and error of one integrator on one motion, by runs over its settings."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from statistics import median
from timeit import Timer
from typing import Literal

from workshop.speed.peers.peer import Peer
from workshop.speed.reference import ReferenceMotion

REPEATS = 5
SHORTEST = 0.05  # s for each median, long enough for a clock of microseconds
LONG = 0.2  # s; a run this long is steady enough by itself
PATIENCE = 2  # settings in a row without a smaller error: the error has passed its turning point
End = Literal["turning point", "time limit", "finest"]


@dataclass(frozen=True)
class Measurement:
    """Error and time at one setting."""

    setting: float  # tolerance, or step in s
    error: float  # largest error of the attitude on the way, in rad
    mean_error: float  # its mean, in rad
    compared: int  # number of times at which the attitude was compared
    seconds: float  # time to reach the end once, without output on the way: the median of some runs
    preparing: float  # seconds for building, loading and compiling the model; not part of `seconds`


@dataclass(frozen=True)
class Curve:
    """Speed against error of a peer for a motion of t seconds, setting by setting."""

    peer: str
    motion: str
    t: float
    points: tuple[Measurement, ...]
    # why the sweep ended: a finer setting has a larger error, or takes too long, or there is
    # none
    end: End

    @property
    def best(self) -> Measurement:
        """The point with the smallest error."""
        return min(self.points, key=lambda point: point.error)

    def find_cheapest(self, error: float) -> Measurement | None:
        """Return the fastest point with at most this error, or None."""
        good = [point for point in self.points if point.error <= error]
        return min(good, key=lambda point: point.seconds, default=None)


def sweep(
    settings: Sequence[float], measure: Callable[[float], Measurement | None], limit: float
) -> tuple[tuple[Measurement, ...], End]:
    """Measure setting by setting, up to the turning point of the error or a limit of time (s).

    A setting without a measurement, because the peer fails, is passed over.
    """
    points: list[Measurement] = []
    for setting in settings:
        if points and _expect(points, setting) > limit:
            return tuple(points), "time limit"
        point = measure(setting)
        points += [point] if point else []
        errors = [point.error for point in points]
        smallest = min(errors, default=1.0)
        if smallest < 1 and len(errors) - 1 - errors.index(smallest) >= PATIENCE:
            return tuple(points), "turning point"
    return tuple(points), "finest"


def sweep_motion(peer: Peer, motion: ReferenceMotion, t: float, limit: float) -> Curve:
    """Sweep over t seconds of a motion; states on the way come from a run that is not timed."""

    def measure(setting: float) -> Measurement:
        began = time.perf_counter()
        solution = peer.prepare(motion.task, setting)
        preparing = time.perf_counter() - began
        seconds = time_call(lambda: solution.reach(t))
        errors = motion.errors(*solution.record(t))
        largest, mean = float(errors.max()), float(errors.mean())
        return Measurement(setting, largest, mean, len(errors), seconds, preparing)

    return Curve(peer.name, motion.name, t, *sweep(peer.settings, measure, limit))


def _expect(points: list[Measurement], setting: float) -> float:
    """Return the seconds that the next setting is expected to take."""
    last = points[-1]
    growth = last.seconds / points[-2].seconds if len(points) > 1 else 1.0
    finer = last.setting / setting if setting else inf
    return last.seconds * max(1.0, min(growth, finer))


def time_call(call: Callable[[], object], enough: float = LONG) -> float:
    """Return the median seconds of several calls, or those of the first if it takes `enough` s."""
    timer = Timer(call)  # one for all calls: each compiles a loop, after which caches are cold
    first = timer.timeit(1)
    if first > enough:
        return first
    times: list[float] = []
    end = time.perf_counter() + SHORTEST
    while len(times) < REPEATS or time.perf_counter() < end:
        times.append(timer.timeit(1))
    return median(times)
