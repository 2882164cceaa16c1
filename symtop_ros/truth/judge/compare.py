"""Errors of estimates, with or without what explains them.

An estimate is modelled as q_est(t) = D(t) W q(t - delay) M with constant rotations W of the world
(a heading that no gyroscope knows) and M of the body (how the sensor is mounted), and a rotation
D(t) about the vertical that grows steadily (a drift of the heading). A clock that runs fast makes
the delay grow, and a gyroscope whose scale is wrong along the axis turns the body about it.

A gyroscope alone whose scale is wrong by the same part k along each axis gives, integrated, the
attitude D(t) q(t): from q' = q omega/2 and (D q)' = D q (1 + k) omega/2 follows
D' = D (k omega_world)/2. So D is integrated along angular velocities in the world frame, which
change by precession and nutation only and not with the spin (`Scaling`).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real, Stamps, compose, invert, rotate, split
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.testset.score import measure_angles
from symtop_ros.truth.topics.estimates import Estimates

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
PERCENTILES = (50, 90, 99, 100)
WINDOWS = 10  # of the run, for the growth of the error
STEP = 2_000_000  # ns; nutation turns by 0.1 rad in it
MOST_STEPS = 100_000  # a longer run is not integrated
GAUSS = (0.5 - 3**0.5 / 6, 0.5 + 3**0.5 / 6)  # places in a step


@dataclass(frozen=True, eq=False)
class Offset:
    """Constant rotations of the world and of the body, a delay, and a drift of the heading."""

    # quaternions w, x, y, z
    world: Real
    body: Real
    delay: float = 0.0  # time in s by which the estimates are late
    drift: float = 0.0  # rate in rad/s about the vertical of the world
    begin: int = 0  # stamp in ns at which nothing has drifted yet
    clock: float = 0.0  # growth of the delay in s per s
    spin: float = 0.0  # rate in rad/s about the axis of the body
    scale: float = 0.0  # part by which the scale of a gyroscope is too large; see `Scaling`

    def turn_world(self, stamps: Stamps) -> Real:
        """Return the rotations of the world, D(t) W, at stamps, (n, 4)."""
        return _turn_steadily(self.drift, stamps - self.begin, self.world)

    def turn_body(self, stamps: Stamps) -> Real:
        """Return the rotations of the body at stamps, (n, 4)."""
        return _turn_steadily(self.spin, stamps - self.begin, self.body)

    def shift(self, stamps: Stamps) -> Stamps:
        """Return the stamps in ns of the exact states, (n,)."""
        late = self.delay * NANOSECONDS + self.clock * (stamps - self.begin)
        return np.asarray(stamps - np.rint(late).astype(np.int64))

    @property
    def angles(self) -> tuple[float, ...]:
        """Angles of both rotations in rad."""
        both = self.world, self.body
        return tuple(float(2 * np.arctan2(np.linalg.norm(q[1:]), abs(q[0]))) for q in both)


NONE = Offset(IDENTITY, IDENTITY)


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of estimates at their stamps."""

    stamps: Stamps  # in ns
    total: Real  # angle of the rotation that would correct the attitude, in rad
    tilt: Real  # its part that turns the vertical (swing), in rad
    heading: Real  # its part about the vertical (twist), in rad, with its sign
    rate: Real | None  # |omega_est - omega| in rad/s
    unknown: int  # estimates out of reach of the integration of the run
    late: int = 0  # estimates after the last sample of the run
    early: int = 0  # estimates before the run
    unjudged: int = 0  # estimates where the log does not say which motion holds

    @property
    def seconds(self) -> Real:
        """Times since the first estimate in s, (n,)."""
        return (self.stamps - self.stamps[:1]) / NANOSECONDS

    @property
    def quantities(self) -> dict[str, Real]:
        """Sizes of all errors, (n,), by the names that JSON has."""
        rates = {} if self.rate is None else {"angular_velocity": self.rate}
        return {
            "attitude": self.total,
            "tilt": self.tilt,
            "heading": np.abs(self.heading),
            **rates,
        }

    def growth(self) -> Real:
        """Return the root mean square of the error in each tenth of the run, (10,), in rad."""
        # As parts of the run: ten times a span of 30 years of ns is beyond 64 bits.
        parts = self.seconds / max(float(self.seconds[-1]), 1e-9)
        tenths = np.minimum((WINDOWS * parts).astype(np.int64), WINDOWS - 1)
        sums = np.bincount(tenths, self.total**2, WINDOWS)
        counts = np.bincount(tenths, minlength=WINDOWS)
        return np.asarray(np.sqrt(sums / np.where(counts, counts, np.nan)))


def compare(estimates: Estimates, truth: Truth, offset: Offset = NONE) -> Errors:
    """Return the errors of estimates after an offset is removed."""
    stamps = offset.shift(estimates.stamps)
    chosen, exact, rates = find_exact(estimates, truth, offset)
    q, body = undo(chosen, offset), offset.turn_body(chosen.stamps)
    total = measure_angles(q, exact, np.zeros(4))
    w, x, y, z = compose(q, invert(exact)).T
    tilt = 2 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
    heading = 2 * np.arctan2(z, w)
    heading -= 2 * np.pi * np.rint(heading / (2 * np.pi))
    rate = None
    if chosen.angular_velocities is not None:
        a, b, c, d = split(body)
        rate = np.linalg.norm(rotate(a, b, c, d, chosen.angular_velocities) - rates, axis=1)
    early, late = truth.count_outside(stamps)
    unjudged = int(truth.find_unjudged(stamps).sum())
    unknown = len(stamps) - len(chosen) - late - early - unjudged
    return Errors(chosen.stamps, total, tilt, heading, rate, unknown, late, early, unjudged)


def find_exact(
    estimates: Estimates, truth: Truth, offset: Offset = NONE
) -> tuple[Estimates, Real, Real]:
    """Return the estimates that are known, with exact attitudes (n, 4) and rates (n, 3)."""
    stamps = offset.shift(estimates.stamps)
    exact, rates, known = truth.states_at(stamps, estimates.of_sensor)
    return estimates.select(known), exact[known], rates[known]


def undo(estimates: Estimates, offset: Offset) -> Real:
    """Return the attitudes (n, 4) without the rotations of an offset."""
    world, body = offset.turn_world(estimates.stamps), offset.turn_body(estimates.stamps)
    return compose(compose(invert(world), estimates.orientations), invert(body))


def to_rotation(q: Real) -> Rotation:
    """Return the rotation of quaternions w, x, y, z, (..., 4)."""
    return Rotation.from_quat(q[..., [1, 2, 3, 0]])


def subtract(q: Real, p: Real) -> Real:
    """Return q - p, or q + p where that is smaller: both signs are the same rotation."""
    return q - np.where((q * p).sum(axis=1, keepdims=True) < 0, -p, p)


def _turn_steadily(rate: float, nanoseconds: Stamps, start: Real) -> Real:
    """Return a rotation followed by turns about z, (n, 4); most rates of the search are zero."""
    if not rate:
        return np.broadcast_to(start, (len(nanoseconds), 4))
    half = rate * nanoseconds / NANOSECONDS / 2
    zero = np.zeros(len(nanoseconds))
    return compose(np.stack((np.cos(half), zero, zero, np.sin(half)), axis=-1), start)


class Scaling:
    """The rotations D of each scale, at stamps (n,) in their order; the identity at the first."""

    def __init__(self, truth: Truth, stamps: Stamps) -> None:
        intervals = np.diff(stamps)
        counts = np.maximum(-(-intervals // STEP), 1)
        widths = np.repeat(intervals / counts, counts)
        self._ends = np.concatenate(([0], np.cumsum(counts)))
        within = np.arange(counts.sum()) - np.repeat(self._ends[:-1], counts)
        begins = np.repeat(stamps[:-1], counts) + within * widths
        early, late = (self._rates(truth, begins + part * widths) for part in GAUSS)
        seconds = widths[:, np.newaxis] / NANOSECONDS
        # Magnus' series of fourth order: the second term goes with the square of the scale.
        self._turns = (early + late) / 2 * seconds
        self._twists = 3**0.5 / 12 * np.cross(early, late) * seconds**2

    @staticmethod
    def _rates(truth: Truth, times: Real) -> Real:
        """Return the angular velocities in the world frame, (m, 3)."""
        q, omega, known = truth.states_at(np.rint(times).astype(np.int64))
        return np.asarray(to_rotation(q).apply(omega) * known[:, np.newaxis])

    def turn(self, scales: float | Real) -> Real:
        """Return the rotations D, (..., n, 4), for scales (...) that are wrong by these parts."""
        return self._path(scales)[..., self._ends, :]

    def derive(self, scale: float) -> Real:
        """Return the derivatives of D by the scale, as rotation vectors in the world, (n, 3)."""
        slopes = self._turns + 2 * scale * self._twists
        steps = to_rotation(self._path(scale)[:-1]).apply(slopes) if scale else slopes
        return np.asarray(np.vstack((np.zeros(3), np.cumsum(steps, axis=0)))[self._ends])

    def _path(self, scales: float | Real) -> Real:
        """Return the products of all steps up to each, (..., m + 1, 4)."""
        turns = np.multiply.outer(scales, self._turns)
        half = (turns + np.multiply.outer(np.square(scales), self._twists)) / 2
        angles = np.linalg.norm(half, axis=-1, keepdims=True)
        steps = np.concatenate((np.cos(angles), half * np.sinc(angles / np.pi)), axis=-1)
        first = np.broadcast_to(IDENTITY, (*np.shape(scales), 1, 4))
        return _accumulate(np.concatenate((first, steps), axis=-2))


def _accumulate(steps: Real) -> Real:
    """Return the products of the quaternions (..., m, 4) up to each of them.

    The quaternions are arranged in about as many rows as columns. First the products within all
    rows are formed together, then those of whole rows, by doubling their number, and finally both
    are multiplied.
    """
    count = steps.shape[-2]
    length = math.isqrt(count - 1) + 1
    square = np.broadcast_to(IDENTITY, (*steps.shape[:-2], length * length, 4)).copy()
    square[..., :count, :] = steps
    rows = square.reshape(*steps.shape[:-2], length, length, 4)
    for k in range(1, length):
        rows[..., k, :] = compose(rows[..., k - 1, :], rows[..., k, :])
    whole = rows[..., -1, :].copy()
    shift = 1
    while shift < length:
        whole[..., shift:, :] = compose(whole[..., :-shift, :], whole[..., shift:, :])
        shift *= 2
    rows[..., 1:, :, :] = compose(whole[..., :-1, np.newaxis, :], rows[..., 1:, :, :])
    return np.asarray(square[..., :count, :])
