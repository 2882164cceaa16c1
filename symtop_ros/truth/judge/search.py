"""The search for causes that explain the errors of estimates.

A cause is at most one mistake of convention, one level of rotations, and one parameter, such as a
delay. Each kind is tried with all values of its parameter, and refined next to the best of them;
`choice` says which one is named. Some estimates are searched; what is said of the causes that were
found is said of all.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose
from symtop_ros.truth.judge.aliases import describe_family, gather
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
from symtop_ros.truth.judge.choice import (
    SIMPLER,
    SMALL,
    Choice,
    choose,
    explains_part,
    judge,
    select,
)
from symtop_ros.truth.judge.compare import MOST_STEPS, NONE, STEP, Offset, compare
from symtop_ros.truth.judge.grid import (
    COARSE,
    HOPELESS,
    Tables,
    find_depths,
    find_minima,
    fit_levels,
    fit_rotations,
)
from symtop_ros.truth.judge.refine import refine
from symtop_ros.truth.judge.stamps import find_steps
from symtop_ros.truth.judge.swing import find_swing
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.residuals import PER_PARAMETER
from symtop_ros.truth.topics.estimates import Estimates

MOST_SAMPLES = 200_000  # estimates from which a cause that was found is estimated again
TURNING = {"drift", "spin", "scale"}  # parameters with a direction in space
TURNED = {"body", "both"}  # levels at which the body is turned
SAME_VALUE = 4  # values of a parameter that agree in so many digits count as one
PERMUTED_LEVELS = CHANGES[next(iter(PERMUTED))][1]
VALLEYS, FINER = 4, 31  # of each table that are refined, and values that are tried in each
LINED = 16_384  # estimates in which lines are looked for, from the first on
# largest number of estimates for which the minima of the delay are compared with all of them
PROFILED = 10_000
MOST_VALLEYS = 100  # valleys of a delay that are searched in finer steps for the deepest
# Estimates that stay this close (rad) to one attitude do not move, and the exact attitudes move so
# many times as far.
STILL, MOVED = 0.05, 10.0
# What a steady motion cannot show, by its kind: a delay is a rotation of both frames, and rotations
# of both frames about one axis are one.
HIDDEN = {"regular": ("delay",), "sleeping": ("rotations", "delay")}


def find_causes(estimates: Estimates, truth: Truth) -> Finding:
    """Return the simplest explanation with a small residual."""
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
        found = self._find_whole(self.find_in_more())
        if found.explained or found.still or len(self.run) < PER_PARAMETER:
            return found
        first = self.run.select(np.arange(len(self.run)) < LINED)
        fit = Alignment(CHANGES[found.said.change][2](first), self.truth)
        return replace(found, swing=find_swing(fit, found.said.offset))

    def _find_whole(self, found: Finding) -> Finding:
        """Return a finding with the residuals of all estimates."""
        if len(self.run) == len(self.more):
            return found
        whole: dict[str, Any] = {
            name: replace(each, cost=self._find_cost(each), rms=None)
            for name in ("best", "candidate")
            if (each := getattr(found, name))
        }
        is_alike = whole["best"].cost <= SIMPLER * found.best.cost + self.fit.rounding
        if found.explained and not is_alike:
            start = replace(whole["best"], change="", offset=self.fit.start)
            whole["share"] = max(1 - math.sqrt(whole["best"].cost / self._find_cost(start)), 0.0)
        return replace(found, **whole, explained=found.explained and is_alike)

    def _find_cost(self, cause: Cause) -> float:
        """Return the mean square that a cause leaves of all estimates."""
        fit = Alignment(CHANGES[cause.change][2](self.run), self.truth)
        return fit.cost(cause.offset)

    def find_in_more(self) -> Finding:
        """Return the simplest of all explanations of some estimates, as more of them show it."""
        start = self.refine(("", "none", ()), self.fit.start, with_more=True)
        if self.is_still():
            return Finding(start, (), self.hidden, explained=False, still=True)
        if start.cost <= self.fit.rounding:  # nothing is simpler, and nothing can be better
            return Finding(start, (), self.hidden)
        if len(self.more) < PER_PARAMETER:
            return Finding(start, (), self.hidden, explained=False, fault="few")
        choice = self.choose()
        best, *others = self.profile(choice.best)
        is_named = judge(best, start, self.of_more[best.change])
        if not is_named and (found := self.find_stepped(best)):
            return found
        if not (is_named or explains_part(best, start, self.fits[best.change], self.fit)):
            fault = "few" if len(self.more) < PER_PARAMETER * best.count else start.fault
            share = max(1 - math.sqrt(choice.lowest / start.cost), 0.0)
            return Finding(start, (), self.hidden, False, fault, nearest=best, share=share)
        equals = tuple(self._refine_again(each) for each in choice.others)
        found = Finding(best, equals) if is_named else Finding(start, equals, (), False)
        found = replace(found, candidate=None if is_named else best)
        is_valley = "delay" in choice.best.parameters and not best.parameters
        return replace(found, **self.find_delays(best, others, is_valley=is_valley))

    def find_stepped(self, best: Cause) -> Finding | None:
        """Return a cause with a delay and stamps in steps, if they explain the rest."""
        if best.parameters not in ((), ("delay",)):
            return None
        late = self.refine((best.change, best.level, ("delay",)), best.offset, with_more=True)
        steps = find_steps(self.of_more[best.change], late.offset)
        return Finding(late, (), (), steps=steps) if steps else None

    def _refine_again(self, cause: Cause) -> Cause:
        return self.refine(cause.kind, cause.offset, with_more=True)

    def profile(self, best: Cause) -> list[Cause]:
        """Return a cause and others with delays that fit equally well, the smallest delay first.

        If a rotation of the body is fitted, too, and the residual without a delay is as small, the
        delay is unknown: then the cause without a delay is returned.
        """
        if best.parameters != ("delay",):
            return [self._refine_again(best)]
        levels = self.find_valleys(best.change, "delay", NONE, None, MOST_VALLEYS)
        found = [best, *(self.refine(best.kind, each) for each in levels.get(best.level, []))]
        if best.level in TURNED:
            found += self.find_still(best)
        good = select(found, self.fits, self.fit.rounding)
        if len(self.more) <= PROFILED:
            good = self.select_in_more(good)
            good = select(good, self.of_more, self.fit.rounding)
        if without := [each for each in good if not each.parameters]:
            return [self._refine_again(without[0])]
        first, *others = gather(good, self.fit.fastest)
        return [self._refine_again(first), *others]

    def find_still(self, best: Cause) -> list[Cause]:
        """Return rotations of both frames in place of those of a cause and its delay."""
        return [each for each in self.search(best.change, "") if each.level == "both"]

    def find_delays(
        self, best: Cause, others: Sequence[Cause], *, is_valley: bool
    ) -> dict[str, Any]:
        """Return the other possible delays of a cause, by the names of a finding."""
        if "delay" not in best.parameters:
            hidden = tuple(dict.fromkeys([*self.hidden, *["delay"] * is_valley]))
            is_turned = hidden == ("delay",) and best.level in TURNED
            return {"hidden": hidden, "turning": self.truth.rates if is_turned else None}
        hidden = tuple(name for name in self.hidden if name != "delay")
        found: dict[str, Any] = {"hidden": hidden, "aliases": tuple(others)}
        if "delay" in self.hidden and (still := self.find_still(best)):
            found["same"] = self._refine_again(still[0])
        elif not others:
            found |= self.find_period(best)
        return found | (describe_family([best, *others]) if others else {})

    def choose(self) -> Choice:
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
                for same in self._list_periods(value) if name == "delay" else [value]:
                    rounded = f"{same:.{SAME_VALUE}g}"
                    kinds[name, rounded] = set_parameter(self.fit.start, name, same)
        for (kind, start), level in product(kinds.items(), PERMUTED_LEVELS):
            yield from self._permute(level, kind[:1], start)

    def _list_periods(self, delay: float) -> list[float]:
        """Return a delay and those that differ by periods of the nutation, which are as good.

        With two free rotations all of them are equally good; otherwise only one is.
        """
        period = self.truth.period
        if period is None:
            return [delay]
        most = int(2 * MOST_DELAY / period)
        values = delay + period * np.arange(-most, most + 1, dtype=np.float64)
        return list(map(float, values[np.abs(values) <= MOST_DELAY]))

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
        if best is not None and self.truth.period is not None and best.level == "both":
            values = np.array(self._list_periods(best.offset.delay))
            yield from self.search(best.change, "delay", best.offset, values)

    def search(
        self, change: str, name: str, known: Offset = NONE, values: Real | None = None
    ) -> Iterator[Cause]:
        """Yield explanations with a change and a parameter, or none, next to those of an offset."""
        # Valleys of a delay, a nutation apart, are nearly equally deep, and the coarse steps hide
        # which is deepest.
        most = MOST_VALLEYS if name == "delay" else VALLEYS
        for level, valleys in self.find_valleys(change, name, known, values, most).items():
            for start in valleys[:VALLEYS]:
                yield self.refine((change, level, (name,) if name else ()), start)

    def find_valleys(
        self, change: str, name: str, known: Offset, values: Real | None, most: int
    ) -> dict[str, list[Offset]]:
        """Return values with small residuals by levels, the smallest first, at most `most`."""
        some, levels = self.fits[change].some, CHANGES[change][1]
        values, models = self.tables.tabulate(some, name, known, values)
        places = {
            level: find_minima(costs, most, HOPELESS if name else np.inf)
            for level, (costs, *_) in fit_levels(models, levels).items()
        }
        all_places = np.unique(np.concatenate([*places.values()]))
        if not len(all_places):
            return {}
        # Again in finer steps: a kick makes a valley narrow.
        finer = np.ptp(values[:2]) * np.linspace(-1, 1, FINER)
        tried = (values[all_places, np.newaxis] + finer).ravel()
        tried, models = self.tables.tabulate(some, name, known, tried)
        found = {}
        for level, (costs, worlds, bodies) in fit_levels(models, levels).items():
            rows = np.searchsorted(all_places, places[level])
            chosen, depths = find_depths(costs.reshape(-1, FINER)[rows])
            order = np.argsort(depths, kind="stable")
            starts = (rows * FINER + chosen)[order].tolist()
            found[level] = [
                set_parameter(
                    replace(self.fit.start, drift=known.drift, world=worlds[k], body=bodies[k]),
                    name,
                    float(tried[k]),
                )
                for k in starts
            ]
        return found

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
