"""Quantities that are drawn but not logged, computed from the logged samples as arrays."""

import math
from collections.abc import Callable, Mapping
from functools import reduce

import numpy as np

from symtop_ros.base.arrays import Real, Stamps, axis_of
from symtop_ros.physics import EffectivePotential, Motion, Top
from symtop_ros.run.log.batch import Columns
from symtop_ros.run.simulation.events import RESTARTS, Event
from symtop_ros.run.simulation.segment import Segment

EPS = float(np.finfo(float).eps)
ColumnsByTopic = Mapping[str, Columns]


def _from_euler_angles(angles: Real) -> Real:
    phi, theta, psi = angles[:, :3].T / 2
    c, s = np.cos(theta), np.sin(theta)
    return np.stack(
        [
            s * np.cos(phi - psi),
            s * np.sin(phi - psi),
            c * np.sin(phi + psi),
            c * np.cos(phi + psi),
        ],
        axis=1,
    )


# By the topic; the topic of the attitude itself comes first.
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
    numbers = [
        each.numbers[np.intersect1d(each.stamps, stamps, return_indices=True)[1]] for each in chosen
    ]
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
    return [
        EffectivePotential(top, *row)
        for row in zip(vertical.tolist(), axial.tolist(), energies.tolist(), strict=True)
    ]


def scales_of_constants(top: Top, values: Real) -> Real:
    """Return the sizes (3,) that a drift of the constants is divided by: of the terms in each sum.

    The terms are products of components of omega and L, and have rounding errors even if their sum
    is zero. So the largest L and omega that the motion can have are used.
    """
    energy, axial = float(values[0]), abs(float(values[1]))
    depth = abs(top.Mgl)
    # The kinetic energy without the spin at the lowest point; E itself is known up to rounding.
    across = max(energy + depth - axial * axial / (2 * top.Iz), EPS * max(abs(energy), depth))
    turning = math.sqrt(2 * top.Ix * across)
    momentum = math.hypot(axial, turning)
    work = momentum * math.hypot(axial / top.Iz, turning / top.Ix) / 2
    return np.array([max(abs(energy), depth, work) or 1.0, momentum or 1.0, momentum or 1.0])


class EnergyBook:
    """Energy that friction has taken and that torques and kicks have added since the last start.

    Stacked, kinetic and potential energy and what friction has taken end at the energy of the start
    plus the work that was done.
    """

    def __init__(self) -> None:
        self._begin = 0.0  # J: energy of the last start
        self._work, self._lost = 0.0, 0.0  # J, since then, up to the segment
        self._segment_energy = 0.0  # J: at the begin of the segment
        self._segment_work = 0.0  # J: of the applied torque, up to the last sample
        self._last: tuple[int, float] | None = None  # stamp and power of the last sample

    def follow(self, event: Event, before: Segment | None, after: Segment) -> None:
        """Take over an event: a restart, or a change whose energy counts as work.

        The energies are those of the recorded states; no state is computed.
        """
        energy = float(after.motion.top.energy(event.state()))
        if event.name in RESTARTS or before is None:
            self._begin = energy
            self._work = 0.0
            self._lost = 0.0
        else:
            left = float(before.motion.top.energy(event.state_before()))
            gained = left - self._segment_energy
            work = self._segment_work if before.motion.friction else gained
            self._work += work
            self._lost += work - gained
            self._work += energy - left
        self._segment_energy = energy
        self._segment_work = 0.0
        self._last = None

    def rows(self, samples: ColumnsByTopic, motion: Motion) -> tuple[Stamps, Real] | None:
        """Return stamps and four energies (n, 4) in J; None if a topic is missing.

        The columns are cumulative: the kinetic energy; with the potential energy (from its lowest
        point) added; with the energy lost by friction added; and the energy of the start plus the
        work.
        """
        found = join(samples, "orientation", "angular_velocity", "angular_momentum")
        if found is None:
            return None
        stamps, (orientation, velocity, momentum) = found
        top = motion.top
        omega = velocity[:, 3:]
        kinetic = (omega * momentum).sum(axis=1) / 2
        height = top.Mgl * axis_of(orientation)[:, 2]
        gained = kinetic + height - self._segment_energy
        work = self._work_of_torque(stamps, omega, motion, gained)
        lowest = abs(top.Mgl)
        stacked = kinetic + height + lowest
        lost = self._lost + (work - gained if motion.friction else 0.0)
        done = self._begin + self._work + work + lowest
        return stamps, np.stack([kinetic, stacked, stacked + lost, done], axis=1)

    def _work_of_torque(self, stamps: Stamps, omega: Real, motion: Motion, gained: Real) -> Real:
        """Return the work of the applied torque since the begin of the segment, (n,)."""
        if not any(motion.applied_torque) and not motion.pushes:
            return np.zeros_like(gained)
        if not motion.friction:
            return gained
        power = omega @ np.array(motion.applied_torque)
        first = self._last or (int(stamps[0]), float(power[0]))
        times = np.concatenate([[first[0]], stamps]) * 1e-9
        powers = np.concatenate([[first[1]], power])
        steps = np.diff(times) * (powers[1:] + powers[:-1]) / 2
        work: Real = self._segment_work + steps.cumsum()
        self._segment_work = float(work[-1])
        self._last = (int(stamps[-1]), float(power[-1]))
        return work
