"""Time and error of one integrator on one motion, by runs over its settings."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from symtop_ros.report.peers.peer import Peer, Solution
from symtop_ros.report.reference import Problem

REPEATS = 5
SHORTEST = 0.05  # s for each median, long enough for a clock of microseconds
LONG = 0.2  # s; a run this long is steady enough by itself
PATIENCE = 2  # settings in a row without a smaller error: the error has passed its turning point
End = Literal["turning point", "time limit", "finest"]


@dataclass(frozen=True)
class Point:
    """One setting."""

    setting: float  # tolerance, or step in s
    error: float  # largest and mean error of the attitude on the way, in rad
    mean_error: float  # largest and mean error of the attitude on the way, in rad
    compared: int  # number of times at which the attitude was compared
    seconds: float  # time to reach the end once, without output on the way: the median of some runs
    preparing: float  # seconds for building, loading and compiling the model; not part of `seconds`


@dataclass(frozen=True)
class Curve:
    """Speed against error of a peer for a motion of t seconds, setting by setting."""

    peer: str
    motion: str
    t: float
    points: tuple[Point, ...]
    # why the sweep ended: a finer setting has a larger error, or takes too long, or there is
    # none
    end: End

    @property
    def best(self) -> Point:
        """The point with the smallest error."""
        return min(self.points, key=lambda point: point.error)

    def find_cheapest(self, error: float) -> Point | None:
        """Return the fastest point with at most this error, or None."""
        good = [point for point in self.points if point.error <= error]
        return min(good, key=lambda point: point.seconds, default=None)


def sweep(peer: Peer, problem: Problem, t: float, limit: float) -> Curve:
    """Measure setting by setting, up to the turning point of the error or a limit of time."""
    points: list[Point] = []
    end: End = "finest"
    for setting in peer.settings:
        points.append(_measure(peer, problem, t, setting))
        errors = [point.error for point in points]
        if len(errors) - 1 - errors.index(min(errors)) >= PATIENCE and min(errors) < 1:
            end = "turning point"
            break
        following = peer.settings[len(points) : len(points) + 1]
        if following and _expect(points, following[0]) > limit:
            end = "time limit"
            break
    return Curve(peer.name, problem.name, t, tuple(points), end)


def _expect(points: list[Point], following: float) -> float:
    """Return the seconds that the next setting is expected to take."""
    last = points[-1]
    growth = last.seconds / points[-2].seconds if len(points) > 1 else 1.0
    return last.seconds * max(1.0, min(growth, last.setting / following))


def _measure(peer: Peer, problem: Problem, t: float, setting: float) -> Point:
    began = time.perf_counter()
    solution = peer.prepare(problem.task, setting)
    preparing = time.perf_counter() - began
    seconds = time_reaching(solution, t)
    errors = problem.errors(*solution.record(t))
    return Point(
        setting, float(errors.max()), float(errors.mean()), len(errors), seconds, preparing
    )


def time_reaching(solution: Solution, t: float) -> float:
    """Return the seconds to reach t (s) once; a long run is not repeated."""
    began = time.perf_counter()
    solution.reach(t)
    first = time.perf_counter() - began
    return first if first > LONG else time_median(lambda: solution.reach(t))


def time_median(call: Callable[[], object]) -> float:
    """Return the median seconds of several calls, of many if they are short."""
    times: list[float] = []
    end = time.perf_counter() + SHORTEST
    while len(times) < REPEATS or time.perf_counter() < end:
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return statistics.median(times)
