"""Starts of the search for records of pixels, without a guess of the camera.

Without perspective a picture of the axis is linear in it, (u, v) = c + M e. So c and M, of any
camera, are linear least squares for each motion (variable projection, Golub and Pereyra 1973), and
five numbers are left: Mgl/Ix, p_psi/Ix, and the tilt and its rates at the start. Phi can be zero,
because the azimuth of the camera is free, and Mgl and p_psi positive, because its mirror images are
tried. Motions of many shapes are scaled to the frequencies of the record; the best of them are
improved together.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.signal import find_peaks
from scipy.signal.windows import blackmanharris

from symtop_ros.base.arrays import Real, compose
from symtop_ros.physics import Motions, State, Top
from symtop_ros.truth.fit.model import Model, find_axis
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.starts import Starts, fill

SHAPES = 250  # motions whose nutation is scaled to each frequency
RATES = 20  # frequencies from the slowest to the fastest, besides those of the spectrum
PEAKS = 6  # peaks of a spectrum that are tried
PAD = 8  # factor by which padding with zeros makes a spectrum finer
IMPROVED, STEPS = 2, 20  # motions of a frequency that are improved, and how often
KEPT = 16
SAME = 0.02  # relative difference of Mgl/Ix and p_psi/Ix below which two motions are one
ROWS = 120  # rows of a part, at which motions are compared
DELTA = 1e-6  # step of differences, in rad or relative to a rate
# part of a column's squares that is added: two columns may be equal, as without nutation
RIDGE = 1e-10
DAMPING = 1e-3  # of Levenberg and Marquardt, at the start
FASTEST = 30.0  # p_psi/sqrt(Ix Mgl)


@dataclass(frozen=True, eq=False)
class Pictures:
    """Points (n, 2) of a picture at times from zero, and the pivot if it is known."""

    times: Real
    points: Real
    pivot: Real | None

    def see(self, y: Real) -> Real:
        """Return the columns (k, n, 3 or 4) from which pictures of motions (k, 5) are made."""
        axis = find_axis(make_motions(y).at(self.times).orientation)
        if self.pivot is not None:
            return axis
        return np.concatenate([axis, np.ones((*axis.shape[:2], 1))], axis=2)

    def fit_cameras(self, columns: Real) -> Real:
        """Return the cameras (k, 3 or 4, 2) that show columns (k, n, 3 or 4) best."""
        turned = columns.swapaxes(1, 2)
        normal = turned @ columns
        size = np.trace(normal, axis1=1, axis2=2)[:, np.newaxis, np.newaxis]
        seen = self.points if self.pivot is None else self.points - self.pivot
        return np.linalg.solve(normal + RIDGE * size * np.eye(normal.shape[1]), turned @ seen)

    def find_residuals(self, y: Real) -> Real:
        """Return the residuals (k, 2 n) of motions (k, 5) with the best camera for each."""
        columns = self.see(y)
        seen = self.points if self.pivot is None else self.points - self.pivot
        left = columns @ self.fit_cameras(columns) - seen
        return left.reshape(len(y), -1)


def make_motions(y: Real) -> Motions:
    """Return motions of Mgl/Ix, p_psi/Ix, theta, theta' and phi' sin(theta), with phi = 0."""
    weight, p, theta, tilting, turning = y.T
    nothing = np.zeros(len(y))
    q = np.stack([np.cos(theta / 2), np.sin(theta / 2), nothing, nothing], axis=1)
    top = Top(np.ones(len(y)), np.ones(len(y)), weight)
    return Motions(top, State(q, np.stack([tilting, turning, p], axis=1)))


def list_camera_starts(part: Record) -> Iterator[Starts]:
    """Yield the motions, with their cameras, that show a part of a record of pixels best."""
    rows = np.unique(np.linspace(0, len(part) - 1, ROWS).astype(int))
    given = part.camera
    pivot = np.array([given["u"], given["v"]]) if "u" in given and "v" in given else None
    pictures = Pictures((part.times - part.times[0])[rows], part.values[rows], pivot)
    y = np.concatenate([choose_shapes(pictures, rate) for rate in list_rates(part)])
    y = improve_all(pictures, y)
    costs = (pictures.find_residuals(y) ** 2).sum(axis=1)
    best = choose_different(y[np.argsort(costs)])
    for each, camera in zip(best, pictures.fit_cameras(pictures.see(best)), strict=True):
        yield fill_camera_start(part, each, camera)


def choose_shapes(pictures: Pictures, rate: float) -> Real:
    """Return the best shapes (k, 5) whose nutation has an angular frequency.

    They are chosen for each frequency alone: among the shapes of all frequencies, those without a
    nutation would be best if the nutation is small.
    """
    y = scale(draw_shapes(), rate)
    costs = (pictures.find_residuals(y) ** 2).sum(axis=1)
    return y[np.argsort(costs)[:IMPROVED]]


def choose_different(y: Real) -> Real:
    """Return the motions (k, 5) without repetitions of the same minimum, in their order."""
    scales, kept = find_scales(y), [0]
    for k in range(1, len(y)):
        moved = np.abs(y[kept] - y[k])[:, :2] / scales[k, :2]
        if (moved.max(axis=1) > SAME).all():
            kept.append(k)
    return y[kept[:KEPT]]


@cache
def draw_shapes() -> tuple[Real, Real]:
    """Return motions (k, 5) for Mgl/Ix = 1, and the angular frequencies (k,) of their nutation."""
    draw = np.random.default_rng(1)
    p = np.geomspace(0.1, FASTEST, SHAPES)
    theta = np.arccos(draw.permutation(np.linspace(-0.97, 0.97, SHAPES)))
    size = draw.permutation(np.geomspace(0.05, 3.0, SHAPES))[:, np.newaxis]
    rates = size * draw.normal(size=(SHAPES, 2))
    y = np.column_stack([np.ones(SHAPES), p, theta, rates])
    return y, 2 * np.pi / np.asarray(make_motions(y).nutation_period)


def scale(shapes: tuple[Real, Real], rate: float) -> Real:
    """Return shapes (k, 5) as motions whose nutation has an angular frequency."""
    y, own = shapes
    faster = rate / own
    return np.column_stack(
        [y[:, 0] * faster**2, y[:, 1] * faster, y[:, 2], y[:, 3:] * faster[:, np.newaxis]]
    )


def list_rates(part: Record) -> Real:
    """Return angular frequencies of a nutation: from slow to fast, and of the spectrum.

    A nutation may be a hundred times smaller than the precession. This window makes the sidelobes
    of the precession smaller than the noise.
    """
    times = np.arange(part.times[0], part.times[-1], part.step)
    points = np.stack([np.interp(times, part.times, each) for each in part.values.T], axis=1)
    waves = (points - points.mean(axis=0)) * blackmanharris(len(points))[:, np.newaxis]
    power = (np.abs(np.fft.rfft(waves, PAD * len(waves), axis=0)) ** 2).sum(axis=1)
    frequencies = 2 * np.pi * np.fft.rfftfreq(PAD * len(waves), part.step)
    tops = find_peaks(power)[0]
    peaks = frequencies[tops[np.argsort(power[tops])[::-1][:PEAKS]]]
    both = np.abs(np.subtract.outer(peaks, peaks))[np.triu_indices(len(peaks), 1)]
    slowest, fastest = np.pi / part.seconds, np.pi / part.step
    found = np.concatenate([np.geomspace(slowest, fastest, RATES), peaks, both])
    return np.unique(found[(found >= slowest) & (found <= 1.2 * fastest)])


def improve_all(pictures: Pictures, y: Real) -> Real:
    """Return motions (k, 5) after some steps of Levenberg and Marquardt, all at once.

    SciPy's `least_squares` begins at one motion and asks for six at a time. From the same starts it
    takes 7 times as long, and a whole fit twice as long. In 12 pairs of records 1207 starts of
    `least_squares` and 1148 starts of this function ended within a tenth of the best cost; each of
    the two had one wrong minimum.
    """
    damping = np.full(len(y), DAMPING)
    left = pictures.find_residuals(y)
    for _ in range(STEPS):
        scales = find_scales(y)
        slopes = find_slopes(pictures, y, left, scales)
        normal = slopes @ slopes.swapaxes(1, 2)
        size = np.diagonal(normal, axis1=1, axis2=2)
        damped = damping[:, np.newaxis] * (size + RIDGE * size.sum(axis=1, keepdims=True)) + 1e-300
        normal = normal + damped[:, :, np.newaxis] * np.eye(5)
        step = np.linalg.solve(normal, (slopes @ left[:, :, np.newaxis]))[..., 0]
        moved = y - np.clip(step, -0.5, 0.5) * scales
        new = pictures.find_residuals(moved)
        is_better = (new**2).sum(axis=1) < (left**2).sum(axis=1)
        y, left = np.where(is_better[:, None], moved, y), np.where(is_better[:, None], new, left)
        damping = np.where(is_better, damping / 5, damping * 5)
    return y


def find_scales(y: Real) -> Real:
    """Return the sizes (k, 5) of numbers: rates are those of the motion."""
    rate = np.sqrt(np.abs(y[:, 0])) + np.abs(y[:, [1, 3, 4]]).max(axis=1)
    return np.stack(
        [np.maximum(np.abs(y[:, 0]), 0.01 * rate**2), rate, 0 * rate + 1, rate, rate], 1
    )


def find_slopes(pictures: Pictures, y: Real, left: Real, scales: Real) -> Real:
    """Return the derivatives (k, 5, 2 n) of residuals by numbers in their scales."""
    moved = y[:, np.newaxis] + DELTA * scales[:, :, np.newaxis] * np.eye(5)
    found = pictures.find_residuals(moved.reshape(-1, 5)).reshape(len(y), 5, -1)
    return (found - left[:, np.newaxis]) / DELTA


def fill_camera_start(part: Record, y: Real, camera: Real) -> Starts:
    """Return the start of a motion (5,) and of the camera nearest to a linear map (3 or 4, 2)."""
    left, sizes, right = np.linalg.svd(camera[:3].T, full_matrices=False)
    azimuth, seen = read_view(left @ right)
    seen |= {"log_scale": float(np.log(sizes.mean() + 1e-300))}
    if len(camera) > 3:
        seen |= dict(zip("uv", camera[3].tolist(), strict=True))
    weight, p, theta, wx, wy = y.tolist()
    half, turn = np.array([theta, azimuth]) / 2
    cos, sin = np.cos(turn), np.sin(turn)
    reference = compose(
        np.array([cos, 0.0, 0.0, sin]), np.array([np.cos(half), np.sin(half), 0.0, 0.0])
    )
    model = Model(part, reference)
    named = {"Mgl/Ix": weight, "p_psi/Ix": p, "wx": wx, "wy": wy, **seen}
    return Starts(model, fill(model, named)[np.newaxis])


def read_view(view: Real) -> tuple[float, dict[str, float]]:
    """Return the azimuth that a camera with rows (2, 3) at right angles sees, and its angles."""
    roll = float(np.arctan2(-view[0, 2], view[1, 2]))
    cos, sin = np.cos(roll), np.sin(roll)
    right, high = np.array([[cos, sin], [-sin, cos]]) @ view
    azimuth = float(np.arctan2(-right[1], right[0]))
    above = high[0] * np.sin(azimuth) + high[1] * np.cos(azimuth)
    return azimuth, {"roll": roll, "elevation": float(np.arctan2(above, high[2]))}
