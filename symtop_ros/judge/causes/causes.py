"""The simplest cause that explains the errors of estimates.

A cause is at most one mistake of convention, one level of rotations, and one parameter, such as a
delay. It is named if what it leaves is noise, or next to nothing, and if no simpler cause leaves as
little; causes that are as simple and as good are all named.
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
    measure_turns,
    set_parameter,
)
from symtop_ros.judge.causes.grids import Grids
from symtop_ros.judge.causes.search import LEVELS, Table, find_valleys, fit_level
from symtop_ros.judge.compare import MOST_STEPS, NONE, Offset, count_steps, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import MOST_DELAY, SAMPLES, Fit
from symtop_ros.judge.truth import Truth

MOST_SAMPLES = 20_000  # estimates from which a cause that was found is estimated again
VALLEYS, FINER = 4, 31  # of each table that are refined, and values that are tried in each
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
MOST_PERIODS = 500  # by which a delay is changed
# Noise makes the squares smaller by chance: by less than this, in units of its variance, for each
# number that is free, of the thousands of values that are tried.
CHANCE = 36.0
SIMPLER = 4.0  # if no noise is left, simpler causes count with at most twice the error (squared)
TIE = 1.5  # explanations that are as good, by their mean squares
CLEAR = 1000.0  # the error becomes so many times smaller: its cause is clear, whatever is left
# The squares of the correlations of noise over ten lags, in units of their variances, add up to ten
# on average, and to more than 40 once in 50 000 times (Box and Pierce 1970).
LAGS, WHITE = 10, 40.0
LOUD = 0.3  # rad; noise of an attitude is smaller
SMALL = 1e-3  # rad; smaller rotations count as zero in a comparison of explanations
STILL = 0.05  # rad; estimates that stay this close to one attitude do not move
MOVED = 10.0  # and the exact attitudes move so many times as far
# What a steady motion cannot show, by its kind: a delay is a rotation of both frames, and rotations
# of both frames about one axis are one.
HIDDEN = {"regular": ("delay",), "sleeping": ("rotations", "delay")}
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred


def find_causes(estimates: Estimates, truth: Truth) -> Finding:
    """Return the simplest explanation that leaves little."""
    run = truth.select(estimates)
    if len(run) < 2:
        return Finding(Cause("", "none", (), NONE, 0.0))
    return Search(run.thin(SAMPLES), truth, run.thin(MOST_SAMPLES)).find()


@dataclass(eq=False)
class Search:
    """Some estimates within the run, and the explanations of them."""

    some: Estimates
    truth: Truth
    more: Estimates  # by which a cause that was found is estimated again
    fits: dict[tuple[str, int], Fit] = field(default_factory=dict)  # by change and estimates

    def __post_init__(self) -> None:
        """Find what the motion hides."""
        self.fit = self._fit("", self.some)
        self.hidden = HIDDEN.get(self.truth.kind, ())
        self.names = list(PARAMETERS)
        if count_steps(self.some.stamps) > MOST_STEPS:
            self.names.remove("scale")
        span = float(self.fit.seconds[-1])
        self.grids = Grids(self.some, self.truth, self.fit.fastest, span)

    def find(self) -> Finding:
        """Return the simplest of all explanations."""
        start = self.refine("", "none", (), replace(NONE, begin=int(self.some.stamps[0])))
        if self.is_still():
            return Finding(start, (), self.hidden, explained=False, still=True)
        if start.cost <= self.fit.rounding:  # nothing is simpler, and nothing can be better
            return Finding(start, (), self.hidden)
        best, others = self.choose([start, *self.list_causes()])
        if best.kind == start.kind:
            best, others = self.find_small(start)
        best = self.refine(*best.kind, best.offset, self.more)
        is_clear = best.cost * CLEAR**2 <= start.cost
        if not (is_clear or self.is_white(best)):
            return Finding(start, (), self.hidden, explained=False)
        period, repeated = self.find_period(best)
        return Finding(best, tuple(others), self.hidden, True, False, period, repeated)

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""

        def spread(q: Real) -> float:
            return float(np.sqrt(4 * max(0.0, 1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q))))

        moved = spread(self.fit.exact(0.0)[0])
        return spread(self.some.orientations) < min(STILL, moved / MOVED)

    def is_white(self, cause: Cause) -> bool:
        """Return True if what an explanation leaves looks like noise, by its correlation."""
        q, model, known = self._fit(cause.change, self.some).residuals(cause.offset)
        left = to_rotation(compose(q[known], invert(model[known]))).as_rotvec()
        square = float((left**2).sum())
        lags = range(1, min(LAGS, len(left) - 1) + 1)
        correlated = sum(float((left[k:] * left[:-k]).sum()) ** 2 for k in lags)
        return square <= LOUD**2 * len(left) and 3 * len(left) * correlated <= WHITE * square**2

    def allow(self, lowest: Cause, count: int) -> float:
        """Return the cost up to which a simpler cause is as good as the lowest one."""
        chance = 1 + CHANCE / (3 * count)
        factor = min(chance, SIMPLER) if self.is_white(lowest) else SIMPLER
        return factor * lowest.cost + self.fit.rounding

    def choose(self, found: Sequence[Cause]) -> tuple[Cause, list[Cause]]:
        """Return the simplest of the good explanations, and others that are as simple and good."""
        limit = self.allow(min(found, key=lambda each: each.cost), len(self.some))
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
        """Return the sum of the rotations; then the order of parameters and the delay count."""
        order = sum(list(PARAMETERS).index(name) for name in cause.parameters)
        return measure_turns(cause.offset) + (order + abs(cause.offset.delay)) * 1e-3

    def find_small(self, start: Cause) -> tuple[Cause, list[Cause]]:
        """Return a parameter that only more estimates show, with those that are as good."""
        names = [(), *((name,) for name in self.names)]
        causes = [self.refine("", "none", each, start.offset, self.more) for each in names]
        limit = self.allow(min(causes, key=lambda each: each.cost), len(self.more))
        if causes[0].cost <= limit:
            return causes[0], []
        best, *others = (each for each in causes if each.cost <= limit)
        return best, others

    def list_causes(self) -> Iterator[Cause]:
        """Yield explanations with every change, and none or one parameter."""
        for change in CHANGES:
            if change == "frame" and not self._differs():
                continue
            found = [each for name in ("", *self.names) for each in self.search(change, name)]
            yield from found
            yield from self.shift_periods(change, found)

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
            np.ceil((-MOST_DELAY - delay) / period), np.floor((MOST_DELAY - delay) / period) + 1
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

    def search(self, change: str, name: str, known: Offset = NONE) -> Iterator[Cause]:
        """Yield explanations with a change and a parameter, or none, next to those of an offset."""
        table = self.grids.tabulate(change, name, known)
        for level in CHANGES[change][1]:
            costs = table.costs(level)
            for valley in find_valleys(costs, VALLEYS):
                if name and costs[valley] > HOPELESS:
                    continue
                near, place = self._look_closer(change, name, known, level, table, valley)
                start = near.start(place, level)
                begin = int(self.some.stamps[0])
                offset = replace(known, world=start.world, body=start.body, begin=begin)
                offset = set_parameter(offset, name, float(near.values[place]))
                yield self.refine(change, level, (name,) if name else (), offset)

    def _look_closer(
        self, change: str, name: str, known: Offset, level: str, table: Table, place: int
    ) -> tuple[Table, int]:
        """Return a finer table around a valley, which a kick makes narrow, and its best place."""
        if not name:
            return table, place
        step = float(table.values[1] - table.values[0])
        values = table.values[place] + step * np.linspace(-1, 1, FINER)
        finer = self.grids.tabulate(change, name, known, values)
        return finer, int(finer.costs(level).argmin())

    def refine(
        self,
        change: str,
        level: str,
        names: tuple[str, ...],
        offset: Offset,
        estimates: Estimates | None = None,
    ) -> Cause:
        """Return the least squares near an offset; with estimates by these, and how sure it is."""
        fit = self._fit(change, estimates or self.some)
        return refine(fit, (change, level, names), offset, is_sure=estimates is not None)

    def find_period(self, best: Cause) -> tuple[float | None, Offset]:
        """Return a period by which the delay can change, and the rotations with it."""
        period = self.truth.period
        if period is None or self.truth.is_driven or "delay" not in best.parameters:
            return None, NONE
        later = best.offset.delay - np.copysign(period, best.offset.delay)
        exact, _, known = self.fit.exact(later)
        if abs(later) > MOST_DELAY or known.sum() < len(known) / 2:
            return None, NONE
        changed = CHANGES[best.change][2](self.some)
        start = fit_level(changed.orientations[known], exact[known], "both")
        offset = replace(best.offset, world=start.world, body=start.body, delay=float(later))
        found = self.refine(best.change, "both", best.parameters, offset)
        if found.cost <= SIMPLER * best.cost + self.fit.rounding:
            return period, found.offset
        return None, NONE

    def _fit(self, change: str, estimates: Estimates) -> Fit:
        key = change, len(estimates)
        if key not in self.fits:
            self.fits[key] = Fit(CHANGES[change][2](estimates), self.truth)
        return self.fits[key]

    def _differs(self) -> bool:
        """Return True if the sensor's attitude is not that of the body."""
        other = self.truth.states_at(self.some.stamps, not self.some.of_sensor)[0]
        return bool(np.abs(other - self.fit.exact(0.0)[0]).max() > SMALL)


def refine(
    fit: Fit, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, is_sure: bool
) -> Cause:
    """Return the least squares of a kind of cause near an offset; `is_sure`: with deviations."""
    _, level, names = kind
    turns, free = LEVELS[level][0], [PARAMETERS[name] for name in names]
    best = fit.refine(offset, [*turns, *free])
    if not is_sure:
        return Cause(*kind, best, fit.cost(best))
    sure = fit.find_deviations(best, [*turns, *free])
    turn = float(np.linalg.norm(sure[list(turns)]))
    return Cause(*kind, best, fit.cost(best), tuple(sure[free].tolist()), turn)
