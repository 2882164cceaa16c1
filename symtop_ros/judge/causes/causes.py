"""The simplest causes that explain the errors of estimates.

A cause is a change of convention, a rotation of the world or of the body, a delay, a drift, or the
rate of a clock. Causes are named only if they make most of the error vanish and if fewer or simpler
ones leave much more; several explanations that are as simple and as good are all named.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.causes.changes import CHANGES
from symtop_ros.judge.causes.search import LEVELS, Table
from symtop_ros.judge.compare import IDENTITY, NONE, Offset, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.explain import (
    CLOCK,
    DELAY,
    DRIFT,
    GRID_STEP,
    MOST_DELAYS,
    SAMPLES,
    SPIN,
    Fit,
)
from symtop_ros.judge.truth import Truth
from symtop_ros.quaternions import compose, invert

MOST = 0.5  # s, of a delay
MOST_CLOCK = 5e-3  # s per s
TURNS = 8  # of world or body within the run, by a drift
COARSE = 150  # estimates that the search takes; the refinement takes SAMPLES
VALLEYS = 2  # of each table that are refined
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
SIMPLER = 4.0  # simpler causes count if they leave at most twice the error (squared)
TIE = 1.5  # explanations that are as good, by their mean squares
CLEAR = 10.0  # the error becomes so many times smaller: its causes are clear
HALF = 2.0  # less is enough if what is left is noise
WHITE = 0.5  # largest correlation of what is left, from one estimate to the next
LOUD = 0.3  # rad; noise of an attitude is smaller
SMALL = 1e-3  # rad; rotations below this are none in a comparison of explanations
STILL = 0.05  # rad; estimates that stay this close to one attitude do not move
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred
PARAMETERS = {"delay": DELAY, "drift": DRIFT, "clock": CLOCK, "spin": SPIN}


@dataclass(frozen=True, eq=False)
class Cause:
    """One explanation, and what it leaves."""

    change: str
    level: str  # which rotations are free
    parameters: tuple[str, ...]
    offset: Offset
    cost: float  # mean square of the distances of quaternions

    @property
    def weight(self) -> float:
        """How much it takes to be true; smaller is simpler."""
        return CHANGES[self.change][0] + LEVELS[self.level][1] + len(self.parameters)

    @property
    def residual(self) -> float:
        """Root mean square of the angle that is left in rad."""
        return float(np.sqrt(4 * self.cost))

    @property
    def kind(self) -> tuple[object, ...]:
        """What it names, without numbers."""
        return self.change, self.level, self.parameters


@dataclass(frozen=True, eq=False)
class Finding:
    """What explains the errors of estimates."""

    best: Cause
    others: tuple[Cause, ...] = ()  # as simple and as good
    hidden: tuple[str, ...] = ()
    explained: bool = True  # False: most of the error is left
    still: bool = False  # True: the estimates do not move, and the top does
    period: float | None = None  # s; delays that differ by it are as good, with `repeated`
    repeated: Offset = NONE


def find_causes(estimates: Estimates, truth: Truth) -> Finding:
    """Return the simplest explanation that leaves little."""
    inside = truth.states_at(estimates.stamps, estimates.of_sensor)[2]
    run = estimates.select(inside)
    every = max(1, len(run) // SAMPLES)
    some = run.select(np.arange(len(run)) % every == 0)
    nothing = Cause("", "none", (), NONE, 0.0)
    if len(some) < 2:
        return Finding(nothing)
    return Search(some, truth).find()


@dataclass(eq=False)
class Search:
    """Some estimates within the run, and the explanations of them."""

    some: Estimates
    truth: Truth

    def __post_init__(self) -> None:
        """Find what the motion hides."""
        self.fit = Fit(self.some, self.truth, most=MOST)
        self.hidden = list(self.fit.find_hidden())
        self.names = [
            name
            for name in PARAMETERS
            if name not in self.hidden and not (name == "clock" and "delay" in self.hidden)
        ]
        self.span = float(self.fit.seconds[-1])

    def find(self) -> Finding:
        """Return the simplest of all explanations."""
        found = list(self.list_causes())
        start = next(each for each in found if each.kind == ("", "none", ()))
        if self.is_still():
            return Finding(start, (), tuple(self.hidden), explained=False, still=True)
        best, others = self.choose(found)
        if "delay" in best.parameters and self.fit.loses_delay(best.offset):
            self.hidden.append("delay")
            best, others = self.choose([e for e in found if "delay" not in e.parameters])
        if best is start:
            clear = start.cost <= self.fit.rounding or self.is_white(start)
            return Finding(start, (), tuple(self.hidden), explained=clear)
        ratio = np.sqrt(start.cost / max(best.cost, 1e-300))
        if ratio < CLEAR and not (ratio >= HALF and self.is_white(best)):
            return Finding(start, (), tuple(self.hidden), explained=False)
        period, repeated = self.find_period(best)
        return Finding(best, tuple(others), tuple(self.hidden), True, False, period, repeated)

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""

        def spread(q: Real) -> float:
            return float(np.sqrt(4 * max(0.0, 1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q))))

        moved = spread(self.fit.exact(0.0)[0])
        return spread(self.some.orientations) < min(STILL, moved / CLEAR)

    def is_white(self, cause: Cause) -> bool:
        """Return True if what an explanation leaves looks like noise."""
        fit = self._fit(cause.change, cause.level)
        q, model, known = fit.residuals(cause.offset)
        left = to_rotation(compose(q[known], invert(model[known]))).as_rotvec()
        square = float((left**2).sum())
        if square > LOUD**2 * len(left):
            return False
        lagged = float((left[1:] * left[:-1]).sum())
        return abs(lagged) <= WHITE * square

    def choose(self, found: Sequence[Cause]) -> tuple[Cause, list[Cause]]:
        """Return the simplest of the good explanations, and others that are as simple and good."""
        limit = SIMPLER * min(each.cost for each in found) + self.fit.rounding
        good = [each for each in found if each.cost <= limit]
        least = min(each.weight for each in good)
        simple = [each for each in good if each.weight == least]
        best = min(simple, key=lambda each: (self._prefer(each), each.cost))
        ties: dict[tuple[object, ...], Cause] = {}
        for each in simple:
            if each.kind != best.kind and each.cost <= TIE * best.cost + self.fit.rounding:
                small = _turned(each.offset) <= ALIGNED * max(_turned(best.offset), SMALL)
                if (small and each.change != best.change) or each.parameters != best.parameters:
                    ties.setdefault(each.kind, each)
        return best, list(ties.values())

    def _prefer(self, cause: Cause) -> float:
        """Return the sum of the rotations; then the smaller delay counts."""
        return _turned(cause.offset) + abs(cause.offset.delay) * 1e-3

    def list_causes(self) -> Iterator[Cause]:
        """Yield explanations with every change, and none, one or two parameters."""
        for change in CHANGES:
            if change == "frame" and not self._differs():
                continue
            single: list[Cause] = []
            for name in ("", *self.names):
                single += self.search(change, name)
            yield from single
            good = sorted(single, key=lambda each: each.cost)[:4]
            if good and good[0].cost > 10 * self.fit.rounding:
                yield from self.extend(change, good)

    def extend(self, change: str, causes: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the causes with one more parameter, small ones near zero."""
        pairs = [
            self.refine(change, each.level, tuple(sorted((*each.parameters, name))), each.offset)
            for each in causes
            if each.cost <= HOPELESS and each.parameters
            for name in self.names
            if name not in each.parameters
        ]
        yield from pairs
        simpler = [*self.simplify(change, pairs)]
        yield from simpler
        # A delay of another period needs rotations, and without them it is found only now.
        yield from self.simplify(change, [*pairs, *simpler])

    def simplify(self, change: str, pairs: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the good ones of the smallest rotations again, with fewer of them free."""
        limit = SIMPLER * min((each.cost for each in pairs), default=0.0) + self.fit.rounding
        good = [each for each in pairs if each.cost <= limit]
        for each in sorted(good, key=lambda pair: _turned(pair.offset))[:VALLEYS]:
            for level in CHANGES[change][1]:
                offset = _keep(each.offset, level)
                yield self.refine(change, level, each.parameters, offset)

    def search(self, change: str, name: str) -> Iterator[Cause]:
        """Yield explanations with a change and a parameter, or none."""
        table = self._tabulate(change, name)
        for level in CHANGES[change][1]:
            if level != "none" and "rotations" in self.hidden and level == "body":
                continue
            costs = table.costs(level)
            padded = np.concatenate(([np.inf], costs, [np.inf]))
            valleys = np.flatnonzero((costs <= padded[:-2]) & (costs <= padded[2:]))
            for place in valleys[np.argsort(costs[valleys])][:VALLEYS].tolist():
                if name and costs[place] > HOPELESS:
                    continue
                start = table.start(place, level)
                begin = int(self.some.stamps[0])
                offset = _set(replace(start, begin=begin), name, float(table.values[place]))
                yield self.refine(change, level, (name,) if name else (), offset)

    def refine(self, change: str, level: str, names: tuple[str, ...], offset: Offset) -> Cause:
        """Return the least squares near an offset."""
        fit = self._fit(change, level)
        best = fit.refine(offset, tuple(PARAMETERS[name] for name in names))
        return Cause(change, level, names, best, fit.cost(best))

    def find_period(self, best: Cause) -> tuple[float | None, Offset]:
        """Return a period by which the delay can change, and the rotations with it."""
        period = self.truth.period
        if period is None or "delay" not in best.parameters:
            return None, NONE
        later = best.offset.delay - np.copysign(period, best.offset.delay)
        exact, _, known = self.fit.exact(later)
        if abs(later) > MOST or known.sum() < len(known) / 2:
            return None, NONE
        changed = CHANGES[best.change][2](self.some)
        start = Table(
            np.zeros(1),
            changed.orientations[np.newaxis],
            exact[np.newaxis],
            known[np.newaxis].astype(np.float64),
        ).start(0, "both")
        offset = replace(best.offset, world=start.world, body=start.body, delay=float(later))
        found = self.refine(best.change, "both", best.parameters, offset)
        if found.cost <= SIMPLER * best.cost + self.fit.rounding:
            return period, found.offset
        return None, NONE

    def _fit(self, change: str, level: str) -> Fit:
        fits = self.__dict__.setdefault("fits", {})
        if change not in fits:
            fits[change] = Fit(CHANGES[change][2](self.some), self.truth, most=MOST)
        fit: Fit = fits[change]
        fit.turns = LEVELS[level][0]
        return fit

    def _tabulate(self, change: str, name: str) -> Table:
        """Return the table of a parameter; without a name, of nothing."""
        every = max(1, len(self.some) // COARSE) if name else 1
        some = CHANGES[change][2](self.some).select(np.arange(len(self.some)) % every == 0)
        values = self._grid(name) if name else np.zeros(1)
        begin = int(self.some.stamps[0])
        offsets = [_set(replace(NONE, begin=begin), name, float(v)) for v in values]
        exact, known = self._exact(some, name, offsets)
        if name == "spin":
            exact = np.stack([compose(exact[0], each.turn_body(some.stamps)) for each in offsets])
        q = some.orientations[np.newaxis]
        if name == "drift":
            q = np.stack([compose(invert(e.turn_world(some.stamps)), q[0]) for e in offsets])
        shape = (len(values), len(some))
        return Table(
            values,
            np.broadcast_to(q, (*shape, 4)),
            np.broadcast_to(exact, (*shape, 4)),
            np.asarray(np.broadcast_to(known, shape), dtype=np.float64),
        )

    def _exact(self, some: Estimates, name: str, offsets: Sequence[Offset]) -> tuple[Real, Real]:
        """Return exact attitudes and what is known of them, for each offset or once for all."""
        cache = self.__dict__.setdefault("exacts", {})
        moved = offsets if name in ("delay", "clock") else offsets[:1]
        key = name if name in ("delay", "clock") else "", len(some), some.of_sensor
        if key not in cache:
            stamps = np.concatenate([each.shift(some.stamps) for each in moved])
            exact, _, known = self.truth.states_at(stamps, some.of_sensor)
            shape = (len(moved), len(some))
            cache[key] = exact.reshape(*shape, 4), known.reshape(shape).astype(np.float64)
        found: tuple[Real, Real] = cache[key]
        return found

    def _grid(self, name: str) -> Real:
        if name in ("delay", "clock"):
            most = MOST if name == "delay" else MOST_CLOCK
            turn = most * self.fit.fastest * (1.0 if name == "delay" else self.span)
        else:
            turn = 2 * np.pi * TURNS
            most = turn / self.span
        count = int(min(max(turn / GRID_STEP, 10), MOST_DELAYS))
        return np.linspace(-most, most, 2 * count + 1)

    def _differs(self) -> bool:
        """Return True if the sensor's attitude is not that of the body."""
        other = self.truth.states_at(self.some.stamps, not self.some.of_sensor)[0]
        return bool(np.abs(other - self.fit.exact(0.0)[0]).max() > SMALL)


def _set(offset: Offset, name: str, value: float) -> Offset:
    """Return an offset with a parameter; without a name, the same."""
    changed: dict[str, Any] = {name: value} if name else {}
    return replace(offset, **changed)


def _keep(offset: Offset, level: str) -> Offset:
    """Return an offset with those of its rotations that a level has."""
    turns = LEVELS[level][0]
    world = offset.world if 2 in turns else IDENTITY
    if level == "heading":
        world = world * np.array([1.0, 0.0, 0.0, 1.0])
        size = float(np.linalg.norm(world))
        world = world / size if size > 0 else IDENTITY
    return replace(offset, world=world, body=offset.body if 5 in turns else IDENTITY)


def _turned(offset: Offset) -> float:
    return float(sum(offset.angles))
