"""The causes that explain the errors of estimates: the simplest, a wanted one, or a stated model.

A cause is at most one mistake of convention, one level of rotations, and one parameter, such as a
delay. It is named if what it leaves is noise, or next to nothing, and if no simpler cause leaves as
little; causes that are as simple and as good are all named.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.causes import (
    CHANGES,
    LEVELS,
    Cause,
    Finding,
    Tables,
    fit_rotations,
    set_parameter,
)
from symtop_ros.judge.compare import MOST_STEPS, NONE, STEP, Offset, compare
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import MOST_DELAY, PARAMETERS, SAMPLES, Fit
from symtop_ros.judge.truth import Truth
from symtop_ros.simulation.validation import RefusedError

MOST_SAMPLES = 20_000  # estimates from which a cause that was found is estimated again
VALLEYS, FINER = 4, 31  # of each table that are refined, and values that are tried in each
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
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
# Estimates that stay this close (rad) to one attitude do not move, and the exact attitudes move so
# many times as far.
STILL, MOVED = 0.05, 10.0
# What a steady motion cannot show, by its kind: a delay is a rotation of both frames, and rotations
# of both frames about one axis are one.
HIDDEN = {"regular": ("delay",), "sleeping": ("rotations", "delay")}
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred
LEVELS_OF = {"none": "none", "heading": "heading", "world": "world", "world-and-body": "both"}
# Rotations, and what the stamps may be off by.
MODELS = [
    f"{rotations}{times}"
    for rotations in LEVELS_OF
    for times in ("", "+delay", "+clock", "+delay+clock")
]


def find_causes(estimates: Estimates, truth: Truth) -> Finding:
    """Return the simplest explanation that leaves little."""
    run = truth.select(estimates)
    if len(run) < 2:
        left = compare(run, truth).total
        return Finding(Cause("", "none", (), NONE, float(left @ left) / 4), explained=False)
    return Search(run, truth).find()


class Search:
    """Estimates within the run, and the explanations of them."""

    def __init__(self, run: Estimates, truth: Truth) -> None:
        """Take some estimates for the search, and more for what it has found."""
        self.some, self.more, self.truth = run.thin(SAMPLES), run.thin(MOST_SAMPLES), truth
        self.fits = {name: Fit(change[2](self.some), truth) for name, change in CHANGES.items()}
        self.fit = self.fits[""]
        self.tables = Tables(truth, self.fit.fastest)
        self.hidden = HIDDEN.get(truth.kind, ())
        steps = int(np.ptp(self.some.stamps)) // STEP + len(self.some)
        self.names = [name for name in PARAMETERS if name != "scale" or steps <= MOST_STEPS]

    def find(self) -> Finding:
        """Return the simplest of all explanations."""
        start = self.refine(("", "none", ()), self.fit.start)
        if self.is_still():
            return Finding(start, (), self.hidden, explained=False, still=True)
        if start.cost <= self.fit.rounding:  # nothing is simpler, and nothing can be better
            return Finding(start, (), self.hidden)
        best, others = self.choose([start, *self.list_causes()], len(self.some))
        if best.kind == start.kind:  # there may be a parameter that only more estimates show
            small = [
                self.refine(("", "none", each), start.offset, with_more=True)
                for each in ((), *((name,) for name in self.names))
            ]
            best, others = self.choose(small, len(self.more))
        best = self.refine(best.kind, best.offset, with_more=True)
        if best.cost * CLEAR**2 > start.cost and not self.is_white(best):
            return Finding(start, (), self.hidden, explained=False)
        return Finding(best, tuple(others), self.hidden, True, False, *self.find_period(best))

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""
        attitudes = self.some.orientations, self.fit.exact(self.fit.start)[0]
        spread, moved = (1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q) for q in attitudes)
        return bool(4 * spread < min(STILL**2, 4 * moved / MOVED**2))

    def is_white(self, cause: Cause) -> bool:
        """Return True if what an explanation leaves looks like noise, by its correlation."""
        left = self.fits[cause.change].find_left(cause.offset)
        square = float((left**2).sum())
        correlated = sum(
            float((left[k:] * left[:-k]).sum()) ** 2 for k in range(1, min(LAGS + 1, len(left)))
        )
        return square <= LOUD**2 * len(left) and 3 * len(left) * correlated <= WHITE * square**2

    def select(self, found: Sequence[Cause], count: int) -> list[Cause]:
        """Return those that are as good as the best one, in the noise of so many estimates."""
        lowest = min(found, key=lambda each: each.cost)
        factor = min(1 + CHANCE / (3 * count), SIMPLER) if self.is_white(lowest) else SIMPLER
        return [each for each in found if each.cost <= factor * lowest.cost + self.fit.rounding]

    def choose(self, found: Sequence[Cause], count: int) -> tuple[Cause, list[Cause]]:
        """Return the simplest of the good explanations, and others that are as simple and good.

        The one with the smallest rotations comes first; then the order of parameters and the delay
        count.
        """
        good, order = self.select(found, count), [*PARAMETERS]
        simple = [each for each in good if each.weight == min(other.weight for other in good)]

        def prefer(cause: Cause) -> tuple[float, float]:
            number = sum(order.index(name) for name in cause.parameters)
            return cause.turns + 1e-3 * (number + abs(cause.offset.delay)), cause.cost

        best = min(simple, key=prefer)
        largest = ALIGNED * max(best.turns, SMALL)
        ties = {
            each.kind: each
            for each in reversed(simple)
            if each.kind != best.kind and each.cost <= TIE * best.cost + self.fit.rounding
            if (each.turns <= largest and each.change != best.change)
            or each.parameters != best.parameters
        }
        return best, [*reversed(ties.values())]

    def list_causes(self) -> Iterator[Cause]:
        """Yield explanations with every change, and none or one parameter."""
        of_other = self.truth.states_at(self.some.stamps, not self.some.of_sensor)[0]
        differs = np.abs(of_other - self.fit.exact(self.fit.start)[0]).max() > SMALL
        for change in CHANGES:
            if change != "frame" or differs:
                found = [each for name in ("", *self.names) for each in self.search(change, name)]
                yield from found
                yield from self.shift_periods(found)

    def shift_periods(self, causes: Sequence[Cause]) -> Iterator[Cause]:
        """Yield the best delay again, changed by periods of the nutation, with fewer rotations.

        A fast nutation makes many valleys of nearly the same depth, and few of them are refined.
        """
        late = [each for each in causes if "delay" in each.parameters]
        best, period = min(late, key=lambda each: each.cost, default=None), self.truth.period
        if best is not None and period is not None and best.level == "both":
            most = int(2 * MOST_DELAY / period)
            values = best.offset.delay + period * np.arange(-most, most + 1, dtype=np.float64)
            values = values[np.abs(values) <= MOST_DELAY]
            yield from self.search(best.change, "delay", best.offset, values)

    def search(
        self, change: str, name: str, known: Offset = NONE, values: Real | None = None
    ) -> Iterator[Cause]:
        """Yield explanations with a change and a parameter, or none, next to those of an offset."""
        some = self.fits[change].some
        values, models = self.tables.tabulate(some, name, known, values)
        for level in CHANGES[change][1]:
            costs = np.pad(fit_rotations(models, level)[0], 1, constant_values=np.inf)
            valleys = (costs[1:-1] <= costs[:-2]) & (costs[1:-1] <= costs[2:])
            valleys &= (costs[1:-1] <= HOPELESS) | (not name)
            for place in sorted(np.flatnonzero(valleys), key=costs[1:-1].__getitem__)[:VALLEYS]:
                # Again in finer steps: a kick makes a valley narrow.
                tried = values[place] + np.ptp(values[:2]) * np.linspace(-1, 1, FINER)
                tried, finer = self.tables.tabulate(some, name, known, tried)
                left, worlds, bodies = fit_rotations(finer, level)
                best = int(left.argmin())
                start = replace(
                    self.fit.start, drift=known.drift, world=worlds[best], body=bodies[best]
                )
                start = set_parameter(start, name, float(tried[best]))
                yield self.refine((change, level, (name,) if name else ()), start)

    def refine(
        self, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, with_more: bool = False
    ) -> Cause:
        """Return the least squares of a kind of cause near an offset, of more with deviations."""
        undo = CHANGES[kind[0]][2]
        fit = Fit(undo(self.more), self.truth) if with_more else self.fits[kind[0]]
        return refine(fit, kind, offset, is_sure=with_more)

    def find_period(self, best: Cause) -> tuple[float | None, Offset]:
        """Return a period by which the delay can change, and the rotations with it."""
        period = self.truth.period
        if period is None or self.truth.is_driven or "delay" not in best.parameters:
            return None, NONE
        later = best.offset.delay - float(np.copysign(period, best.offset.delay))
        found = [*self.search(best.change, "delay", best.offset, np.array([later]))][-1:]
        kind = best.change, "both", best.parameters
        good = [self.refine(kind, each.offset) for each in found if abs(later) <= MOST_DELAY]
        if good and good[0].cost <= SIMPLER * best.cost + self.fit.rounding:
            return period, good[0].offset
        return None, NONE


def refine(
    fit: Fit, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, is_sure: bool
) -> Cause:
    """Return the least squares of a kind of cause near an offset; `is_sure`: with deviations."""
    _, level, names = kind
    turns, free = LEVELS[level][0], [PARAMETERS[name] for name in names]
    best = fit.refine(offset, [*turns, *free])
    sure = fit.find_deviations(best, [*turns, *free]) if is_sure else np.zeros(0)
    turn = float(np.linalg.norm(sure[list(turns)])) if is_sure else 0.0
    return Cause(*kind, best, fit.cost(best), tuple(sure[free].tolist()) if is_sure else (), turn)


def explain(
    estimates: Estimates, truth: Truth, removed: Collection[str] = ("offset", "delay", "drift")
) -> Cause:
    """Return the least squares of constant rotations (offset), a delay up to 0.5 s, and a drift.

    All delays and drifts are tried, and then a delay next to the best drift. Of those that leave as
    little, the one with the fewest numbers and the smallest delay is taken.
    """
    run = truth.select(estimates)
    if len(run) < 2:
        raise RefusedError(
            f"--remove must have at least 2 estimates within the run, got {len(run)}"
        )
    search, turned = Search(run, truth), "offset" in removed
    level = "none" if not turned else "world" if "rotations" in search.hidden else "both"
    names = [name for name in ("delay", "drift") if name in removed]
    found = [each for name in ("", *names) for each in search.search("", name)]
    if len(names) == 2:
        found += [
            replace(each, parameters=("delay", "drift"))
            for first in found
            if first.parameters == ("drift",)
            for each in search.search("", "delay", first.offset)
        ]
    found += search.shift_periods(found)
    causes = [
        search.refine(("", level, each.parameters), each.offset)
        for each in found
        if turned or each.level == "none"
    ]
    return min(
        search.select(causes, len(search.some)),
        key=lambda each: (len(each.parameters), abs(each.offset.delay)),
    )


def align(estimates: Estimates, truth: Truth, model: str, begin: int | None = None) -> Cause:
    """Return the least squares of a stated model, one of MODELS, without any search.

    A delay that grows is that at the stamp `begin`, by default at the first one.

    Refused is a model with a delay or a clock that changes nothing but its other parameters: in a
    sleeping top a delay is a heading.
    """
    rotations, *names = model.split("+")
    fit, level = Fit(truth.select(estimates).thin(MOST_SAMPLES), truth), LEVELS_OF[rotations]
    exact, known = fit.exact(fit.start)
    models = fit.some.orientations[None], exact[None], known[None].astype(float)
    _, world, body = fit_rotations(models, level)
    start = replace(
        fit.start,
        world=world[0],
        body=body[0],
        begin=fit.start.begin if begin is None else begin,
    )
    found = refine(fit, ("", level, tuple(names)), start, is_sure=True)
    for name in names:
        others = [*LEVELS[level][0], *(PARAMETERS[each] for each in names if each != name)]
        if fit.hides(found.offset, others, PARAMETERS[name]):
            raise RefusedError(f"--aligned must be a model that this motion can show, got {model}")
    return found
