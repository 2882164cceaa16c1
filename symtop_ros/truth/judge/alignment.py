"""Least squares of estimates: rotations, a delay, drifts, the rate of a clock, a scale."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Mask, Real, compose, find_rotation_vectors, invert
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.compare import NONE, Offset, Scaling, subtract, to_rotation
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.influence import find_influences
from symtop_ros.truth.residuals.residuals import Residuals
from symtop_ros.truth.topics.estimates import Estimates

SAMPLES = 500  # estimates that a search takes, spread over the run
MOST_DELAY = 0.5  # s
# Most steps of Gauss and Newton, which converge quadratically, and the part of the mean square that
# counts as no improvement.
ITERATIONS, ENOUGH = 30, 1e-6
STEPS = (1.0, 0.3, 0.1)  # parts of a step that are tried, until one is an improvement
ROUNDING = 1e-28  # mean square of errors that are rounding
# Columns of the derivatives: a rotation vector of the world and of the body, and these, which are
# rates about the vertical of the world (drift) and about the axis of the body (spin).
PARAMETERS = {"delay": 6, "drift": 7, "clock": 8, "spin": 9, "scale": 10}
DELAY, DRIFT, CLOCK, SPIN, SCALE = PARAMETERS.values()
COLUMNS = 11
SPEED_STEP = 500  # ns, in which a fast top turns by 0.1 mrad
GAP = 5.0  # medians of the steps between estimates; a longer step ends a run of noise
RANK = 1e-7  # singular values below this part of the largest are zero


@dataclass(eq=False)
class Alignment:
    """Some estimates, and the ways to compare them with the exact motion."""

    some: Estimates
    truth: Truth
    # the last motion and gyroscope, by delay, clock and scale
    _exact: dict[tuple[float, ...], tuple[Real, Mask]] = field(default_factory=dict)
    _scalings: dict[tuple[float, ...], Scaling] = field(default_factory=dict)
    # the last model: its cost is computed first, and its derivatives only if the cost is smaller
    _models: dict[Offset, tuple[Real, Real, Real]] = field(default_factory=dict)

    @cached_property
    def start(self) -> Offset:
        """The offset without any error, with times from the first estimate on."""
        return replace(NONE, begin=int(self.some.stamps[0]))

    def exact(self, offset: Offset) -> tuple[Real, Mask]:
        """Return the exact quaternions, with the scale of an offset, and which are known."""
        key = offset.delay, offset.clock, offset.scale
        if key not in self._exact:
            q, _, known = self.truth.states_at(offset.shift(self.some.stamps), self.some.of_sensor)
            q = compose(self.scaling(offset).turn(offset.scale), q) if offset.scale else q
            self._exact = {key: (q, known)}
        return self._exact[key]

    def scaling(self, offset: Offset) -> Scaling:
        """Return the attitudes of gyroscopes whose scale is wrong."""
        key = offset.delay, offset.clock
        if key not in self._scalings:
            self._scalings = {key: Scaling(self.truth, offset.shift(self.some.stamps))}
        return self._scalings[key]

    def model(self, offset: Offset) -> tuple[Real, Real, Real]:
        """Return the rotations W of the world, W exact, and the complete model W exact M."""
        if offset not in self._models:
            world = offset.turn_world(self.some.stamps)
            turned = compose(world, self.exact(offset)[0])
            model = compose(turned, offset.turn_body(self.some.stamps))
            self._models = {offset: (world, turned, model)}
        return self._models[offset]

    def residuals(self, offset: Offset) -> tuple[Real, Real]:
        """Return the known estimates, and what the model predicts for them."""
        known = self.exact(offset)[1]
        return self.some.orientations[known], self.model(offset)[2][known]

    def find_left(self, offset: Offset) -> Real:
        """Return the remaining errors as rotation vectors in the world, (n, 3)."""
        q, model = self.residuals(offset)
        return find_rotation_vectors(compose(q, invert(model)))

    def cost(self, offset: Offset) -> float:
        """Return the mean square of the distances of quaternions."""
        q, model = self.residuals(offset)
        enough = len(q) >= min(len(self.some), max(2, len(self.some) // 2))
        return float((subtract(q, model) ** 2).sum(axis=1).mean()) if enough else np.inf

    def cost_where(self, offset: Offset, known: Mask) -> float:
        """Return the cost among some estimates, given by a mask (n,).

        With a delay the exact states of the first estimates are unknown. So without a mask the
        costs of two offsets would be those of different estimates.
        """
        both = self.exact(offset)[1] & known
        left = subtract(self.some.orientations[both], self.model(offset)[2][both])
        return float((left**2).sum(axis=1).mean()) if both.any() else np.inf

    @property
    def seconds(self) -> float:
        """Time from the first to the last estimate in s."""
        return float(np.ptp(self.some.stamps)) / NANOSECONDS

    @cached_property
    def fastest(self) -> float:
        """Largest angular velocity of the motion in rad/s."""
        rates = self.truth.states_at(self.some.stamps, self.some.of_sensor)[1]
        return float(np.linalg.norm(rates, axis=1).max(initial=0.0))

    @property
    def rounding(self) -> float:
        """Mean square of errors that are rounding: of numbers, and of stamps to whole ns."""
        return ROUNDING + (self.fastest / NANOSECONDS) ** 2

    def refine(self, offset: Offset, free: list[int]) -> Offset:
        """Return the least squares near an offset, in the columns that are free."""
        best = offset
        cost = self.cost(offset)
        for _ in range(ITERATIONS if free else 0):
            columns = self.derive(best, free)
            step = np.zeros(COLUMNS)
            sizes = np.linalg.norm(columns, axis=0) + np.finfo(float).tiny
            left = self.find_left(best).ravel()
            step[free] = np.linalg.lstsq(columns / sizes, left, rcond=RANK)[0] / sizes
            tried = (move(best, step * part) for part in STEPS)
            found = ((each, new) for each in tried if (new := self.cost(each)) < cost)
            before, (best, cost) = cost, next(found, (best, cost))
            if not before - cost > ENOUGH * cost:
                break
        return best

    def derive(self, offset: Offset, free: list[int]) -> Real:
        """Return the derivatives of the model's rotation vectors in the world, (3 n, free)."""
        known = self.exact(offset)[1]
        world, turned, model = (part[known] for part in self.model(offset))
        seconds = (self.some.stamps[known] - offset.begin) / NANOSECONDS
        columns = np.zeros((len(seconds), 3, COLUMNS))
        columns[:, :, :3] = to_rotation(compose(world, invert(offset.world))).as_matrix()
        columns[:, :, 3:6] = to_rotation(model).as_matrix()
        if {DELAY, CLOCK} & {*free}:
            columns[:, :, DELAY] = -to_rotation(world).apply(self._find_speeds(offset)[known])
            columns[:, :, CLOCK] = columns[:, :, DELAY] * seconds[:, np.newaxis]
        columns[:, 2, DRIFT] = seconds
        columns[:, :, SPIN] = to_rotation(turned).as_matrix()[:, :, 2] * seconds[:, np.newaxis]
        if SCALE in free:
            turns = self.scaling(offset).derive(offset.scale)[known]
            columns[:, :, SCALE] = to_rotation(world).apply(turns)
        return np.asarray(columns.reshape(-1, COLUMNS)[:, free])

    def derive_frames(self, offset: Offset, free: list[int]) -> Iterator[tuple[Real, Real]]:
        """Yield derivatives (n, 3, free) and residuals (n, 3), in the world and in the body."""
        columns, left = self.derive_vectors(offset, free), self.find_left(offset)
        yield columns, left
        to_body = to_rotation(self.residuals(offset)[1]).inv().as_matrix()
        yield to_body @ columns, (to_body @ left[..., np.newaxis])[..., 0]

    def find_follows(self, offset: Offset) -> Mask:
        """Return True (n,) for known estimates that come soon after the one before."""
        stamps = self.some.stamps[self.exact(offset)[1]]
        steps = np.diff(stamps, prepend=stamps[:1])
        return np.asarray((steps <= GAP * np.median(steps)) & (np.arange(len(steps)) > 0))

    def derive_vectors(self, offset: Offset, free: list[int]) -> Real:
        """Return the derivatives as vectors, (n, 3, free)."""
        columns = self.derive(offset, free)
        return columns.reshape(len(columns) // 3, 3, len(free))

    def _find_speeds(self, offset: Offset) -> Real:
        """Return the angular velocities in the world, per second of the stamps.

        At the ends of the run they are set to zero, which has no effect on a delay.
        """
        stamps = offset.shift(self.some.stamps)
        of_sensor = self.some.of_sensor
        (earlier, _, begun), (later, _, goes_on) = (
            self.truth.states_at(stamps + step, of_sensor) for step in (-SPEED_STEP, SPEED_STEP)
        )
        moved = find_rotation_vectors(compose(later, invert(earlier)))
        moved[~(begun & goes_on)] = 0.0
        return moved * ((1 + offset.scale) * NANOSECONDS / (2 * SPEED_STEP))

    def hides(self, offset: Offset, others: list[int], place: int) -> bool:
        """Return whether other parameters have the same effect as a parameter, near an offset."""
        columns = self.derive(offset, [*others, place])
        sizes = np.linalg.norm(columns, axis=0) + np.finfo(float).tiny
        ranks = [
            np.linalg.matrix_rank(each, RANK * np.linalg.norm(each, 2)) if each.size else 0
            for each in ((columns / sizes)[:, :-1], columns / sizes)
        ]
        return bool(ranks[0] == ranks[1])

    def find_remainder(self, offset: Offset) -> Residuals:
        """Return the residuals of the known estimates with an offset."""
        q, model = self.residuals(offset)
        left = find_rotation_vectors(compose(q, invert(model)))
        body = to_rotation(model).inv().apply(left) if len(left) else left
        return Residuals((left, body), self.seconds)

    def find_influences(self, offset: Offset, free: list[int]) -> Real:
        """Return the changes of all columns, (n, 11), by each estimate."""
        columns = self.derive_vectors(offset, free)
        values = np.zeros((len(columns), COLUMNS))
        values[:, free] = find_influences(columns, self.find_left(offset))
        return values


def move(offset: Offset, step: Real) -> Offset:
    """Return the offset changed by a step in its columns; a delay stays within its bound."""
    moved = {name: getattr(offset, name) + float(step[k]) for name, k in PARAMETERS.items()}
    moved["delay"] = min(max(moved["delay"], -MOST_DELAY), MOST_DELAY)
    world, body = (Rotation.from_rotvec(each).as_quat() for each in (step[:3], step[3:6]))
    return replace(
        offset,
        world=compose(world[[3, 0, 1, 2]], offset.world),
        body=compose(offset.body, body[[3, 0, 1, 2]]),
        **moved,
    )
