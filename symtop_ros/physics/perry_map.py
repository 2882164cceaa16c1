"""Perry's rule over whole ranges of tops at once: where hurrying raises the top, and by how much.

With theta' = 0 the tilt is one turning angle, u0 = cos(theta), and (du/dt)^2 = f(u) has a factor
s = u - u0: the other turning angle is a root of the quadratic that is left. So a map needs neither
elliptic functions nor a solver. Arguments are broadcast against each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.physics.kicks import Hold
from symtop_ros.physics.top import Top

Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Hurried:
    """What a kick does to tops whose axes are momentarily at rest in theta.

    Attributes
    ----------
    before, after : ndarray (2, ...)
        Turning angles of the motion without the kick and with it, smallest theta first, in rad.
    rule_holds : ndarray (...) of bool
        Whether theta'' sinks as |phi'| grows, as in `perry`; for phi' = 0 the side of the slow
        root counts.
    """

    before: Real
    after: Real
    rule_holds: NDArray[np.bool_]

    @property
    def rise(self) -> Real:
        """How much higher the highest point is, (...), in rad; negative where it is lower."""
        return np.asarray(self.before[0] - self.after[0])

    @property
    def fall(self) -> Real:
        """How much lower the lowest point is, (...), in rad; negative where it is higher."""
        return np.asarray(self.after[1] - self.before[1])


def hurried(
    top: Top,
    theta: ArrayLike,
    phi_dot: ArrayLike,
    psi_dot: ArrayLike,
    factor: float = 1.4,
    hold: Hold = "spin_rate",
) -> Hurried:
    """Return what hurrying the precession by a factor does, for many tops at once.

    Parameters
    ----------
    top : Top
    theta, phi_dot, psi_dot : array_like, broadcast to (...)
        Tilt in rad, precession and spin rate in rad/s; theta' is 0.
    factor : float
        phi' is multiplied by it.
    hold : {"spin_rate", "spin_momentum"}
        What the kick leaves as it is.
    """
    theta, phi_dot, psi_dot = np.broadcast_arrays(
        *(np.asarray(each, dtype=float) for each in (theta, phi_dot, psi_dot))
    )
    kicked_psi_dot = psi_dot
    if hold == "spin_momentum":
        kicked_psi_dot = psi_dot - (factor - 1) * phi_dot * np.cos(theta)
    before = other_turning_angle(top, theta, phi_dot, psi_dot)
    after = other_turning_angle(top, theta, factor * phi_dot, kicked_psi_dot)
    return Hurried(
        np.sort([before, theta], axis=0),
        np.sort([after, theta], axis=0),
        _slope(top, theta, phi_dot, psi_dot, hold) < 0,
    )


def fall_torque(top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike) -> Real:
    """Return Ix theta''/sin(theta) (...), in N m: zero where precession is regular.

    (Ix - Iz) cos(theta) phi'^2 - Iz psi' phi' + Mgl; the top rises where it is negative.
    """
    p = np.asarray(phi_dot, dtype=float)
    a = (top.Ix - top.Iz) * np.cos(np.asarray(theta, dtype=float))
    return np.asarray((a * p - top.Iz * np.asarray(psi_dot, dtype=float)) * p + top.Mgl)


def other_turning_angle(top: Top, theta: Real, phi_dot: Real, psi_dot: Real) -> Real:
    """Return the angle (...), in rad, at which theta' vanishes again after theta' = 0 at theta.

    f(s) = s (f1 + f2 s + f3 s^2), whose root next to s = 0 on the side of the sign of f1 is meant:
    the roots of the quadratic are q/f3 and f1/q, and neither is formed by subtraction.
    """
    u, sine_squared = np.cos(theta), np.sin(theta) ** 2
    spin = top.Iz / top.Ix * (psi_dot + phi_dot * u)  # p_psi/Ix
    pull = 2 * top.Mgl / top.Ix
    f1 = -sine_squared * (pull + 2 * phi_dot * (u * phi_dot - spin))
    f2 = 2 * pull * u - sine_squared * phi_dot**2 - spin**2
    root = np.sqrt(np.maximum(f2 * f2 - 4 * pull * f1, 0.0))
    q = -(f2 + np.copysign(root, f2)) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = f1 / q, q / pull
    s = _nearest(one, other, f1)
    below = np.maximum(2 * np.sin(theta / 2) ** 2 - s, 0.0)  # 1 - u at the other angle
    above = np.maximum(2 * np.cos(theta / 2) ** 2 + s, 0.0)
    return np.asarray(2 * np.arctan2(np.sqrt(below), np.sqrt(above)))


def _nearest(one: Real, other: Real, side: Real) -> Real:
    """Return the root nearest to 0 on the side of a sign; 0 where there is none."""
    roots = np.stack([one, other])
    fits = np.isfinite(roots) & (np.sign(roots) == np.sign(side))
    distances = np.where(fits, np.abs(roots), np.inf).min(axis=0)
    return np.asarray(np.where(np.isfinite(distances), np.copysign(distances, side), 0.0))


def _slope(top: Top, theta: Real, phi_dot: Real, psi_dot: Real, hold: Hold) -> Real:
    """Change of Ix theta''/sin(theta) = a phi'^2 - b phi' + Mgl with |phi'|."""
    u = np.cos(theta)
    if hold == "spin_momentum":
        a, b = top.Ix * u, top.Iz * (psi_dot + phi_dot * u)
    else:
        a, b = (top.Ix - top.Iz) * u, top.Iz * psi_dot
    # at phi' = 0 one would hurry towards the slow root, which has the sign of Mgl/b
    sense = np.where(phi_dot == 0, np.sign(top.Mgl * b), np.sign(phi_dot))
    return np.asarray((2 * a * phi_dot - b) * sense)
