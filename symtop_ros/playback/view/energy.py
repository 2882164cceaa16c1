"""Energy bookkeeping of a run: kinetic, potential, lost to friction, and work of torques and kicks.

Stacked, the first three end at the energy of the start plus the work that was done.
"""

import numpy as np

from symtop_ros.arrays import Real, Stamps
from symtop_ros.physics import Motion
from symtop_ros.playback.view.quantities import ColumnsByTopic, axis_of, join
from symtop_ros.simulation.events import RESTARTS, Event
from symtop_ros.simulation.segment import Segment


class EnergyBook:
    """Energy that friction has taken and that torques and kicks have added since the last start."""

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
            self._begin, self._work, self._lost = energy, 0.0, 0.0
        else:
            left = float(before.motion.top.energy(event.state_before()))
            self._settle(before, left)
            self._work += energy - left
        self._segment_energy, self._segment_work, self._last = energy, 0.0, None

    def _settle(self, segment: Segment, energy: float) -> None:
        """Book the work and the loss of a segment, from its energy (J) at the end."""
        gained = energy - self._segment_energy
        work = self._segment_work if segment.motion.friction else gained
        self._work += work
        self._lost += work - gained

    def rows(self, samples: ColumnsByTopic, motion: Motion) -> tuple[Stamps, Real] | None:
        """Return stamps and four energies (n, 4) in J; None if a topic is missing.

        Kinetic; with potential (from its lowest point); with what is lost; start and work.
        """
        found = join(samples, "orientation", "angular_velocity", "angular_momentum")
        if found is None:
            return None
        stamps, (orientation, velocity, momentum) = found
        top, omega = motion.top, velocity[:, 3:]
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
        if not any(motion.applied_torque):
            return np.zeros_like(gained)
        if not motion.friction:
            return gained
        power = omega @ np.array(motion.applied_torque)
        first = self._last or (int(stamps[0]), float(power[0]))
        times = np.concatenate([[first[0]], stamps]) * 1e-9
        powers = np.concatenate([[first[1]], power])
        steps = np.diff(times) * (powers[1:] + powers[:-1]) / 2
        work: Real = self._segment_work + steps.cumsum()
        self._segment_work, self._last = float(work[-1]), (int(stamps[-1]), float(power[-1]))
        return work
