"""The search for causes that explain the errors of estimates.

A cause is at most one mistake of convention, one level of rotations, and one parameter, such as a
delay. Each kind is tried with all values of its parameter, and refined next to the best of them;
`choice` says which one is named. Some estimates are searched; what is said of the causes that were
found is said of all.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose
from symtop_ros.truth.judge.alignment import MOST_DELAY, PARAMETERS, SAMPLES, Alignment
from symtop_ros.truth.judge.causes import (
    CHANGES,
    CONVENTIONS,
    PERMUTED,
    Cause,
    Finding,
    Fits,
    set_parameter,
)
from symtop_ros.truth.judge.choice import SIMPLER, SMALL, choose, judge, select
from symtop_ros.truth.judge.compare import MOST_STEPS, NONE, STEP, Offset, compare
from symtop_ros.truth.judge.grid import COARSE, HOPELESS, Tables, fit_levels, fit_rotations
from symtop_ros.truth.judge.refine import refine
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.residuals import PER_PARAMETER
from symtop_ros.truth.topics.estimates import Estimates

MOST_SAMPLES = 200_000  # estimates from which a cause that was found is estimated again
TURNING = {"drift", "spin", "scale"}  # parameters with a direction in space
SAME_VALUE = 4  # digits in which values of a parameter are one
PERMUTED_LEVELS = CHANGES[next(iter(PERMUTED))][1]
VALLEYS, FINER = 4, 31  # of each table that are refined, and values that are tried in each
# Estimates that stay this close (rad) to one attitude do not move, and the exact attitudes move so
# many times as far.
STILL, MOVED = 0.05, 10.0
# What a steady motion cannot show, by its kind: a delay is a rotation of both frames, and rotations
# of both frames about one axis are one.
HIDDEN = {"regular": ("delay",), "sleeping": ("rotations", "delay")}


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
        self.fits, self.of_more = (Fits(those, truth) for those in (self.some, self.more))
        self.fit = self.fits[""]
        self.few = Alignment(self.some.thin(COARSE), truth)
        self.tables = Tables(truth, self.fit.fastest)
        self.hidden = HIDDEN.get(truth.kind, ())
        steps = int(np.ptp(self.some.stamps)) // STEP + len(self.some)
        # In a sleeping top a delay is a heading, and any number of turns of it are as good.
        is_delay_heading = "rotations" in self.hidden
        left_out = {"scale": steps > MOST_STEPS, "delay": is_delay_heading}
        self.names = [name for name in PARAMETERS if not left_out.get(name)]

    def find(self) -> Finding:
        """Return the simplest of all explanations, with what it leaves of all estimates."""
        found = self.find_in_more()
        if len(self.run) == len(self.more):
            return found
        fit = Alignment(CHANGES[found.best.change][2](self.run), self.truth)
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
        best, others = self.choose()
        best = self.refine(best.kind, best.offset, with_more=True)
        is_named, is_less = judge(best, start, self.of_more[best.change])
        if not is_named:
            candidate = best if is_less else None
            found = Finding(start, (), self.hidden, False, best.fault, candidate=candidate)
            return replace(found, nearest=best)
        equals = tuple(self.refine(each.kind, each.offset, with_more=True) for each in others)
        return replace(Finding(best, equals, self.hidden), **self.find_period(best))

    def choose(self) -> tuple[Cause, list[Cause]]:
        """Return the best explanation and its equals: found in some estimates, chosen by more.

        What noise hides in some of them more may show.
        """
        none = self.refine(("", "none", ()), self.fit.start)
        small = [replace(none, parameters=(name,)) for name in self.names]
        found = self.select_in_more([none, *self.list_causes()], small)
        return choose(found, self.of_more, self.fit.rounding)

    def select_in_more(self, found: Sequence[Cause], others: Sequence[Cause] = ()) -> list[Cause]:
        """Return the best of some explanations, and others, as the least squares of more."""
        good = [*others, *select(found, self.fits, self.fit.rounding)]
        return [refine(self.of_more[e.change], e.kind, e.offset, is_sure=False) for e in good]

    def is_still(self) -> bool:
        """Return True if the estimates keep one attitude while the top turns."""
        attitudes = self.some.orientations, self.fit.exact(self.fit.start)[0]
        spread, moved = (1 - np.linalg.eigvalsh(q.T @ q)[-1] / len(q) for q in attitudes)
        return bool(4 * spread < min(STILL**2, 4 * moved / MOVED**2))

    def list_causes(self) -> Iterator[Cause]:
        """Yield explanations with every change, and none or one parameter."""
        of_other = self.truth.states_at(self.some.stamps, not self.some.of_sensor)[0]
        differs = np.abs(of_other - self.fit.exact(self.fit.start)[0]).max() > SMALL
        for change in CONVENTIONS:
            if change != "frame" or differs:
                found = [each for name in ("", *self.names) for each in self.search(change, name)]
                found += self.shift_periods(found)
                yield from found
                if change in ("", "conjugate"):
                    yield from self.permute(found)

    def permute(self, found: Sequence[Cause]) -> Iterator[Cause]:
        """Yield mixed columns, with the parameters of explanations by two rotations.

        Any signed permutation is a rotation of both frames, some of the conjugate.
        """
        both = [each for each in found if each.level == "both" and each.cost <= HOPELESS]
        lowest = min((each.cost for each in both), default=0.0)
        good = [each for each in both if each.cost <= SIMPLER * lowest + self.fit.rounding]
        kinds: dict[tuple[str, ...], Offset] = {(): self.fit.start}
        for each, sign in product(good, (1, -1)):
            for name in each.parameters:  # a turned world may turn the other way round
                value = getattr(each.offset, name) * (sign if name in TURNING else 1)
                rounded = f"{value:.{SAME_VALUE}g}"
                kinds[name, rounded] = set_parameter(self.fit.start, name, value)
        for (kind, start), level in product(kinds.items(), PERMUTED_LEVELS):
            yield from self._permute(level, kind[:1], start)

    def _permute(self, level: str, parameters: tuple[str, ...], start: Offset) -> Iterator[Cause]:
        """Yield the best of the permutations with a parameter and with rotations of a level."""
        few = self.few.some
        exact, known = self.few.exact(start)
        exact = compose(compose(start.turn_world(few.stamps), exact), start.turn_body(few.stamps))
        q = np.stack([each.undo(few.orientations) for each in PERMUTED.values()])
        models = q, np.broadcast_to(exact, q.shape), np.broadcast_to(known * 1.0, q.shape[:2])
        costs, worlds, _ = fit_rotations(models, level)
        names = [*PERMUTED]
        for place in np.argsort(costs)[:VALLEYS].tolist():
            if costs[place] <= HOPELESS:
                near = replace(start, world=worlds[place])
                yield self.refine((names[place], level, parameters), near)

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
        for level, fitted in fit_levels(models, CHANGES[change][1]).items():
            costs = np.pad(fitted[0], 1, constant_values=np.inf)
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
