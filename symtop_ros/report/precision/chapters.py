"""What the report measures, chapter by chapter, as plain data."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import motion
from symtop_ros.report.precision.measure import Curve, median, run, sweep, task_of
from symtop_ros.report.precision.peers.own import CLOSED_FORM, SPLITTING
from symtop_ros.report.precision.peers.peer import Peer, Task
from symtop_ros.report.precision.reference import EPS, Problem, Reference

Real = NDArray[np.float64]
SPAN = 10.0  # s
CHECK = 0.1  # s after which a peer's model must be right at its finest setting
RIGHT = 1e-3  # distance that is right then: a weight or moment one percent off makes 6e-3
SLACK = 4, 8 * EPS  # times the limit, and beyond it, that our own errors may be
DRIVEN = 1e-11  # distance that the splitting may be off after ten seconds
FASTEST = 1e5  # rad of turning that a peer is asked for in a hard case
HARD_PEERS = ("SciPy DOP853, quaternion", "heyoka")


@dataclass(frozen=True)
class Form:
    """How much is measured.

    Attributes
    ----------
    motions : int
        Of the article's seven, the first ones.
    budget : float
        Seconds that one run of a peer may take.
    growth_budget : float
        The same where the error's growth with time is measured.
    states : tuple of int
        Numbers of states in an array.
    hard_peers : tuple of str
        What the hard cases are tried with beside the closed form.
    """

    motions: int
    budget: float
    growth_budget: float
    states: tuple[int, ...]
    hard_peers: tuple[str, ...]


QUICK = Form(1, 0.5, 1.0, tuple(10**k for k in range(7)), HARD_PEERS[1:])
FULL = Form(7, 1.0, 60.0, tuple(10**k for k in range(8)), HARD_PEERS)
SMALL = Form(1, 0.01, 0.02, (1, 10), ())


@dataclass(frozen=True)
class Growth:
    """Error and seconds of a peer at its best setting as a motion goes on."""

    peer: str
    setting: float
    times: tuple[float, ...]
    errors: tuple[float, ...]
    seconds: tuple[float, ...]


@dataclass(frozen=True)
class States:
    """Seconds for an array of states over ten seconds, set-up included, by their number."""

    peer: str
    numbers: tuple[int, ...]
    seconds: tuple[float, ...]
    error: float  # at the end, with the smallest number


@dataclass(frozen=True)
class HardCase:
    """Errors in a hard case: ours, and those of peers."""

    family: str
    small: float
    limit: float
    error: float
    peers: dict[str, float]

    @property
    def met(self) -> bool:
        """Whether our error is within what is allowed."""
        return allowed(self.limit, self.error)


@dataclass
class Results:
    """All that was measured."""

    checks: dict[str, float] = field(default_factory=dict)  # error of a model at its finest
    curves: list[Curve] = field(default_factory=list)
    growth: list[Growth] = field(default_factory=list)
    states: list[States] = field(default_factory=list)
    hard: list[HardCase] = field(default_factory=list)

    @property
    def failures(self) -> list[str]:
        """Where our own errors are larger than allowed, or a peer's model is another one."""
        wrong = [f"{name}: another model" for name, off in self.checks.items() if off > RIGHT]
        missed = [f"{case.family}, {case.small:g}" for case in self.hard if not case.met]
        return wrong + missed + self._own_failures

    @property
    def _own_failures(self) -> list[str]:
        problems = {problem.name: problem for problem in Reference.read().article}
        points = [(c.motion, c.t, c.best.error) for c in self.curves if c.peer == CLOSED_FORM]
        for each in self.growth:
            if each.peer == CLOSED_FORM:
                name = next(iter(problems))
                points += [(name, t, e) for t, e in zip(each.times, each.errors, strict=True)]
                points += [(name, t, inf) for t in problems[name].times if t > max(each.times)]
        missed = [
            f"{name} at {t:g} s: {error:.1e}"
            for name, t, error in points
            if not allowed(problems[name].limit(t), error)
        ]
        driven = [c.best.error for c in self.curves if c.peer == SPLITTING]
        return missed + [f"{SPLITTING}: {error:.1e}" for error in driven if error > DRIVEN]


def allowed(limit: float, error: float) -> bool:
    """Whether one of our errors is within four limits and eight eps."""
    return error <= SLACK[0] * limit + SLACK[1]


Step = tuple[str, Callable[[], None]]  # what a progress bar says, and what is done


def steps(form: Form, peers: Sequence[Peer], results: Results) -> Iterator[Step]:
    """Yield what is to be done, one after the other; results are filled as they are done."""
    reference = Reference.read()
    first = reference.article[0]
    free = [peer for peer in peers if peer.friction != "only"]
    for peer in free:
        yield f"{peer.name}: model", partial(_check, peer, first, results)
    for problem in reference.article[: form.motions]:
        for peer in free:
            yield f"{peer.name}: {problem.name}", partial(_sweep, peer, problem, form, results)
    rubbing = reference.article[-1]
    for peer in peers:
        if peer.friction != "no":
            yield f"{peer.name}: {rubbing.name}", partial(_sweep, peer, rubbing, form, results)
    for peer in free:
        yield f"{peer.name}: long times", partial(_grow, peer, first, form, results)
    for name, arrays in dense(peers):
        yield f"{name}: arrays", partial(_count, name, arrays, first, form, results)
    tried = [peer for peer in peers if peer.name in form.hard_peers]
    for problem in reference.hard:
        yield problem.name, partial(_try, problem, tried, results)


def _check(peer: Peer, problem: Problem, results: Results) -> None:
    solve = peer.prepare(task_of(problem), peer.settings[-1])
    results.checks[peer.name] = problem.error(CHECK, solve(CHECK))


def _sweep(peer: Peer, problem: Problem, form: Form, results: Results) -> None:
    results.curves.append(sweep(peer, problem, SPAN, form.budget))


def _grow(peer: Peer, problem: Problem, form: Form, results: Results) -> None:
    """Ten times as long each time, while there is time for it."""
    curve = next(c for c in results.curves if (c.peer, c.motion) == (peer.name, problem.name))
    solve = peer.prepare(task_of(problem), curve.best.setting)
    times, errors, seconds = [], [], []
    for t in (t for t in problem.times if t >= SPAN):
        try:
            error, taken = run(solve, problem, t, form.growth_budget)
        except Exception:  # a peer has gone as far as it can, each with an error of its own
            break
        times.append(t)
        errors.append(error)
        seconds.append(taken)
        if 10 * taken > form.growth_budget:
            break
    found = (tuple(each) for each in (times, errors, seconds))
    results.growth.append(Growth(peer.name, curve.best.setting, *found))


Arrays = Callable[[Task], Callable[[Real], Real]]  # times (n,) -> orientations (n, 4)


def dense(peers: Sequence[Peer]) -> Iterator[tuple[str, Arrays]]:
    """Yield what computes arrays of states: ours, SciPy's best and heyoka's grid."""
    yield CLOSED_FORM, _own_array
    names = {peer.name for peer in peers}
    if HARD_PEERS[0] in names:
        from symtop_ros.report.precision.peers.scipy_peer import prepare_grid as scipy_grid

        yield HARD_PEERS[0], scipy_grid
    if HARD_PEERS[1] in names:
        from symtop_ros.report.precision.peers.heyoka_peer import prepare_grid as heyoka_grid

        yield HARD_PEERS[1], heyoka_grid


def _own_array(task: Task) -> Callable[[Real], Real]:
    return lambda times: motion(task.top, task.start, task.friction).at(times).orientation


def _count(name: str, arrays: Arrays, problem: Problem, form: Form, results: Results) -> None:
    compute, seconds = arrays(task_of(problem)), []
    error = problem.error(SPAN, compute(np.array([SPAN]))[-1])
    for number in form.states:
        times = np.linspace(0.0, SPAN, number + 1)[1:]
        seconds.append(_median_of_arrays(compute, times, form.budget))
    results.states.append(States(name, form.states, tuple(seconds), error))


def _median_of_arrays(compute: Callable[[Real], Real], times: Real, budget: float) -> float:
    began = time.perf_counter()
    compute(times)
    first = time.perf_counter() - began
    return first if first > budget else median(lambda: compute(times))


def _try(problem: Problem, peers: Sequence[Peer], results: Results) -> None:
    (t,) = problem.times
    state = motion(problem.top, problem.start).at(t)
    found: dict[str, Any] = {}
    for peer in peers:
        if np.linalg.norm(problem.start.angular_velocity) * t < FASTEST:
            solve = peer.prepare(task_of(problem), peer.settings[-1])
            found[peer.name] = problem.error(t, solve(t))
    error, limit = problem.error(t, state.orientation), problem.limit(t)
    results.hard.append(HardCase(problem.name, problem.small or 0.0, limit, error, found))
