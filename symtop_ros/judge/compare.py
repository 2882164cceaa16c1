"""Errors of estimates, and the constant rotation and delay behind them.

An estimate is modelled as q_est(t) = W q(t - delay) M with constant rotations W of the world (a
heading that no gyroscope knows) and M of the body (how the sensor is mounted).
"""

import warnings
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

from symtop_ros.arrays import Real
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.truth import Truth
from symtop_ros.quaternions import compose, invert
from symtop_ros.wire.layout import NANOSECONDS

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
SAMPLES = 500  # estimates that a fit of offset and delay takes, spread over the run
MAX_DELAY = 0.1  # s
# Delays are tried in steps in which the fastest turn is so many rad; the best one is refined.
GRID_STEP = 0.5  # rad
MOST_DELAYS = 2001
WORTHWHILE = 1.001  # a delay counts if it makes the mean square smaller by this factor
ROUNDING = 1e-30  # mean square of errors that are rounding
PERCENTILES = (50, 90, 99, 100)
WINDOWS = 10  # of the run, for the growth of the error


@dataclass(frozen=True, eq=False)
class Offset:
    """A constant rotation of the world and one of the body, and a delay."""

    # quaternions w, x, y, z
    world: Real
    body: Real
    delay: float = 0.0  # time in s by which the estimates are late

    @property
    def angles(self) -> tuple[float, float]:
        """Angles of both rotations in rad."""
        return _angle(self.world), _angle(self.body)


NONE = Offset(IDENTITY, IDENTITY)


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of estimates at their stamps."""

    stamps: NDArray[np.int64]  # in ns
    total: Real  # angle of the rotation that would correct the attitude, in rad
    tilt: Real  # its part that turns the vertical (swing), in rad
    heading: Real  # its part about the vertical (twist), in rad, with its sign
    rate: Real | None  # |omega_est - omega| in rad/s
    unknown: int  # estimates at stamps of which the exact motion is not known

    @property
    def seconds(self) -> Real:
        """Times since the first estimate in s, (n,)."""
        return (self.stamps - self.stamps[:1]) / NANOSECONDS

    def growth(self) -> Real:
        """Return the root mean square of the error in each tenth of the run, (10,), in rad."""
        span = max(int(self.stamps[-1] - self.stamps[0]), 1)
        tenths = (self.stamps - self.stamps[0]) * WINDOWS // (span + 1)
        sums = np.bincount(tenths, self.total**2, WINDOWS)
        counts = np.bincount(tenths, minlength=WINDOWS)
        with np.errstate(invalid="ignore"):
            return np.asarray(np.sqrt(sums / counts))


def compare(estimates: Estimates, truth: Truth, offset: Offset = NONE) -> Errors:
    """Return the errors of estimates after an offset and its delay are removed."""
    stamps = estimates.stamps - round(offset.delay * NANOSECONDS)
    exact, rates, known = truth.states_at(stamps)
    chosen, exact, rates = estimates.select(known), exact[known], rates[known]
    q = compose(compose(invert(offset.world), chosen.orientations), invert(offset.body))
    wrong = compose(q, invert(exact))
    # |q - exact| is 2 sin(angle/4). An arccosine of their product would lose half of the digits.
    sine = np.linalg.norm(_subtract(q, exact), axis=1) / 2
    total = 4 * np.arcsin(np.minimum(sine, 1.0))
    w, x, y, z = wrong.T
    tilt = 2 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
    heading = _wrap(2 * np.arctan2(z, w))
    rate = None
    if chosen.angular_velocities is not None:
        turned = _to_rotation(offset.body).apply(chosen.angular_velocities)
        rate = np.linalg.norm(turned - rates, axis=1)
    return Errors(chosen.stamps, total, tilt, heading, rate, int((~known).sum()))


def find_offset(
    estimates: Estimates, truth: Truth, *, rotations: bool = True, delay: bool = True
) -> Offset:
    """Return the constant rotations and the delay that explain most of the errors.

    For each delay the rotations follow by least squares (Kabsch 1976, in four dimensions). All
    delays up to 0.1 s are tried, since a spinning top repeats itself with each turn.
    """
    every = max(1, len(estimates) // SAMPLES)
    some = estimates.select(np.arange(len(estimates)) % every == 0)
    if not len(some):
        return NONE

    def fit(seconds: float) -> tuple[float, Offset]:
        exact, _, known = truth.states_at(some.stamps - round(seconds * NANOSECONDS))
        q, exact = some.orientations[known], exact[known]
        if len(q) < max(2, len(some) // 2):
            return np.inf, NONE
        found = _fit_rotations(q, exact) if rotations else NONE
        modelled = compose(compose(found.world, exact), found.body)
        cost = float((_subtract(q, modelled) ** 2).sum(axis=1).mean())
        return cost, replace(found, delay=seconds)

    if not delay:
        return fit(0.0)[1]
    fastest = float(np.abs(truth.states_at(some.stamps)[1]).max(initial=0.0))
    count = min(max(2 * MAX_DELAY * fastest / GRID_STEP, 21), MOST_DELAYS)
    tried = np.linspace(-MAX_DELAY, MAX_DELAY, int(count))
    best = tried[int(np.argmin([fit(each)[0] for each in tried.tolist()]))]
    width = tried[1] - tried[0]
    refined = minimize_scalar(
        lambda each: fit(float(each))[0],
        bounds=(best - width, best + width),
        method="bounded",
        options={"xatol": 1e-9},
    )
    (cost, late), (without, none) = fit(float(refined.x)), fit(0.0)
    return none if without <= WORTHWHILE * cost + ROUNDING else late


def _fit_rotations(q: Real, exact: Real) -> Offset:
    """Return the rotations W and M for which W exact M is nearest to q.

    Both together are one rotation of the four components of a quaternion, found by Kabsch's method
    (a singular value decomposition). The signs of the quaternions follow from a first guess.
    """
    guess = _guess_rotations(q, exact)
    images = compose(compose(guess.world, exact), guess.body)
    signs = np.where((images * q).sum(axis=1) < 0, -1.0, 1.0)
    u, _, vt = np.linalg.svd((q * signs[:, np.newaxis]).T @ exact)
    u[:, -1] *= np.sign(np.linalg.det(u @ vt))  # a rotation, not a reflection
    # The images of 1, i, j, k: (W i M) (W 1 M)^-1 = W i W^-1 is a column of W's matrix.
    images = (u @ vt).T
    columns = compose(images[1:], invert(images[0]))[:, 1:]
    world = _to_quaternion(Rotation.from_matrix(columns.T))
    body = compose(invert(world), images[0])
    return Offset(world, body * np.copysign(1.0, body[0]))


def _guess_rotations(q: Real, exact: Real) -> Offset:
    """Return W and M by a way that does not ask for the signs of the quaternions.

    The turns from one estimate to the next have the same angles as the exact ones, about axes that
    M has turned (the hand-eye problem, Park and Martin 1994). W is then a mean of rotations, the
    eigenvector of the largest eigenvalue (Markley et al. 2007).
    """
    ours = _to_rotation(compose(invert(q[:-1]), q[1:])).as_rotvec()
    theirs = _to_rotation(compose(invert(exact[:-1]), exact[1:])).as_rotvec()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a top at rest leaves M open
        body = _to_quaternion(Rotation.align_vectors(theirs, ours)[0])
    left = compose(q, invert(compose(exact, body)))
    return Offset(np.linalg.eigh(left.T @ left)[1][:, -1], body)


def _to_rotation(q: Real) -> Rotation:
    return Rotation.from_quat(q[..., [1, 2, 3, 0]])


def _to_quaternion(rotation: Rotation) -> Real:
    """Return w, x, y, z with w >= 0."""
    x, y, z, w = rotation.as_quat()
    q: Real = np.array((w, x, y, z)) * np.copysign(1.0, w)
    return q


def _subtract(q: Real, p: Real) -> Real:
    """Return q - p, or q + p where that is smaller: both signs are the same rotation."""
    return q - np.where((q * p).sum(axis=1, keepdims=True) < 0, -p, p)


def _angle(q: Real) -> float:
    return float(2 * np.arctan2(np.linalg.norm(q[1:]), abs(q[0])))


def _wrap(angle: Real) -> Real:
    return np.asarray(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))
