"""Starts next to that of a motion, and the states to which they lead."""

import math

import numpy as np

from symtop_ros.base.arrays import Places, Real, compose, find_rotation_vectors, invert
from symtop_ros.physics.arguments import STARTS, fill_states
from symtop_ros.physics.jacobian.differentiable import Differentiable
from symtop_ros.physics.jacobian.nodes import CENTRAL, FARTHEST_OF_PAIRS, FORWARD
from symtop_ros.physics.kernel import bindings, states
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes

LARGEST_STEP = 0.03  # in units of the size of a parameter: 1/Ix curves over Ix
NORM_ERROR = 0.999e-3  # of a given quaternion, nearly


class Neighbours:
    """Starts that differ from a motion's in one parameter (column), and their states at times."""

    def __init__(self, motion: Differentiable, times: Real | ExactTimes, at_times: State) -> None:
        """Begin with the states of the motion itself at times (n,)."""
        self._times, self._at_times = times, at_times
        self._start = np.frombuffer(motion._packed_start)
        self._margin = 2 * motion.top.Ix - motion.top.Iz

    def find_longest_steps(self, sizes: Real) -> Real:
        """Return the longest steps of parameters of some sizes, (9,)."""
        longest = sizes * LARGEST_STEP
        # The outermost orientations have a norm of 1 + (5 h)^2/8, times that of the given one.
        off = abs(float(np.linalg.norm(self._start[3:7])) - 1)
        longest[3:6] = min(LARGEST_STEP, math.sqrt(max(NORM_ERROR - off, 1e-6)) / 2)
        return np.asarray(longest)

    def list_starts(self, steps: Real) -> Real | None:
        """Return the starts of the columns by their steps, (9, 10, 15); None for a lost step."""
        changes = np.zeros((9, STARTS[-1]))
        changes[:3, :3] = np.eye(3)
        changes[3:6, 3:7] = compose(self._start[3:7], np.eye(4)[1:]) / 2
        changes[6:, 7:10] = np.eye(3)
        changes *= steps[:, None]
        if (self._start + changes / 2 == self._start).all(axis=1).any():
            return None
        return np.asarray(self._start + self._list_nodes(steps)[..., None] * changes[:, None])

    def _list_nodes(self, steps: Real) -> Real:
        """Return those of each column, (9, 10): a flat disc has no larger Iz, and no smaller Ix."""
        nodes = np.tile(CENTRAL, (9, 1))
        of_Ix, of_Iz, *_ = FARTHEST_OF_PAIRS * steps
        if self._margin < 2 * of_Ix:
            nodes[0] = FORWARD
        if self._margin < of_Iz:
            nodes[1] = -FORWARD
        return nodes

    def measure(self, starts: Real) -> Real:
        """Return how far starts (c, 10, 15) are from the motion's, (c, 10, 9), to all digits."""
        change = starts - self._start
        # The vector of q* (q + dq) is that of q* dq, in which nothing cancels.
        step = compose(invert(self._start[3:7]), change[..., 3:7])
        step[..., 0] += self._start[3:7] @ self._start[3:7]
        return np.concatenate((change[..., :3], find_rotation_vectors(step), change[..., 7:10]), -1)

    def follow(self, starts: Real, some: Places) -> Real:
        """Return how far the states of starts (c, 10, 15) are from its own at some times.

        The rotation vectors and the changes of omega are (c, 10, m, 2, 3).
        """
        times = self._times[some]
        rows = starts.reshape(-1, STARTS[-1])
        q, omega = np.empty((len(rows), len(some), 4)), np.empty((len(rows), len(some), 3))
        left = fill_states(rows, times, q, omega)
        for k in np.flatnonzero(left.any(axis=1)):
            states.fill_states(bindings.KernelMotion(rows[k].tobytes()), times, q[k], omega[k])
        base, rates = self._at_times.orientation[some], self._at_times.angular_velocity[some]
        turned = find_rotation_vectors(compose(invert(base), q))
        changes = np.stack((turned, omega - rates), axis=-2)
        return changes.reshape(*starts.shape[:2], *changes.shape[1:])
