"""Least squares of estimates: rotations, a delay, drifts, the rate of a clock, a scale."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from symtop_ros.arrays import Real, Stamps, compose, invert
from symtop_ros.judge.causes.search import find_valleys, fit_rotations, from_vector
from symtop_ros.judge.compare import NONE, Offset, Scaling, subtract, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.truth import Truth
from symtop_ros.wire.layout import NANOSECONDS

SAMPLES = 500  # estimates that a fit takes, spread over the run
MAX_DELAY = 0.1  # s
# Delays are tried in steps in which the fastest turn is so many rad, drifts in steps in which the
# heading turns as much within the run; the best ones are refined.
GRID_STEP = 0.5  # rad
MOST_DELAYS = 1000
MOST_TURNS = 2  # of the heading, by a drift
CANDIDATES = 3
FINE = 1e-9  # s, or rad/s
ITERATIONS = 30  # of Gauss and Newton; they converge quadratically
STEPS = (1.0, 0.3, 0.1)  # parts of a step that are tried, until one is an improvement
ENOUGH = 1e-6  # part of the mean square; less is no improvement
WORTHWHILE = 1.01  # a delay or drift counts if it makes the mean square smaller by this factor
ROUNDING = 1e-28  # mean square of errors that are rounding
# Columns of the derivatives: a rotation vector of the world and of the body, delay, and drift.
# The last three are the rate of the clock, a drift about the axis of the body, and the scale of a
# gyroscope.
ROTATIONS, DELAY, DRIFT, CLOCK, SPIN, SCALE = range(6), 6, 7, 8, 9, 10
COLUMNS = 11
# Singular values below this are zero. Those of steady motions are rounding, those of visible
# nutation are larger than its amplitude.
RANK = 1e-7
SIGMAS = 2.0
VISIBLE = 1e-3  # part of a parameter in what the motion hides
Exact = tuple[Real, Real, NDArray[np.bool_]]  # quaternions, rates, and the mask of those known


@dataclass(eq=False)
class Fit:
    """Some estimates, and the ways to compare them with the exact motion."""

    some: Estimates
    truth: Truth
    turns: tuple[int, ...] = tuple(ROTATIONS)  # columns of the rotations that are looked for
    most: float = MAX_DELAY  # s
    hidden: list[str] = field(default_factory=list)
    # delay, clock and scale, and their motion
    _last: tuple[tuple[float, float, float], Exact] | None = None
    _scaling: tuple[tuple[float, float], Scaling] | None = None  # by delay and clock

    @cached_property
    def seconds(self) -> Real:
        """Times since the first estimate in s, (n,)."""
        return np.asarray((self.some.stamps - self.some.stamps[0]) / NANOSECONDS)

    def exact(self, delay: float, clock: float = 0.0, scale: float = 0.0) -> Exact:
        """Return exact quaternions, rates and the mask of those known, for a delay.

        With a scale the quaternions are those that a gyroscope of this scale would show.
        """
        if self._last is None or self._last[0] != (delay, clock, scale):
            q, rates, known = self.truth.states_at(self.shift(delay, clock), self.some.of_sensor)
            if scale:
                q = compose(self.scaling(delay, clock).turn(scale), q)
            self._last = (delay, clock, scale), (q, rates * (1 + scale), known)
        return self._last[1]

    def shift(self, delay: float, clock: float) -> Stamps:
        """Return the stamps of the exact states, for a delay and a clock."""
        begin = int(self.some.stamps[0])
        return replace(NONE, delay=delay, clock=clock, begin=begin).shift(self.some.stamps)

    def scaling(self, delay: float, clock: float) -> Scaling:
        """Return the attitudes of gyroscopes whose scale is wrong, for a delay and a clock."""
        if self._scaling is None or self._scaling[0] != (delay, clock):
            scaling = Scaling(self.truth, self.shift(delay, clock))
            self._scaling = (delay, clock), scaling
        return self._scaling[1]

    def residuals(self, offset: Offset) -> tuple[Real, Real, NDArray[np.bool_]]:
        """Return q_est, the model of it, and the mask of those known."""
        exact, _, known = self.exact(offset.delay, offset.clock, offset.scale)
        world = offset.turn_world(self.some.stamps)
        model = compose(compose(world, exact), offset.turn_body(self.some.stamps))
        return self.some.orientations, model, known

    def cost(self, offset: Offset) -> float:
        """Return the mean square of the distances of quaternions."""
        q, model, known = self.residuals(offset)
        if known.sum() < max(2, len(known) // 2):
            return np.inf
        return float((subtract(q[known], model[known]) ** 2).sum(axis=1).mean())

    @cached_property
    def fastest(self) -> float:
        """Largest angular velocity of the motion in rad/s."""
        return float(np.linalg.norm(self.exact(0.0)[1], axis=1).max(initial=0.0))

    @property
    def rounding(self) -> float:
        """Mean square of errors that are rounding: of numbers, and of stamps to whole ns."""
        return ROUNDING + (self.fastest / NANOSECONDS) ** 2

    def find_best(self, delay: bool, drift: bool) -> Offset:
        """Return the simplest explanation of those that leave least."""
        found = self.find_candidates(delay, drift)
        costs = [self.cost(each) for each in found]
        limit = WORTHWHILE * min(costs) + self.rounding
        good = (each for each, cost in zip(found, costs, strict=True) if cost <= limit)
        return min(good, key=lambda each: (bool(each.drift), abs(each.delay)))

    def find_candidates(self, delay: bool, drift: bool) -> list[Offset]:
        """Return explanations without and, if they may be looked for, with a delay and a drift."""
        found = [self.start(0.0)]
        if delay:
            found += [self._refine(each, DELAY) for each in self.search_delays(0.0)]
        if not drift:
            return found
        found += [self._refine(each, *((DELAY,) if each.delay else ()), DRIFT) for each in found]
        if min(map(self.cost, found)) > self.rounding:  # a drift may have turned the heading far
            found.append(self._refine(self.find_drift(), DRIFT))
            if delay:
                late = self.search_delays(found[-1].drift)
                found += [self._refine(each, DELAY, DRIFT) for each in late]
        return found

    def start(self, delay: float, drift: float = 0.0) -> Offset:
        """Return the best rotations for a delay and a drift."""
        still = replace(NONE, delay=delay, drift=drift, begin=int(self.some.stamps[0]))
        exact, _, known = self.exact(delay)
        if not self.turns or known.sum() < 2:
            return still
        turned = still.turn_world(self.some.stamps[known])
        q, exact = compose(invert(turned), self.some.orientations[known]), exact[known]
        if "rotations" in self.hidden:  # the world's alone: the body's are as well the identity
            left = compose(q, invert(exact))
            world = np.linalg.eigh(left.T @ left)[1][:, -1]
            return self._refine(replace(still, world=world))
        found = fit_rotations(q, exact)
        return replace(still, world=found.world, body=found.body)

    def find_drift(self) -> Offset:
        """Return the best drift with its rotations, without a delay."""
        step = GRID_STEP / self.seconds[-1]
        count = int(2 * np.pi * MOST_TURNS / GRID_STEP)
        return next(self._search(lambda drift: self.start(0.0, drift), step * count, count))

    def search_delays(self, drift: float) -> Iterator[Offset]:
        """Yield the best delays with their rotations, for a drift."""
        count = min(max(MAX_DELAY * self.fastest / GRID_STEP, 10), MOST_DELAYS)
        yield from self._search(lambda delay: self.start(delay, drift), MAX_DELAY, int(count))

    def _search(
        self, start: Callable[[float], Offset], most: float, count: int
    ) -> Iterator[Offset]:
        """Yield the best of some valleys of a grid from -most to most; the best valley first."""

        def cost(x: float) -> float:
            return self.cost(start(float(x)))

        tried = np.linspace(-most, most, 2 * count + 1)
        costs = np.array([cost(each) for each in tried])
        for k in find_valleys(costs, CANDIDATES):
            bounds = float(tried[max(k - 1, 0)]), float(tried[min(k + 1, 2 * count)])
            # The rotations follow from each number that is tried, which is robust.
            found = minimize_scalar(cost, bounds=bounds, method="bounded", options={"xatol": FINE})
            yield start(float(found.x))

    def _refine(self, offset: Offset, *more: int) -> Offset:
        """Return the least squares near an offset, in the rotations and in other columns."""
        return self.refine(offset, [*self.turns, *more])

    def refine(self, offset: Offset, free: list[int]) -> Offset:
        """Return the least squares near an offset, in the columns that are free."""
        best, cost = offset, self.cost(offset)
        for _ in range(ITERATIONS):
            step = np.zeros(COLUMNS)
            if free:
                step[free] = self._solve(best, free)
            moved = (_move(best, step * part, self.most) for part in STEPS)
            tried = ((each, self.cost(each)) for each in moved)
            found = next(((each, new) for each, new in tried if new < cost), None)
            if found is None:
                break
            best, gain, cost = found[0], cost - found[1], found[1]
            if gain < ENOUGH * cost:
                break
        return best

    def _solve(self, offset: Offset, free: list[int]) -> Real:
        q, model, known = self.residuals(offset)
        left = to_rotation(compose(q[known], invert(model[known]))).as_rotvec().ravel()
        columns = self.derive(offset, SCALE in free)[:, free]
        norms = np.linalg.norm(columns, axis=0)
        norms[norms == 0] = 1.0
        return np.asarray(np.linalg.lstsq(columns / norms, left, rcond=RANK)[0] / norms)

    def derive(self, offset: Offset, with_scale: bool = False) -> Real:
        """Return derivatives of the model's rotation vectors in the world frame, (3 n, 11)."""
        exact, rates, known = self.exact(offset.delay, offset.clock, offset.scale)
        world = offset.turn_world(self.some.stamps)[known]
        turned = compose(world, exact[known])
        columns = np.zeros((int(known.sum()), 3, COLUMNS))
        model = compose(turned, offset.turn_body(self.some.stamps)[known])
        drifted = compose(world, invert(offset.world))
        columns[:, :, :3] = to_rotation(drifted).as_matrix()
        columns[:, :, 3:6] = to_rotation(model).as_matrix()
        columns[:, :, DELAY] = -to_rotation(turned).apply(rates[known])
        seconds = self.seconds[known]
        columns[:, :, CLOCK] = columns[:, :, DELAY] * seconds[:, np.newaxis]
        columns[:, 2, DRIFT] = seconds
        columns[:, :, SPIN] = to_rotation(turned).as_matrix()[:, :, 2] * seconds[:, np.newaxis]
        if with_scale:
            turned_by = self.scaling(offset.delay, offset.clock).derive(offset.scale)[known]
            columns[:, :, SCALE] = to_rotation(world).apply(turned_by)
        return columns.reshape(-1, COLUMNS)

    def find_hidden(self) -> list[str]:
        """Return what the motion cannot show, from the rank of the derivatives."""
        columns = self.derive(replace(NONE, begin=int(self.some.stamps[0])))
        hidden = []
        if len(self._null_space(columns[:, ROTATIONS])):
            hidden.append("rotations")
        for name, place in (("delay", DELAY), ("drift", DRIFT)):
            chosen = [*self.turns, place]
            if np.abs(self._null_space(columns[:, chosen])[:, -1]).max(initial=0.0) > VISIBLE:
                hidden.append(name)
        return hidden

    def loses_delay(self, best: Offset) -> bool:
        """Return True if what is left, as noise, would change the delay by more than its bound.

        The delay moves the estimates by its column of derivatives; what the other columns can do as
        well does not show it.
        """
        others = [*self.turns, *((DRIFT,) if best.drift else ())]
        columns = self.derive(best)
        own, known = columns[:, DELAY], columns[:, others]
        shown = own - known @ np.linalg.lstsq(known, own, rcond=RANK)[0] if others else own
        noise = np.sqrt(4 * self.cost(best) / 3)  # in each of three components
        return bool(SIGMAS * noise > MAX_DELAY * np.linalg.norm(shown))

    @staticmethod
    def _null_space(columns: Real) -> Real:
        """Return the directions that change nothing, (k, m), of columns scaled to norm 1."""
        norms = np.linalg.norm(columns, axis=0)
        _, sizes, directions = np.linalg.svd(
            columns / np.where(norms > 0, norms, 1.0), full_matrices=False
        )
        return np.asarray(directions[sizes <= RANK * sizes[0]])


def _move(offset: Offset, step: Real, most: float) -> Offset:
    """Return the offset changed by a step in its columns; a delay stays within its bound."""
    world = compose(from_vector(step[:3]), offset.world)
    delay = float(np.clip(offset.delay + step[DELAY], -most, most))
    body = compose(offset.body, from_vector(step[3:6]))
    return replace(
        offset,
        world=world,
        body=body,
        delay=delay,
        drift=offset.drift + float(step[DRIFT]),
        clock=offset.clock + float(step[CLOCK]),
        spin=offset.spin + float(step[SPIN]),
        scale=offset.scale + float(step[SCALE]),
    )
