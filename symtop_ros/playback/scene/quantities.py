"""What is drawn besides the topics themselves, in arrays, from what was logged."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Top
from symtop_ros.playback.batch import Columns

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]
Samples = Mapping[str, Columns]


def attitude(samples: Samples) -> tuple[Stamps, Real] | None:
    """Quaternions x, y, z, w (n, 4): ~/orientation, else /tf, else the Euler angles."""
    if "orientation" in samples:
        columns = samples["orientation"]
        return columns.stamps, columns.numbers
    if "tf" in samples:
        columns = samples["tf"]
        return columns.stamps, columns.numbers[:, 3:]
    if "euler_angles" in samples:
        columns = samples["euler_angles"]
        return columns.stamps, _quaternion(columns.numbers)
    return None


def _quaternion(angles: Real) -> Real:
    phi, theta, psi = angles[:, 0] / 2, angles[:, 1] / 2, angles[:, 2] / 2
    c, s = np.cos(theta), np.sin(theta)
    parts = (
        s * np.cos(phi - psi),
        s * np.sin(phi - psi),
        c * np.sin(phi + psi),
        c * np.cos(phi + psi),
    )
    return np.stack(parts, axis=1)


def axis_of(quaternions: Real) -> Real:
    """The body's axis z in the world (n, 3), from quaternions x, y, z, w."""
    x, y, z, w = quaternions.T
    return np.stack(
        [2 * (x * z + w * y), 2 * (y * z - w * x), (w * w + z * z) - (x * x + y * y)], axis=1
    )


def aligned(one: Columns, other: Columns) -> tuple[Stamps, Real, Real]:
    """Return the stamps two topics have in common, and their numbers."""
    if np.array_equal(one.stamps, other.stamps):
        return one.stamps, one.numbers, other.numbers
    stamps, first, second = np.intersect1d(one.stamps, other.stamps, return_indices=True)
    return stamps, one.numbers[first], other.numbers[second]


def horizontal_square(momentum: Columns) -> Real:
    """L^2 - L_z'^2 (n,), as the sum of squares that it is: nothing cancels."""
    return np.asarray((momentum.numbers[:, :2] ** 2).sum(axis=1))


def constants(samples: Samples, top: Top) -> tuple[Stamps, Real] | None:
    """Constants of motion (n, 3): energy, L_z, L_z', from what was logged.

    E = omega . L / 2 + Mgl cos(theta), L_z = L . axis, L_z' = L . z'.
    """
    names = ("orientation", "angular_velocity", "angular_momentum")
    if not all(name in samples for name in names):
        return None
    orientation, velocity, momentum = (samples[name] for name in names)
    stamps, q, omega = aligned(orientation, velocity)
    joined = Columns(stamps, np.concatenate([q, omega[:, 3:]], axis=1), stamps)
    stamps, both, L = aligned(joined, momentum)
    axis, omega = axis_of(both[:, :4]), both[:, 4:]
    energy = (omega * L).sum(axis=1) / 2 + top.Mgl * axis[:, 2]
    return stamps, np.stack([energy, (L * axis).sum(axis=1), L[:, 2]], axis=1)


def sizes(top: Top, values: Real) -> Real:
    """What a change of the constants is measured by (3,): the larger one of its parts."""
    energy, axial, vertical = np.abs(values)
    momentum = max(axial, vertical, 1e-300)
    return np.array([max(energy, abs(top.Mgl), 1e-300), momentum, momentum])
