"""The maps of the article's top: precession rate against spin, and against tilt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.perry_map import Hurried, fall_torque, hurried
from symtop_ros.report.article.motions import PSI_DOT, THETA, TOP

FACTOR = 1.4
PHI_DOTS = (-60.0, 120.0)  # rad/s
PSI_DOTS = (-400.0, 400.0)  # rad/s
THETAS = (0.02, np.pi - 0.02)  # rad; on the vertical itself phi' is undefined
Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PerryMap:
    """One map.

    Attributes
    ----------
    name : str
        Of its files.
    title, label : str
        What is held, and what is along the horizontal axis.
    across : ndarray (m,)
        Along the horizontal axis: psi' in rad/s, or theta in rad.
    phi_dot : ndarray (n,)
        Along the vertical axis, rad/s.
    found : Hurried
        (n, m).
    torque : ndarray (n, m)
        As `fall_torque` before the kick: zero on the curves of regular precession.
    """

    name: str
    title: str
    label: str
    across: Real
    phi_dot: Real
    found: Hurried
    torque: Real


def over_spin(points: int) -> PerryMap:
    """Return the map of points x points over psi' and phi', at the article's tilt."""
    phi_dot, psi_dot = _axes(points, PSI_DOTS)
    place = THETA, phi_dot[:, np.newaxis], psi_dot
    found, torque = hurried(TOP, *place, FACTOR), fall_torque(TOP, *place)
    title = f"theta = {THETA:g} rad"
    return PerryMap("spin", title, "spin rate psi' (rad/s)", psi_dot, phi_dot, found, torque)


def over_tilt(points: int) -> PerryMap:
    """Return the map of points x points over theta and phi', at the article's spin."""
    phi_dot, theta = _axes(points, THETAS)
    place = theta, phi_dot[:, np.newaxis], PSI_DOT
    found, torque = hurried(TOP, *place, FACTOR), fall_torque(TOP, *place)
    title = f"psi' = {PSI_DOT:g} rad/s"
    return PerryMap("tilt", title, "tilt theta (rad)", theta, phi_dot, found, torque)


def _axes(points: int, across: tuple[float, float]) -> tuple[Real, Real]:
    return np.linspace(*PHI_DOTS, points), np.linspace(*across, points)
