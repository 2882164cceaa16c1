"""The equations of motion, for the integrators that the package is measured beside.

In plain floats: with so few numbers, arrays would only slow SciPy down.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

from symtop_ros.report.precision.peers.peer import Task


def body_rates(task: Task, t: float, y: Any) -> list[Any]:
    """Return q' = q omega/2 and Euler's equations for (w, x, y, z, wx, wy, wz).

    With friction -axial wz on the axis and -transverse (wx, wy) across it. Needs only sums and
    products, so that the numbers may be expressions as well.
    """
    Ix, Iz, Mgl = task.top.moments
    axial, transverse = task.friction.axial, task.friction.transverse
    w, x, y_, z, wx, wy, wz = y.tolist() if hasattr(y, "tolist") else y
    gx, gy = 2 * (x * z - w * y_), 2 * (y_ * z + w * x)
    return [
        (-x * wx - y_ * wy - z * wz) / 2,
        (w * wx + y_ * wz - z * wy) / 2,
        (w * wy - x * wz + z * wx) / 2,
        (w * wz + x * wy - y_ * wx) / 2,
        ((Ix - Iz) * wy * wz + Mgl * gy - transverse * wx) / Ix,
        ((Iz - Ix) * wz * wx - Mgl * gx - transverse * wy) / Ix,
        -axial * wz / Iz,
    ]


def euler_rates(task: Task, t: float, y: Any) -> list[float]:
    """Return the article's equations for (phi, theta, psi, phi', theta', psi')."""
    Ix, Iz, Mgl = task.top.moments
    _, theta, _, phi_dot, theta_dot, psi_dot = y.tolist()
    c, s = cos(theta), sin(theta)
    gyration = Iz * psi_dot + (Iz - 2 * Ix) * phi_dot * c
    phi_ddot = theta_dot / (Ix * s) * gyration
    theta_ddot = s / Ix * ((Ix - Iz) * phi_dot**2 * c - Iz * phi_dot * psi_dot + Mgl)
    psi_ddot = theta_dot * phi_dot * s - phi_ddot * c
    return [phi_dot, theta_dot, psi_dot, phi_ddot, theta_ddot, psi_ddot]
