"""Perry's rule for many tops at once, and the rise that hurrying causes.

With theta' = 0 the present tilt is one turning angle, u0 = cos(theta). The cubic f(u) of
(du/dt)^2 = f(u) then has the factor s = u - u0, and the other turning angle is a root of the
quadratic that remains. So a map needs neither elliptic functions nor a solver for each point.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    EPS,
    START_ROUNDING,
    ignore_underflow,
    validate_array,
    validate_number,
    validate_rate,
)


@dataclass(frozen=True, eq=False)
class HurryEffect:
    """Tops with theta' = 0, compared with the same tops hurried.

    Attributes
    ----------
    before, after : ndarray (2, ...)
        Turning angles without the kick and with it, smallest theta first, in rad.
    rule_applies : ndarray (...) of bool
        False where Perry's rule says nothing: for phi' = 0, on the vertical, for a factor that is 1
        or negative, and where theta'' is the same with the kick as without it.
    rule_holds : ndarray (...) of bool
        True where Perry's rule holds, as defined in `perrys_rule`.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> effect = compare_hurried(top, theta=0.5, phi_dot=9.0, psi_dot=200.0)
    >>> bool(effect.rise > 0)
    True
    """

    before: Real
    after: Real
    rule_applies: NDArray[np.bool_]
    rule_holds: NDArray[np.bool_]

    @property
    def rise(self) -> Real:
        """Rise of the highest point, (...), in rad; negative where it is lower with the kick."""
        return np.asarray(self.before[0] - self.after[0])

    @property
    def fall(self) -> Real:
        """Fall of the lowest point, (...), in rad; negative where it is higher with the kick."""
        return np.asarray(self.after[1] - self.before[1])


@ignore_underflow
def compare_hurried(
    top: Top,
    theta: ArrayLike,
    phi_dot: ArrayLike,
    psi_dot: ArrayLike,
    factor: float = 1.4,
    hold: Hold = "spin_rate",
) -> HurryEffect:
    """Return the effect of hurrying the precession by a factor, for many tops at once.

    Parameters
    ----------
    top : Top
        One top, or many of a shape that fits the other arguments.
    theta, phi_dot, psi_dot : array_like, broadcast to (...)
        Tilt in rad, precession and spin rate in rad/s; theta' is 0.
    factor : float
        The kick multiplies phi' by it.
    hold : {"spin_rate", "spin_momentum"}
        The quantity that the kick holds, as in `set_precession_rate`.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> compare_hurried(top, 0.5, [6.5, 69.8], 200.0).rule_holds.tolist()
    [True, False]
    """
    factor, hold = validate_number("factor", factor), validate_hold(hold)
    _, theta, phi_dot, psi_dot = np.broadcast_arrays(
        np.empty(top.shape),
        validate_array("theta", theta, unit="rad"),
        validate_rate("phi_dot", phi_dot),
        validate_rate("psi_dot", psi_dot),
    )
    validate_rate("factor * phi_dot", float(np.max(np.abs(phi_dot), initial=0.0)) * factor)
    u = np.cos(theta)
    spin, kicked_psi_dot = psi_dot, psi_dot
    if hold == "spin_momentum":
        spin = psi_dot + phi_dot * u  # omega_z
        kicked_psi_dot = psi_dot - (factor - 1) * phi_dot * u
    before = find_other_turning_angle(top, theta, phi_dot, psi_dot)
    after = find_other_turning_angle(top, theta, factor * phi_dot, kicked_psi_dot)
    change = _find_change(top, u, spin, phi_dot, factor, hold)
    applies = (phi_dot != 0) & (np.sin(theta) != 0) & (0 <= factor != 1) & (change != 0)
    holds = applies & (change * math.copysign(1.0, factor - 1) < 0)
    return HurryEffect(
        np.sort([before, theta], axis=0),
        np.sort([after, theta], axis=0),
        np.asarray(applies),
        np.asarray(holds),
    )


def _find_change(top: Top, u: Real, spin: Real, phi_dot: Real, factor: float, hold: Hold) -> Real:
    """Return the change of Ix theta''/sin(theta) by the kick, in N m; 0 if it is rounding.

    It is that of a p^2 - b p + Mgl (`kernel/rule/regular.hpp`): the change of p times a slope.
    """
    cosine = np.where(np.abs(u) <= EPS, 0.0, u)
    a = (top.Ix if hold == "spin_momentum" else top.Ix - top.Iz) * cosine
    b, total = top.Iz * spin, phi_dot + factor * phi_dot
    slope = a * total - b
    is_rounding = np.abs(slope) <= START_ROUNDING * (np.abs(a * total) + np.abs(b))
    return np.where(is_rounding, 0.0, (factor - 1) * phi_dot * slope)


def find_other_turning_angle(top: Top, theta: Real, phi_dot: Real, psi_dot: Real) -> Real:
    """Return the angle (...), in rad, at which theta' vanishes again after theta' = 0 at theta.

    f(s) = s (f1 + f2 s + f3 s^2). The angle belongs to the root of the quadratic that is nearest to
    s = 0 on the side where f is positive, the side of the sign of f1. The roots
    are q/f3 and f1/q (Numerical Recipes, section 5.6): neither is a difference that cancels.
    """
    u, sine_squared = np.cos(theta), np.sin(theta) ** 2
    # In this unit of time, a power of two, no product of rates overflows.
    fastest = np.maximum(
        np.maximum(np.abs(phi_dot), np.abs(psi_dot)), np.sqrt(np.abs(top.Mgl) / top.Ix)
    )
    unit = np.ldexp(1.0, -np.frexp(fastest)[1])
    phi_dot, psi_dot = phi_dot * unit, psi_dot * unit
    a = top.Iz / top.Ix * (psi_dot + phi_dot * u)  # Goldstein's a = p_psi/Ix
    beta = 2 * (top.Mgl / top.Ix * unit) * unit  # Goldstein's beta
    f1 = -sine_squared * (beta + 2 * phi_dot * (u * phi_dot - a))
    f2 = 2 * beta * u - sine_squared * phi_dot**2 - a**2
    root = np.sqrt(np.maximum(f2 * f2 - 4 * beta * f1, 0.0))
    q = -(f2 + np.copysign(root, f2)) / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        s = _choose_root(f1 / q, q / beta, f1)
    # 1 - u and 1 + u of the other angle: the arc cosine of u would lose half the digits at a pole.
    one_minus_u = np.maximum(2 * np.sin(theta / 2) ** 2 - s, 0.0)
    one_plus_u = np.maximum(2 * np.cos(theta / 2) ** 2 + s, 0.0)
    return np.asarray(2 * np.arctan2(np.sqrt(one_minus_u), np.sqrt(one_plus_u)))


def _choose_root(first: Real, second: Real, side: Real) -> Real:
    """Return the root nearest to 0 that has the sign of `side`; 0 if neither has."""
    roots = np.stack([first, second])
    fits = np.isfinite(roots) & (np.sign(roots) == np.sign(side))
    distances = np.where(fits, np.abs(roots), np.inf).min(axis=0)
    return np.asarray(np.where(np.isfinite(distances), np.copysign(distances, side), 0.0))
