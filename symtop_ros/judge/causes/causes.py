"""The simplest causes that explain the errors of estimates.

A cause is a change of convention, a rotation of the world or of the body, a delay, a drift, or the
rate of a clock. Causes are named only if they make most of the error vanish and if fewer or simpler
ones leave much more; several explanations that are as simple and as good are all named.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from symtop_ros.arrays import Real, compose, invert
from symtop_ros.judge.causes.cause import (
    CHANGES,
    PARAMETERS,
    Cause,
    Finding,
    keep_rotations,
    measure_turns,
    set_parameter,
)
from symtop_ros.judge.causes.grids import MOST, Grids
from symtop_ros.judge.causes.search import LEVELS, find_valleys, fit_level
from symtop_ros.judge.compare import MOST_STEPS, NONE, Offset, count_steps, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import SAMPLES, Fit
from symtop_ros.judge.truth import Truth

VALLEYS = 4  # of each table that are refined
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
SIMPLER = 4.0  # simpler causes count if they leave at most twice the error (squared)
MOST_PERIODS = 500  # by which a delay is changed
TIE = 1.5  # explanations that are as good, by their mean squares
CLEAR = 10.0  # the error becomes so many times smaller: its causes are clear
FAR = 0.05  # rad; more than this is noise, or the causes are others
HALF = 2.0  # less is enough if what is left is noise
WHITE = 0.5  # largest correlation of what is left, from one estimate to the next
# If nothing but noise can be left, an explanation that leaves a little more leaves a cause out.
# The correlation of 500 estimates of noise, of three components each, is within 0.026 of zero.
PURE, PURER = 0.1, 1.2
LOUD = 0.3  # rad; noise of an attitude is smaller
SMALL = 1e-3  # rad; smaller rotations count as zero in a comparison of explanations
STILL = 0.05  # rad; estimates that stay this close to one attitude do not move
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred


def find_causes(estimates: Estimates, truth: Truth) -> Finding:
    """Return the simplest explanation that leaves little."""
    some = truth.select(estimates).thin(SAMPLES)
    if len(some) < 2:
        return Finding(Cause("", "none", (), NONE, 0.0))
    return Search(some, truth).find()


@dataclass(eq=False)
class Search:
    """Some estimates within the run, and the explanations of them."""

    some: Estimates
    truth: Truth
    fits: dict[str, Fit] = field(default_factory=dict)  # by the change

    def __post_init__(self) -> None:
        """Find what the motion hides."""
        self.fit = Fit(self.some, self.truth, most=MOST)
        self.hidden = list(self.fit.find_hidden())
        self.names = [
            name
            for name in PARAMETERS
            if name not in self.hidden and not (name == "clock" and "delay" in self.hidden)
        ]
        if count_steps(self.some.stamps) > MOST_STEPS:
            self.names.remove("scale")
        span = float(self.fit.seconds[-1])
        self.grids = Grids(self.some, self.truth, self.fit.fastest, span)

    def find(self) -> Finding:
        """Return the simplest of all explanations."""
        causes = self.list_causes()
        start = next(each for each in causes if each.kind == ("", "none", ()))  # the first one
        if self.is_still():
            return Finding(start, (), tuple(self.hidden), explained=False, still=True)
        if start.cost <= self.fit.rounding:  # nothing is simpler, and nothing can be better
            return Finding(start, (), tuple(self.hidden))
        found = [start, *causes]
        best, others = self.choose(found)
        if "delay" in best.parameters and self.fit.loses_delay(best.offset):
            self.hidden.append("delay")
            best, others = self.choose([e for e in found if "delay" not in e.parameters])
        if best is start:
            return Finding(start, (), tuple(self.hidden), explained=self.is_white(start))
        ratio = np.sqrt(start.cost / max(best.cost, 1e-300))
        is_clear = ratio >= CLEAR and best.residual <= FAR
        if not is_clear and not (ratio >= HALF and self.is_white(best)):
            return Finding(start, (), tuple(self.hidden), explained=False)
        period, repeated = self.find_period(best)
        return Finding(best, tuple(others), tuple(self.hidden), True, False, period, repeated)

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""

        def spread(q: Real) -> float:
            return float(np.sqrt(4 * max(0.0, 1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q))))

        moved = spread(self.fit.exact(0.0)[0])
        return spread(self.some.orientations) < min(STILL, moved / CLEAR)

    def is_white(self, cause: Cause, limit: float = WHITE) -> bool:
        """Return True if what an explanation leaves looks like noise, by its correlation."""
        q, model, known = self._fit(cause.change).residuals(cause.offset)
        left = to_rotation(compose(q[known], invert(model[known]))).as_rotvec()
        square = float((left**2).sum())
        if square > LOUD**2 * len(left):
            return False
        lagged = float((left[1:] * left[:-1]).sum())
        return abs(lagged) <= limit * square

    def choose(self, found: Sequence[Cause]) -> tuple[Cause, list[Cause]]:
        """Return the simplest of the good explanations, and others that are as simple and good."""
        lowest = min(found, key=lambda each: each.cost)
        factor = PURER if self.is_white(lowest, PURE) else SIMPLER
        limit = factor * lowest.cost + self.fit.rounding
        good = [each for each in found if each.cost <= limit]
        least = min(each.weight for each in good)
        simple = [each for each in good if each.weight == least]
        best = min(simple, key=lambda each: (self._prefer(each), each.cost))
        ties: dict[tuple[object, ...], Cause] = {}
        for each in simple:
            if each.kind != best.kind and each.cost <= TIE * best.cost + self.fit.rounding:
                small = measure_turns(each.offset) <= ALIGNED * max(
                    measure_turns(best.offset), SMALL
                )
                if (small and each.change != best.change) or each.parameters != best.parameters:
                    ties.setdefault(each.kind, each)
        return best, list(ties.values())

    def _prefer(self, cause: Cause) -> float:
        """Return the sum of the rotations; then the smaller delay counts."""
        return measure_turns(cause.offset) + abs(cause.offset.delay) * 1e-3

    def list_causes(self) -> Iterator[Cause]:
        """Yield explanations with every change, and none, one or two parameters."""
        for change in CHANGES:
            if change == "frame" and not self._differs():
                continue
            single: list[Cause] = []
            for name in ("", *self.names):
                single += self.search(change, name)
            single += self.shift_periods(change, single)
            yield from single
            good = sorted(single, key=lambda each: each.cost)[:4]
            if good and good[0].cost > 10 * self.fit.rounding:
                yield from self.extend(change, good)

    def shift_periods(self, change: str, causes: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the best delay again, changed by periods of the nutation, with fewer rotations.

        A fast nutation makes many valleys of nearly the same depth, and few of them are refined.
        """
        late = [each for each in causes if "delay" in each.parameters]
        best = min(late, key=lambda each: each.cost, default=None)
        period = self.truth.period
        if best is None or period is None or best.level != "both":
            return
        delay = best.offset.delay
        numbers = np.arange(
            np.ceil((-MOST - delay) / period), np.floor((MOST - delay) / period) + 1
        )
        if not 1 < len(numbers) <= MOST_PERIODS:
            return
        table = self.grids.tabulate(change, "delay", best.offset, delay + period * numbers)
        for level in CHANGES[change][1]:
            place = int(table.costs(level).argmin())
            start = table.start(place, level)
            offset = replace(best.offset, world=start.world, body=start.body)
            offset = replace(offset, delay=float(table.values[place]))
            yield self.refine(change, level, best.parameters, offset)

    def extend(self, change: str, causes: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the causes with one more parameter, small ones near zero."""
        pairs = [
            self.refine(change, each.level, tuple(sorted((*each.parameters, name))), each.offset)
            for each in causes
            if each.cost <= HOPELESS and each.parameters
            for name in self.names
            if name not in each.parameters
        ]
        if not any(self.is_white(each) for each in causes):
            pairs += self.search_pairs(change, causes)
        yield from pairs
        simpler = [*self.simplify(change, pairs)]
        yield from simpler
        # A delay of another period needs rotations, and without them it is found only now.
        yield from self.simplify(change, [*pairs, *simpler])
        yield from self.shift_periods(change, pairs)

    def simplify(self, change: str, pairs: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the good ones of the smallest rotations again, with fewer of them free."""
        limit = SIMPLER * min((each.cost for each in pairs), default=0.0) + self.fit.rounding
        good = [each for each in pairs if each.cost <= limit]
        for each in sorted(good, key=lambda pair: measure_turns(pair.offset))[:VALLEYS]:
            for level in CHANGES[change][1]:
                offset = keep_rotations(each.offset, level)
                yield self.refine(change, level, each.parameters, offset)

    def search_pairs(self, change: str, causes: Sequence[Cause]) -> Iterator[Cause]:
        """Yield explanations with a second parameter that may be far from zero."""
        bases = {each.parameters: each for each in reversed(causes) if each.parameters}
        for (first,), each in bases.items():
            for name in self.names:
                if name != first and not {name, first} <= {"delay", "clock"}:
                    yield from self.search(change, name, each)

    def search(self, change: str, name: str, base: Cause | None = None) -> Iterator[Cause]:
        """Yield explanations with a change and a parameter, or none, next to those of a base."""
        known = base.offset if base else NONE
        table = self.grids.tabulate(change, name, known)
        names = {*(base.parameters if base else ()), *((name,) if name else ())}
        for level in CHANGES[change][1]:
            if level == "body" and "rotations" in self.hidden:
                continue
            costs = table.costs(level)
            for place in find_valleys(costs, VALLEYS):
                if name and costs[place] > HOPELESS:
                    continue
                start = table.start(place, level)
                begin = int(self.some.stamps[0])
                offset = replace(known, world=start.world, body=start.body, begin=begin)
                offset = set_parameter(offset, name, float(table.values[place]))
                yield self.refine(change, level, tuple(sorted(names)), offset)

    def refine(self, change: str, level: str, names: tuple[str, ...], offset: Offset) -> Cause:
        """Return the least squares near an offset."""
        fit = self._fit(change)
        best = fit.refine(offset, [*LEVELS[level][0], *(PARAMETERS[name] for name in names)])
        return Cause(change, level, names, best, fit.cost(best))

    def find_period(self, best: Cause) -> tuple[float | None, Offset]:
        """Return a period by which the delay can change, and the rotations with it."""
        period = self.truth.period
        if period is None or self.truth.is_driven or "delay" not in best.parameters:
            return None, NONE
        later = best.offset.delay - np.copysign(period, best.offset.delay)
        exact, _, known = self.fit.exact(later)
        if abs(later) > MOST or known.sum() < len(known) / 2:
            return None, NONE
        changed = CHANGES[best.change][2](self.some)
        start = fit_level(changed.orientations[known], exact[known], "both")
        offset = replace(best.offset, world=start.world, body=start.body, delay=float(later))
        found = self.refine(best.change, "both", best.parameters, offset)
        if found.cost <= SIMPLER * best.cost + self.fit.rounding:
            return period, found.offset
        return None, NONE

    def _fit(self, change: str) -> Fit:
        if change not in self.fits:
            self.fits[change] = Fit(CHANGES[change][2](self.some), self.truth, most=MOST)
        return self.fits[change]

    def _differs(self) -> bool:
        """Return True if the sensor's attitude is not that of the body."""
        other = self.truth.states_at(self.some.stamps, not self.some.of_sensor)[0]
        return bool(np.abs(other - self.fit.exact(0.0)[0]).max() > SMALL)
