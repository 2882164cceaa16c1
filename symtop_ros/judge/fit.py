"""Least squares of estimates: rotations, a delay, drifts, the rate of a clock, a scale."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real, Stamps, compose, find_rotation_vectors, invert
from symtop_ros.judge.causes.search import from_vector
from symtop_ros.judge.compare import NONE, Offset, Scaling, subtract, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.truth import Truth
from symtop_ros.wire.layout import NANOSECONDS

SAMPLES = 500  # estimates that a search takes, spread over the run
MOST_DELAY = 0.5  # s
ITERATIONS = 30  # of Gauss and Newton; they converge quadratically
STEPS = (1.0, 0.3, 0.1)  # parts of a step that are tried, until one is an improvement
ENOUGH = 1e-6  # part of the mean square; less is no improvement
ROUNDING = 1e-28  # mean square of errors that are rounding
# Columns of the derivatives: a rotation vector of the world and of the body, delay, and drift.
# The last three are the rate of the clock, a drift about the axis of the body, and the scale of a
# gyroscope.
ROTATIONS, DELAY, DRIFT, CLOCK, SPIN, SCALE = range(6), 6, 7, 8, 9, 10
COLUMNS = 11
SPEED_STEP = 500  # ns, in which a fast top turns by 0.1 mrad
# Singular values below this are zero. Those of steady motions are rounding, those of visible
# nutation are larger than its amplitude.
RANK = 1e-7
VISIBLE = 1e-3  # part of a parameter in what the motion hides
Exact = tuple[Real, Real, NDArray[np.bool_]]  # quaternions, rates, and the mask of those known


@dataclass(eq=False)
class Fit:
    """Some estimates, and the ways to compare them with the exact motion."""

    some: Estimates
    truth: Truth
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

    def refine(self, offset: Offset, free: list[int]) -> Offset:
        """Return the least squares near an offset, in the columns that are free."""
        best, cost = offset, self.cost(offset)
        for _ in range(ITERATIONS):
            step = np.zeros(COLUMNS)
            if free:
                step[free] = self._solve(best, free)
            moved = (_move(best, step * part) for part in STEPS)
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
        speeds = self._find_speeds(offset)
        exact, _, known = self.exact(offset.delay, offset.clock, offset.scale)
        world = offset.turn_world(self.some.stamps)[known]
        turned = compose(world, exact[known])
        columns = np.zeros((int(known.sum()), 3, COLUMNS))
        model = compose(turned, offset.turn_body(self.some.stamps)[known])
        drifted = compose(world, invert(offset.world))
        columns[:, :, :3] = to_rotation(drifted).as_matrix()
        columns[:, :, 3:6] = to_rotation(model).as_matrix()
        columns[:, :, DELAY] = -to_rotation(world).apply(speeds[known])
        seconds = self.seconds[known]
        columns[:, :, CLOCK] = columns[:, :, DELAY] * seconds[:, np.newaxis]
        columns[:, 2, DRIFT] = seconds
        columns[:, :, SPIN] = to_rotation(turned).as_matrix()[:, :, 2] * seconds[:, np.newaxis]
        if with_scale:
            turned_by = self.scaling(offset.delay, offset.clock).derive(offset.scale)[known]
            columns[:, :, SCALE] = to_rotation(world).apply(turned_by)
        return columns.reshape(-1, COLUMNS)

    def _find_speeds(self, offset: Offset) -> Real:
        """Return the angular velocities in the world by the stamps, not by a run's slower time.

        They are zero, which says nothing of a delay, at the ends of the run.
        """
        stamps, of_sensor = self.shift(offset.delay, offset.clock), self.some.of_sensor
        (earlier, _, begun), (later, _, goes_on) = (
            self.truth.states_at(stamps + step, of_sensor) for step in (-SPEED_STEP, SPEED_STEP)
        )
        moved = find_rotation_vectors(compose(later, invert(earlier)))
        moved[~(begun & goes_on)] = 0.0
        return moved * ((1 + offset.scale) * NANOSECONDS / (2 * SPEED_STEP))

    def hides(self, offset: Offset, others: list[int], place: int) -> bool:
        """Return whether a parameter near an offset changes nothing that others do not."""
        return self._hides(self.derive(offset)[:, [*others, place]])

    def _hides(self, columns: Real) -> bool:
        """Return whether the motion hides the last of the columns."""
        return bool(np.abs(self._null_space(columns)[:, -1]).max(initial=0.0) > VISIBLE)

    def find_deviations(self, offset: Offset, free: list[int]) -> Real:
        """Return the standard deviations of the columns, (11,), if what is left is noise.

        Noise of the same size in each of the three components; 0 in columns that are not free.
        """
        deviations, known = np.zeros(COLUMNS), int(self.residuals(offset)[2].sum())
        if free and 3 * known > len(free):
            columns = self.derive(offset, SCALE in free)[:, free]
            noise = 4 * self.cost(offset) * known / (3 * known - len(free))
            inverse = np.linalg.pinv(columns.T @ columns, hermitian=True)
            deviations[free] = np.sqrt(noise * np.diag(inverse))
        return deviations

    @staticmethod
    def _null_space(columns: Real) -> Real:
        """Return the directions that change nothing, (k, m), of columns scaled to norm 1."""
        norms = np.linalg.norm(columns, axis=0)
        _, sizes, directions = np.linalg.svd(
            columns / np.where(norms > 0, norms, 1.0), full_matrices=False
        )
        return np.asarray(directions[sizes <= RANK * sizes[0]])


def _move(offset: Offset, step: Real) -> Offset:
    """Return the offset changed by a step in its columns; a delay stays within its bound."""
    world = compose(from_vector(step[:3]), offset.world)
    delay = float(np.clip(offset.delay + step[DELAY], -MOST_DELAY, MOST_DELAY))
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
