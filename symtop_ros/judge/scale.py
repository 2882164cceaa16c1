"""Attitudes of a gyroscope whose scale is wrong by the same part along each axis.

Integrated, it gives the attitude D(t) q(t): from q' = q omega/2 and (D q)' = D q (1 + k) omega/2
follows D' = D (k omega_world)/2. So D is integrated along angular velocities in the world frame,
which change by precession and nutation only and not with the spin.
"""

import numpy as np

from symtop_ros.arrays import Real, Stamps
from symtop_ros.judge.compare import IDENTITY, to_rotation
from symtop_ros.judge.truth import Truth
from symtop_ros.quaternions import compose
from symtop_ros.wire.layout import NANOSECONDS

STEP = 2_000_000  # ns; nutation turns by 0.1 rad in it
MOST_STEPS = 100_000  # a longer run is not integrated
GAUSS = (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5)  # places in a step


class Scaling:
    """The rotations D of each scale, at stamps (n,) in their order; the identity at the first."""

    def __init__(self, truth: Truth, stamps: Stamps) -> None:
        intervals = np.diff(stamps)
        counts = np.maximum(-(-intervals // STEP), 1)
        widths = np.repeat(intervals / counts, counts)
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        begins = np.repeat(stamps[:-1], counts) + within * widths
        self._ends = np.concatenate(([0], np.cumsum(counts)))
        parts = [self._rates(truth, begins + part * widths) for part in GAUSS]
        self._turns = (parts[0] + parts[1]) / 2 * widths[:, np.newaxis] / NANOSECONDS

    @staticmethod
    def _rates(truth: Truth, times: Real) -> Real:
        """Return the angular velocities in the world frame, (m, 3)."""
        q, omega, known = truth.states_at(np.rint(times).astype(np.int64))
        return np.asarray(to_rotation(q).apply(omega) * known[:, np.newaxis])

    def turn(self, scale: float) -> Real:
        """Return the rotations D for a scale that is wrong by this part, (n, 4)."""
        return self._path(scale)[self._ends]

    def derive(self, scale: float) -> Real:
        """Return the derivatives of D by the scale, as rotation vectors in the world, (n, 3)."""
        path = self._path(scale)
        steps = to_rotation(path[:-1]).apply(self._turns) if scale else self._turns
        return np.asarray(np.vstack((np.zeros(3), np.cumsum(steps, axis=0)))[self._ends])

    def _path(self, scale: float) -> Real:
        """Return the products of all steps up to each, (m + 1, 4), by doubling their number."""
        half = self._turns * (scale / 2)
        angles = np.linalg.norm(half, axis=1, keepdims=True)
        steps = np.hstack((np.cos(angles), half * np.sinc(angles / np.pi)))
        path = np.vstack((IDENTITY, steps))
        shift = 1
        while shift < len(path):
            path[shift:] = compose(path[:-shift], path[shift:])
            shift *= 2
        return path


def count_steps(stamps: Stamps) -> int:
    """Return about how many steps the integration between stamps takes."""
    return int((stamps[-1] - stamps[0]) // STEP) + len(stamps)
