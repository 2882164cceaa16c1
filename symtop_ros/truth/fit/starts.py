"""Starts of the search for records of an axis: by the constants of motion, and on a grid.

The vertical angular momentum (e x e')_z + (p_psi/Ix) e_z and the energy e'^2/2 + (Mgl/Ix) e_z are
constant along the axis e, and linear in what is looked for. Their derivatives need some samples in
a nutation; a grid of p_psi/Ix with the mean precession Mgl/p_psi does without.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.signal import savgol_filter
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real
from symtop_ros.physics import DEFAULT_GRAVITY
from symtop_ros.truth.fit.camera import CAMERA
from symtop_ros.truth.fit.model import (
    FORCE_BIASES,
    FRICTION,
    KICK,
    LENGTH,
    MOUNT,
    TURNS,
    Model,
    point_along,
)
from symtop_ros.truth.fit.record import Record

WIDTHS = (5, 9, 15, 25, 41)  # samples of a smoothed derivative
GRID = 24  # values of p_psi/Ix of each sign
HANGING = np.geomspace(0.1, 0.9, 4)  # of the least p_psi/Ix of a standing top; also of each sign
SLIGHT = 1e-3  # rad/s; friction of a start


@dataclass(frozen=True, eq=False)
class Starts:
    """Parameters (k, p) to start from, of one model."""

    model: Model
    x: Real


def list_axis_starts(record: Record) -> Iterator[Starts]:
    """Yield starts for a record of the axis, as points or angles."""
    yield fill_axis_starts(record, find_axes(record))


def find_axes(record: Record) -> Real:
    """Return the axes (n, 3) of a record of points or angles."""
    if record.kind.name == "axis":
        return record.values
    theta, phi = record.values.T
    return np.stack([np.sin(theta) * np.sin(phi), -np.sin(theta) * np.cos(phi), np.cos(theta)], 1)


def fill_axis_starts(record: Record, axes: Real) -> Starts:
    """Return starts for axes (n, 3): each pair of constants with three velocities of the axis."""
    first, velocity, turning = _find_start(record.times, axes)
    model = Model(record, point_along(first))
    pairs = [*find_constants(record.times, axes), *list_grid(record, axes, turning)]
    body = Rotation.from_quat(model.reference[[1, 2, 3, 0]]).inv()
    seen = body.apply(np.cross(first, velocity))
    mean = body.apply(turning * (np.array([0.0, 0.0, 1.0]) - first[2] * first))
    rows = [
        fill(model, {"Mgl/Ix": a, "p_psi/Ix": p, "wx": w[0], "wy": w[1]})
        for a, p in pairs
        for w in (seen, mean, 0 * mean)  # the last: the top was let go
    ]
    return Starts(model, np.array(rows))


def fill(model: Model, values: Mapping[str, float]) -> Real:
    """Return the parameters (p,) of named values; the others are those of a start."""
    slight = dict.fromkeys(FRICTION, SLIGHT)
    missing = dict.fromkeys((*TURNS, *KICK, *MOUNT, LENGTH, *FORCE_BIASES, *CAMERA), 0.0) | slight
    missing["gravity"] = DEFAULT_GRAVITY
    return np.array([{**missing, **values}[name] for name in model.names], dtype=float)


def _find_start(times: Real, axes: Real) -> tuple[Real, Real, float]:
    """Return the first axis, its velocity, and the mean rate of the azimuth."""
    some = min(5, len(times))
    t = times[:some] - times[0]
    slopes = np.polynomial.polynomial.polyfit(t, axes[:some], min(2, some - 1))
    azimuth = np.unwrap(np.arctan2(axes[:, 0], -axes[:, 1]))
    turning = float(np.polyfit(times - times[0], azimuth, 1)[0])
    return slopes[0] / np.linalg.norm(slopes[0]), slopes[1], turning


def find_constants(times: Real, axes: Real) -> Iterator[tuple[float, float]]:
    """Yield Mgl/Ix and p_psi/Ix from the two constants of motion, for some smoothings."""
    step = float(np.median(np.diff(times)))
    for width in (each for each in WIDTHS if each < len(times)):
        inner = slice(width // 2, len(times) - width // 2)
        e = savgol_filter(axes, width, 3, axis=0)[inner]
        rate = savgol_filter(axes, width, 3, deriv=1, delta=step, axis=0)[inner]
        z = e[:, 2] - e[:, 2].mean()
        if (square := float(z @ z)) > 1e-12 * len(z):
            vertical, energy = np.cross(e, rate)[:, 2], (rate**2).sum(axis=1) / 2
            yield -float(energy @ z) / square, -float(vertical @ z) / square


def list_grid(record: Record, axes: Real, turning: float) -> Iterator[tuple[float, float]]:
    """Yield Mgl/Ix and p_psi/Ix up to the fastest nutation that the steps show.

    A regular precession Omega has Mgl = p_psi Omega - Ix Omega^2 cos(theta). A standing top that
    precesses slowly has p_psi > 2 Ix Omega cos(theta), a hanging one may spin as slowly as it will.
    """
    slowest = max(2 * np.pi / record.seconds, 2 * abs(turning))
    fastest = max(1.2 * np.pi / record.step, 1.01 * slowest)
    cosine = float(axes[:, 2].mean())
    for p in [*(2 * abs(turning) * HANGING), *np.geomspace(slowest, fastest, GRID)]:
        for sign in (1.0, -1.0):
            yield sign * p * turning - cosine * turning**2, sign * p
