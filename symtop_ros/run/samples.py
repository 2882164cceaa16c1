"""The numbers that each topic of a sample carries, in the order of its message.

World frame, SI units; one state or many: arrays (..., width).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Motion, State

Real = NDArray[np.float64]


def orientation(_: Motion, state: State) -> Real:
    """Quaternion x, y, z, w, body -> world."""
    return state.orientation[..., [1, 2, 3, 0]]


def angular_velocity(_: Motion, state: State) -> Real:
    """Linear velocity of the pivot, which is none, then angular velocity."""
    return _after_zeros(state.to_world(state.angular_velocity))


def angular_momentum(path: Motion, state: State) -> Real:
    """Angular momentum about the pivot."""
    return path.top.angular_momentum(state)


def torque(path: Motion, state: State) -> Real:
    """Force, which is not modelled and none, then torque about the pivot: all there is."""
    return _after_zeros(path.torque(state))


def euler_angles(_: Motion, state: State) -> Real:
    """Angles phi, theta, psi, then their rates."""
    return np.stack([*state.euler_angles, *state.euler_rates], axis=-1)


def transform(path: Motion, state: State) -> Real:
    """Translation, which is none, then the quaternion."""
    return _after_zeros(orientation(path, state))


SAMPLES: dict[str, Callable[[Motion, State], Real]] = {
    "orientation": orientation,
    "angular_velocity": angular_velocity,
    "angular_momentum": angular_momentum,
    "torque": torque,
    "euler_angles": euler_angles,
    "tf": transform,
}


def _after_zeros(vector: Real) -> Real:
    return np.concatenate([np.zeros_like(vector[..., :3]), vector], axis=-1)
