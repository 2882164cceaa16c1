"""Cost and error of one peer on one motion, by runs over its settings."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

from symtop_ros.report.precision.peers.peer import Peer, Solve, Task
from symtop_ros.report.precision.reference import Problem

REPEATS = 5
LEAST = 0.05  # s for each figure, so that a clock of microseconds will do
LONG = 1.0  # s; a run as long as this is steady enough by itself


@dataclass(frozen=True)
class Point:
    """One setting.

    Attributes
    ----------
    setting : float
        Tolerance, or step in s.
    error : float
        Distance of the quaternion at the end from the right one.
    seconds : float
        For the whole motion, the median of some runs.
    preparing : float
        Seconds for building, loading and compiling the model; not in the other.
    """

    setting: float
    error: float
    seconds: float
    preparing: float


@dataclass(frozen=True)
class Curve:
    """What a peer does for a motion of t seconds, setting by setting."""

    peer: str
    motion: str
    t: float
    points: tuple[Point, ...]

    @property
    def best(self) -> Point:
        """The point with the smallest error."""
        return min(self.points, key=lambda point: point.error)

    def cheapest(self, error: float) -> Point | None:
        """Return the fastest point with at most this error, if there is one."""
        good = [point for point in self.points if point.error <= error]
        return min(good, key=lambda point: point.seconds, default=None)


def task_of(problem: Problem) -> Task:
    """Return what a peer is given."""
    return Task(problem.top, problem.start, problem.friction)


def sweep(peer: Peer, problem: Problem, t: float, budget: float) -> Curve:
    """Measure setting by setting, until a run takes longer than a budget in s."""
    points = []
    for setting in peer.settings:
        began = time.perf_counter()
        solve = peer.prepare(task_of(problem), setting)
        preparing = time.perf_counter() - began
        error, seconds = run(solve, problem, t, budget)
        points.append(Point(setting, error, seconds, preparing))
        if seconds > budget:
            break
    return Curve(peer.name, problem.name, t, tuple(points))


def run(solve: Solve, problem: Problem, t: float, budget: float) -> tuple[float, float]:
    """Return error and seconds of a motion to t; a long run is the only one."""
    began = time.perf_counter()
    error = problem.error(t, solve(t))
    first = time.perf_counter() - began
    return error, first if first > min(LONG, budget / REPEATS) else median(lambda: solve(t))


def median(call: Callable[[], object]) -> float:
    """Return the median seconds of some calls, of many where they are short."""
    times: list[float] = []
    end = time.perf_counter() + LEAST
    while len(times) < REPEATS or time.perf_counter() < end:
        began = time.perf_counter()
        call()
        times.append(time.perf_counter() - began)
    return statistics.median(times)
