"""Regular precession, and the angular acceleration of the tilt that it balances.

At any theta' (the article's first displayed equation)

    theta'' = sin(theta)/Ix (a phi'^2 - b phi' + Mgl).

The roots of the quadratic are the rates of regular precession. Its coefficients depend on what is
held while phi' varies:

===============  ======================  ==================
held             a                       b
===============  ======================  ==================
spin rate psi'   (Ix - Iz) cos(theta)    Iz psi'
spin momentum    Ix cos(theta)           p_psi = Iz omega_z
===============  ======================  ==================

At the same state both give the same theta''.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.arrays import Real
from symtop_ros.physics.exact.precise import PRECISE, ZERO, compute_cosine
from symtop_ros.physics.kicks import Hold
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    EPS,
    START_ROUNDING,
    fit_shapes,
    ignore_underflow,
    refuse,
    validate_array,
    validate_rate,
    validate_together,
)

LARGEST_TILT = 1e15  # rad


@dataclass(frozen=True, slots=True)
class TiltQuadratic:
    """The quadratic a phi'^2 - b phi' + Mgl = Ix theta''/sin(theta), in N m.

    Parameters
    ----------
    a, b : float or ndarray (...)
        Coefficients, in kg m^2 and N m s.
    Mgl : float
        In J.

    Examples
    --------
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> quadratic = TiltQuadratic.of(top, math.cos(0.5), spin=200.0)
    >>> [round(root, 2) for root in quadratic.roots]
    [6.5, 69.82]
    """

    a: Any
    b: Any
    Mgl: float

    @classmethod
    def of(cls, top: Top, cosine: Any, spin: Any, hold: Hold = "spin_rate") -> "TiltQuadratic":
        """Return the quadratic of one tilt or many.

        Parameters
        ----------
        top : Top
        cosine : float or ndarray (...)
            cos(theta).
        spin : float or ndarray (...)
            Present psi' if the spin rate is held, omega_z if the spin momentum is held, in rad/s.
        hold : {"spin_rate", "spin_momentum"}
            The quantity that is held while phi' varies.
        """
        cosine = np.where(np.abs(cosine) <= EPS, 0.0, cosine)[()]  # no double is exactly pi/2
        transverse = top.Ix if hold == "spin_momentum" else top.Ix - top.Iz
        return cls(transverse * cosine, top.Iz * spin, top.Mgl)

    def at(self, phi_dot: Any) -> Any:
        """Return the quadratic at precession rates in rad/s, (...), in N m."""
        return (self.a * phi_dot - self.b) * phi_dot + self.Mgl

    def change(self, before: Any, after: Any) -> Any:
        """Return at(after) - at(before), (...), in N m.

        The difference of the two values would lose all digits for a small change of the rate, and
        Mgl would hide what is smaller than its rounding. As a product it is right to rounding, and
        0 if its second factor is no more than that.
        """
        slope = self.a * (before + after) - self.b
        largest = np.abs(self.a) * (np.abs(before) + np.abs(after)) + np.abs(self.b)
        slope = np.where(np.abs(slope) <= START_ROUNDING * largest, 0.0, slope)[()]
        return (after - before) * slope

    def is_balanced(self, phi_dot: float) -> bool:
        """Return True if the quadratic vanishes at a rate, up to rounding of its terms."""
        p = abs(phi_dot)
        terms = (abs(self.a) * p + abs(self.b)) * p + abs(self.Mgl)
        return bool(abs(self.at(phi_dot)) <= START_ROUNDING * terms)

    @property
    def roots(self) -> tuple[float, ...]:
        """Real roots in rad/s, the one of smaller size first."""
        return solve_quadratic(float(self.a), float(self.b), self.Mgl)


def regular_precession_rates(top: Top, theta: ArrayLike, psi_dot: ArrayLike) -> tuple[Any, ...]:
    """Return the rates phi' of regular precession at one tilt and spin rate.

    They are the roots of (Ix - Iz) cos(theta) p^2 - Iz psi' p + Mgl = 0, formed without
    cancellation.

    Parameters
    ----------
    top : Top
        One top, or many of shape (...).
    theta : float or array_like (...)
        Tilt in rad.
    psi_dot : float or array_like (...)
        Spin rate psi' in rad/s. Tops, tilts and spin rates are broadcast together.

    Returns
    -------
    tuple of float, or of two ndarray (...)
        (slow, fast) in rad/s with |slow| <= |fast|; one rate if the equation is linear; none if the
        spin is too small. Of arrays two arrays, with nan for a rate that there is not. They are
        the nearest doubles to the exact rates of the doubles given, but |cos(theta)| <= 2.2e-16
        counts as zero: no double is exactly pi/2.

    Raises
    ------
    ValueError
        If an argument is not a finite number, or if theta exceeds 1e15 rad: whole turns are taken
        off with 50 digits of pi.

    Examples
    --------
    >>> from symtop_ros.physics import Top, regular_precession_rates
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> [round(rate, 2) for rate in regular_precession_rates(top, theta=0.5, psi_dot=200.0)]
    [6.5, 69.82]
    >>> slow, fast = regular_precession_rates(top, theta=0.5, psi_dot=[100.0, 200.0])
    >>> slow.round(2).tolist(), fast.round(2).tolist()
    ([nan, 6.5], [nan, 69.82])
    """
    given = {"theta": theta, "psi_dot": psi_dot}
    theta, psi_dot = validate_together(given, ("rad", "rad/s"))
    largest = float(np.max(np.abs(theta), initial=0.0))
    if largest > LARGEST_TILT:
        raise refuse("theta", f"at most {LARGEST_TILT:g} rad in size", largest)
    if not top.shape and isinstance(theta, float):
        return _solve_regular(*top.moments, theta, psi_dot)
    listed = f"{top.shape} and {np.shape(theta)}"
    shape = fit_shapes("top and theta", top.shape, np.shape(theta), listed=listed)
    arrays = np.broadcast_arrays(*top.moments, theta, psi_dot)
    numbers = zip(*(array.ravel().tolist() for array in arrays), strict=True)
    return stack_rates([_solve_regular(*each) for each in numbers], shape)


def stack_rates(found: Sequence[tuple[float, ...]], shape: tuple[int, ...]) -> tuple[Real, Real]:
    """Return slow and fast rates as arrays (...), with nan for a rate that there is not."""
    rates = np.full((2, len(found)), np.nan)
    for n, each in enumerate(found):
        rates[: len(each), n] = each
    slow, fast = rates.reshape(2, *shape)
    return slow, fast


def _solve_regular(
    Ix: float, Iz: float, Mgl: float, theta: float, psi_dot: float
) -> tuple[float, ...]:
    with localcontext(PRECISE) as context:
        context.prec = 120
        is_horizontal = abs(math.cos(theta)) <= EPS
        cosine = ZERO if is_horizontal else compute_cosine(Decimal(theta))
        transverse, axial = Decimal(Ix) - Decimal(Iz), Decimal(Iz)
        return solve_quadratic(transverse * cosine, axial * Decimal(psi_dot), Decimal(Mgl))


@ignore_underflow
def theta_torque(top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike) -> Real:
    """Return Ix theta''/sin(theta): zero where precession is regular, negative if the top rises.

    Parameters
    ----------
    top : Top
    theta : array_like (...)
        Tilt in rad.
    phi_dot, psi_dot : array_like (...)
        Rates in rad/s.

    Returns
    -------
    ndarray (...)
        (Ix - Iz) cos(theta) phi'^2 - Iz psi' phi' + Mgl, in N m.

    Examples
    --------
    >>> from symtop_ros.physics import Top, theta_torque
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> round(float(theta_torque(top, theta=0.5, phi_dot=9.1, psi_dot=200.0)), 6)
    -0.023692
    """
    theta = validate_array("theta", theta, unit="rad")
    phi_dot, psi_dot = validate_rate("phi_dot", phi_dot), validate_rate("psi_dot", psi_dot)
    return np.asarray(TiltQuadratic.of(top, np.cos(theta), psi_dot).at(phi_dot))


@ignore_underflow
def theta_acceleration(top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike) -> Real:
    """Return theta'' as displayed in the article: sin(theta)/Ix times `theta_torque`.

    Parameters
    ----------
    top : Top
    theta : array_like (...)
        Tilt in rad.
    phi_dot, psi_dot : array_like (...)
        Rates in rad/s.

    Returns
    -------
    ndarray (...)
        theta'' in rad/s^2.

    Examples
    --------
    >>> from symtop_ros.physics import Top, theta_acceleration
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> round(float(theta_acceleration(top, theta=0.5, phi_dot=9.1, psi_dot=200.0)), 1)
    -49.8
    """
    torque = theta_torque(top, theta, phi_dot, psi_dot)
    return np.asarray(np.sin(np.asarray(theta, dtype=float)) / top.Ix * torque)


class FrameTorques(NamedTuple):
    """Torques about the line of nodes in the precessing frame, in N m; positive lowers the axis."""

    gravity: Real
    coriolis: Real
    centrifugal: Real

    @property
    def total(self) -> Real:
        """Their sum, which is Ix theta'' if nothing else acts."""
        return self.gravity + self.coriolis + self.centrifugal


@ignore_underflow
def precessing_frame_torques(
    top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike
) -> FrameTorques:
    """Return what turns the axis up or down for an observer who precesses with the top.

    The observer turns with phi' about the vertical and sees theta' and psi' only. At any theta'

        Ix theta'' = Mgl sin(theta) - Iz psi' phi' sin(theta)
                     + (Ix - Iz) phi'^2 sin(theta) cos(theta),

    gravity's torque and those of the Coriolis and of the centrifugal forces. That of a change of
    phi' is along the other axes: the line of nodes is a principal axis.

    Parameters
    ----------
    top : Top
    theta : array_like (...)
        Tilt in rad.
    phi_dot, psi_dot : array_like (...)
        Rates in rad/s.

    Returns
    -------
    FrameTorques
        `gravity`, `coriolis`, `centrifugal` and their `total`, each an ndarray (...) in N m.

    Examples
    --------
    >>> from symtop_ros.physics import Top, precessing_frame_torques
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> torques = precessing_frame_torques(top, theta=0.5, phi_dot=9.0, psi_dot=200.0)
    >>> [round(float(torque), 5) for torque in (*torques, torques.total)]
    [0.0326, -0.04936, 0.00582, -0.01094]
    """
    theta, phi_dot, psi_dot = np.broadcast_arrays(
        validate_array("theta", theta, unit="rad"),
        validate_rate("phi_dot", phi_dot),
        validate_rate("psi_dot", psi_dot),
    )
    sine = np.sin(theta)
    return FrameTorques(
        np.asarray(top.Mgl * sine),
        np.asarray(-top.Iz * psi_dot * phi_dot * sine),
        np.asarray((top.Ix - top.Iz) * phi_dot**2 * sine * np.cos(theta)),
    )


def solve_quadratic(
    a: float | Decimal, b: float | Decimal, c: float | Decimal
) -> tuple[float, ...]:
    """Return the real roots of a p^2 - b p + c = 0, the one of smaller size first.

    The textbook formula (b -+ sqrt(b^2 - 4 a c))/(2 a) cancels in the slow root, which of a fast
    top is the smaller one by far. Here b/2 and the root of the discriminant are added with equal
    signs: q = b/2 + sign(b) sqrt(b^2/4 - a c). The roots are then c/q and q/a (Press et al.,
    Numerical Recipes, section 5.6). Where roots merge the discriminant cancels. Of doubles it is
    exact with 120 digits, so that the number of roots is right.

    Examples
    --------
    >>> solve_quadratic(1.0, 1e9, 1.0)
    (1e-09, 1000000000.0)
    """
    with localcontext(PRECISE) as context:
        context.prec = 120
        a, b, c = Decimal(a), Decimal(b), Decimal(c)
        if a == 0:
            return _keep_finite(float(c / b)) if b else ()
        half = b / 2 or ZERO  # a spin of -0 is no spin: it changes no order
        discriminant = half * half - a * c
        if discriminant < 0:
            return ()
        q = half + discriminant.sqrt().copy_sign(half)
        if q == 0:
            return (0.0, 0.0)
        return tuple(sorted(_keep_finite(float(c / q), float(q / a)), key=abs))


def _keep_finite(*roots: float) -> tuple[float, ...]:
    return tuple(root for root in roots if math.isfinite(root))
