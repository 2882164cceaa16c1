"""Quantities that are drawn but not logged, computed from the logged samples as arrays."""

from collections.abc import Callable, Mapping
from functools import reduce

import numpy as np

from symtop_ros.arrays import Real, Stamps
from symtop_ros.log.batch import Columns
from symtop_ros.physics import EffectivePotential, Top

ColumnsByTopic = Mapping[str, Columns]


def _from_euler_angles(angles: Real) -> Real:
    phi, theta, psi = angles[:, 0] / 2, angles[:, 1] / 2, angles[:, 2] / 2
    c, s = np.cos(theta), np.sin(theta)
    parts = (
        s * np.cos(phi - psi),
        s * np.sin(phi - psi),
        c * np.sin(phi + psi),
        c * np.cos(phi + psi),
    )
    return np.stack(parts, axis=1)


# By the topic, first of all that of the attitude itself.
READ_ATTITUDE: dict[str, Callable[[Real], Real]] = {
    "orientation": lambda quaternions: quaternions,
    "tf": lambda transforms: transforms[:, 3:],
    "euler_angles": _from_euler_angles,
}


def attitudes(samples: ColumnsByTopic) -> tuple[Stamps, Real] | None:
    """Return stamps and quaternions x, y, z, w (n, 4), None if the log has no attitude."""
    for topic, read in READ_ATTITUDE.items():
        if topic in samples:
            return samples[topic].stamps, read(samples[topic].numbers)
    return None


def axis_of(quaternions: Real) -> Real:
    """Return the symmetry axis in the world frame (n, 3) from quaternions x, y, z, w."""
    x, y, z, w = quaternions.T
    return np.stack(
        [2 * (x * z + w * y), 2 * (y * z - w * x), (w * w + z * z) - (x * x + y * y)], axis=1
    )


def find_step(stamps: Stamps, rate: float) -> int:
    """Return how many samples to skip so that at most `rate` of them are left for each s."""
    span = (stamps[-1] - stamps[0]) * 1e-9 if len(stamps) else 0.0
    return max(1, int(len(stamps) / max(span * rate, 1.0)))


def join(samples: ColumnsByTopic, *topics: str) -> tuple[Stamps, list[Real]] | None:
    """Return the common stamps of topics, and their doubles there; None without a common stamp."""
    if not all(name in samples for name in topics):
        return None
    chosen = [samples[name] for name in topics]
    stamps = chosen[0].stamps
    if all(np.array_equal(stamps, each.stamps) for each in chosen):
        return stamps, [each.numbers for each in chosen]
    stamps = reduce(np.intersect1d, (each.stamps for each in chosen))
    places = [np.intersect1d(each.stamps, stamps, return_indices=True)[1] for each in chosen]
    numbers = [each.numbers[place] for each, place in zip(chosen, places, strict=True)]
    return (stamps, numbers) if len(stamps) else None


def nodes_of(phi: Real) -> Real:
    """Return unit vectors (n, 3) along the line of nodes, in the world frame."""
    return np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)


def constants(samples: ColumnsByTopic, top: Top) -> tuple[Stamps, Real] | None:
    """Return stamps and constants of motion (n, 3): energy, L_z, L_z'; None if a topic is missing.

    E = omega . L / 2 + Mgl cos(theta), L_z = L . axis, L_z' = L . z'.
    """
    found = join(samples, "orientation", "angular_velocity", "angular_momentum")
    if found is None:
        return None
    stamps, (q, omega, L) = found
    axis, omega = axis_of(q), omega[:, 3:]
    energy = (omega * L).sum(axis=1) / 2 + top.Mgl * axis[:, 2]
    return stamps, np.stack([energy, (L * axis).sum(axis=1), L[:, 2]], axis=1)


def heights_of_dots(top: Top, angles: Real) -> tuple[Real, Real, Real]:
    """Return theta, E' = E - p_psi^2/(2 Iz) and (du/dt)^2, each (n,), from angles and rates."""
    theta, phi_dot, theta_dot = angles[:, 1], angles[:, 3], angles[:, 4]
    sine = np.sin(theta)
    across = theta_dot**2 + (sine * phi_dot) ** 2
    return theta, top.Ix * across / 2 + top.Mgl * np.cos(theta), (sine * theta_dot) ** 2


def potentials_at(top: Top, angles: Real) -> list[EffectivePotential]:
    """Return the effective potential for angles and rates (n, 6), one for each row."""
    cosine, sine = np.cos(angles[:, 1]), np.sin(angles[:, 1])
    axial = top.Iz * (angles[:, 5] + angles[:, 3] * cosine)
    vertical = top.Ix * sine * sine * angles[:, 3] + axial * cosine
    _, energies, _ = heights_of_dots(top, angles)
    rows = zip(vertical.tolist(), axial.tolist(), energies.tolist(), strict=True)
    return [EffectivePotential(top, *row) for row in rows]


def scales_of_constants(top: Top, values: Real) -> Real:
    """Return the sizes (3,) that a drift of the constants is divided by: of the larger term."""
    energy, axial, vertical = np.abs(values)
    momentum = max(axial, vertical, 1e-300)
    return np.array([max(energy, abs(top.Mgl), 1e-300), momentum, momentum])
