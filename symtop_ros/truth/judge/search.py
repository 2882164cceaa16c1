"""The causes that explain the errors of estimates: the simplest, a wanted one, or a stated model.

A cause is at most one mistake of convention, one level of rotations, and one parameter, such as a
delay. It is named if it is significant, if what it leaves is noise or next to nothing, and if no
simpler cause leaves as little; causes that are as simple and as good are all named. Some estimates
are searched; what is said of the causes that were found is said of all.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.judge.causes import (
    CHANGES,
    HOPELESS,
    LEVELS,
    Cause,
    Finding,
    Tables,
    fit_rotations,
    set_parameter,
)
from symtop_ros.truth.judge.compare import MOST_STEPS, NONE, STEP, Offset, compare
from symtop_ros.truth.judge.estimates import Estimates
from symtop_ros.truth.judge.fit import MOST_DELAY, PARAMETERS, ROUNDING, SAMPLES, Fit
from symtop_ros.truth.judge.noise import PER_PARAMETER
from symtop_ros.truth.judge.truth import Truth

MOST_SAMPLES = 200_000  # estimates from which a cause that was found is estimated again
VALLEYS, FINER = 4, 31  # of each table that are refined, and values that are tried in each
# Noise makes the squares smaller by chance: by less than this, in units of the variance of one
# independent number, of the thousands of values that are tried.
CHANCE = 36.0
SIMPLER = 4.0  # if no noise is left, simpler causes count with at most twice the error (squared)
TIE = 1.5  # explanations that are as good, by their mean squares
LESS = 4.0  # the squares become so many times smaller: the cause is worth a sentence
CLEAR = 1000.0  # the error becomes so many times smaller: its cause is clear, whatever is left
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
        self.some = run.thin(SAMPLES)
        self.more = run.thin(MOST_SAMPLES)
        self.truth = truth
        self.run = run
        self.fits, self.of_more = (
            {name: Fit(change[2](those), truth) for name, change in CHANGES.items()}
            for those in (self.some, self.more)
        )
        self.fit = self.fits[""]
        self.tables = Tables(truth, self.fit.fastest)
        self.hidden = HIDDEN.get(truth.kind, ())
        steps = int(np.ptp(self.some.stamps)) // STEP + len(self.some)
        self.names = [name for name in PARAMETERS if name != "scale" or steps <= MOST_STEPS]

    def find(self) -> Finding:
        """Return the simplest of all explanations, with what it leaves of all estimates."""
        found = self.find_in_more()
        if len(self.run) == len(self.more):
            return found
        fit = Fit(CHANGES[found.best.change][2](self.run), self.truth)
        whole = replace(found.best, cost=fit.cost(found.best.offset))
        is_alike = whole.cost <= SIMPLER * found.best.cost + self.fit.rounding
        return replace(found, best=whole, explained=found.explained and is_alike)

    def find_in_more(self) -> Finding:
        """Return the simplest of all explanations of some estimates, as more of them show it."""
        start = self.refine(("", "none", ()), self.fit.start, with_more=True)
        if self.is_still():
            return Finding(start, (), self.hidden, explained=False, still=True)
        if start.cost <= self.fit.rounding:  # nothing is simpler, and nothing can be better
            return Finding(start, (), self.hidden)
        if len(self.more) < PER_PARAMETER:
            return Finding(start, (), self.hidden, explained=False, fault="few")
        coarse = self.refine(start.kind, start.offset)
        best, others = self.choose([coarse, *self.list_causes()], self.fits)
        if best.kind == start.kind:  # there may be a parameter that only more estimates show
            small = [
                self.refine(("", "none", each), start.offset, with_more=True)
                for each in ((), *((name,) for name in self.names))
            ]
            best, others = self.choose(small, self.of_more)
        best = self.refine(best.kind, best.offset, with_more=True)
        is_named, is_less = self.judge(best, start)
        if not is_named:
            candidate = best if is_less else None
            return Finding(start, (), self.hidden, False, best.fault, candidate=candidate)
        return replace(Finding(best, tuple(others), self.hidden), **self.find_period(best))

    def judge(self, best: Cause, start: Cause) -> tuple[bool, bool]:
        """Return whether an explanation is named, and else whether it would leave clearly less.

        It is named if it is significant, and leaves noise or next to nothing. What is left may be
        correlated because a filter's errors are, or because there is another cause.
        """
        if len(self.more) < PER_PARAMETER * best.count:
            return False, False
        if best.kind != start.kind and best.cost * CLEAR**2 <= start.cost:
            return True, False
        fit = self.of_more[best.change]
        left = fit.find_remainder(best.offset)
        is_sound = not best.fault and best.is_significant and left.has_shape_of_noise
        if not (is_sound and left.agrees_on(fit.derive_vectors(best.offset, best.columns))):
            return False, False
        return left.is_white, best.cost * LESS <= start.cost

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""
        attitudes = self.some.orientations, self.fit.exact(self.fit.start)[0]
        spread, moved = (1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q) for q in attitudes)
        return bool(4 * spread < min(STILL**2, 4 * moved / MOVED**2))

    def select(self, found: Sequence[Cause], fits: Mapping[str, Fit]) -> list[Cause]:
        """Return those that are as good as the best one, in the noise of so many estimates."""
        lowest = min(found, key=lambda each: each.cost)
        left = fits[lowest.change].find_remainder(lowest.offset)
        is_noise = not left.find_fault(lowest.count) and left.has_shape_of_noise
        factor = min(1 + CHANCE / (3 * left.independent), SIMPLER) if is_noise else SIMPLER
        return [each for each in found if each.cost <= factor * lowest.cost + self.fit.rounding]

    def choose(self, found: Sequence[Cause], fits: Mapping[str, Fit]) -> tuple[Cause, list[Cause]]:
        """Return the simplest of the good explanations, and others that are as simple and good.

        The one with the smallest rotations comes first; then the order of parameters and the delay
        count.
        """
        most = len(fits[""].some) / PER_PARAMETER
        enough = [each for each in found if each.count <= most or not each.weight]
        good = self.select(enough, fits)
        order = [*PARAMETERS]
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
        best = min(late, key=lambda each: each.cost, default=None)
        period = self.truth.period
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
        fit = (self.of_more if with_more else self.fits)[kind[0]]
        return refine(fit, kind, offset, is_sure=with_more)

    def find_period(self, best: Cause) -> dict[str, Any]:
        """Return a period by which the delay can change, and the rotations with it, by names."""
        period = self.truth.period
        if period is None or self.truth.is_driven or "delay" not in best.parameters:
            return {}
        later = best.offset.delay - float(np.copysign(period, best.offset.delay))
        found = [*self.search(best.change, "delay", best.offset, np.array([later]))][-1:]
        kind = best.change, "both", best.parameters
        good = [self.refine(kind, each.offset) for each in found if abs(later) <= MOST_DELAY]
        if good and good[0].cost <= SIMPLER * best.cost + self.fit.rounding:
            return {"period": period, "repeated": good[0].offset}
        return {}


def refine(
    fit: Fit, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, is_sure: bool
) -> Cause:
    """Return the least squares of a kind of cause near an offset; `is_sure`: with deviations."""
    cause = Cause(*kind, offset, np.inf)
    best = fit.refine(offset, cause.columns)
    found = replace(cause, offset=best, cost=fit.cost(best))
    return add_deviations(fit, found) if is_sure else found


def add_deviations(fit: Fit, cause: Cause) -> Cause:
    """Return a cause with its standard deviations, or with the reason why it lacks them."""
    if cause.cost <= ROUNDING:
        return replace(cause, independent=float(len(fit.some)))
    left = fit.find_remainder(cause.offset)
    found = replace(
        cause,
        independent=left.independent,
        correlation_time=left.correlation_time,
        fault=left.find_fault(cause.count),
    )
    if found.fault or not found.count:
        return found
    sure = fit.find_deviations(cause.offset, cause.columns, left)
    own = tuple(float(sure[PARAMETERS[name]]) for name in cause.parameters)
    turn = float(np.linalg.norm(sure[list(LEVELS[cause.level][0])]))
    return replace(found, deviations=own, turn_deviation=turn)


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
    search = Search(run, truth)
    turned = "offset" in removed
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
        search.select(causes, search.fits),
        key=lambda each: (len(each.parameters), abs(each.offset.delay)),
    )


def align(estimates: Estimates, truth: Truth, model: str, begin: int | None = None) -> Cause:
    """Return the least squares of a stated model, one of MODELS, without any search.

    A delay that grows is that at the stamp `begin`, by default at the first one.

    Refused is a model with a delay or a clock that changes nothing but its other parameters: in a
    sleeping top a delay is a heading.
    """
    rotations, *names = model.split("+")
    fit = Fit(truth.select(estimates).thin(MOST_SAMPLES), truth)
    level = LEVELS_OF[rotations]
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
