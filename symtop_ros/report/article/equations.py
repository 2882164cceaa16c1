"""The article's equations of motion, as it displays them; they have a pole on the vertical.

Angles in rad, rates in rad/s, one or many of each.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import State, Top

Real = NDArray[np.float64]


def theta_acceleration(top: Top, theta: Any, phi_dot: Any, psi_dot: Any) -> Any:
    """The article's theta'' in rad/s^2, (...): sin(theta)/Ix times `theta_torque`."""
    return np.sin(theta) / top.Ix * theta_torque(top, theta, phi_dot, psi_dot)


def theta_torque(top: Top, theta: Any, phi_dot: Any, psi_dot: Any) -> Any:
    """What stands in its brackets: (Ix - Iz) phi'^2 cos(theta) - Iz phi' psi' + Mgl in N m."""
    centrifugal = (top.Ix - top.Iz) * phi_dot**2 * np.cos(theta)
    return centrifugal - top.Iz * phi_dot * psi_dot + top.Mgl


def accelerations(top: Top, state: State) -> Real:
    """phi'', theta'', psi'' in rad/s^2, (n, 3), of n states."""
    theta = state.euler_angles.theta
    phi_dot, theta_dot, psi_dot = state.euler_rates
    gyration = top.Iz * psi_dot + (top.Iz - 2 * top.Ix) * phi_dot * np.cos(theta)
    phi = theta_dot / (top.Ix * np.sin(theta)) * gyration
    psi = theta_dot / top.Ix * (top.Ix * phi_dot * np.sin(theta) - gyration / np.tan(theta))
    return np.stack([phi, theta_acceleration(top, theta, phi_dot, psi_dot), psi], axis=-1)
