"""Regular precession, and the angular acceleration of the tilt that it balances.

The formulas are in the kernel (`kernel/rule/regular.hpp`).

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

from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.base.one_or_many import Many
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    are_floats,
    fit_shapes,
    validate_array,
    validate_rate,
    validate_together,
)


@overload
def regular_precession_rates(
    top: Top[float], theta: float, psi_dot: float
) -> tuple[float, float]: ...


@overload
def regular_precession_rates(
    top: Top[Real], theta: ArrayLike, psi_dot: ArrayLike
) -> tuple[Real, Real]: ...


@overload
def regular_precession_rates(top: Top, theta: Many, psi_dot: ArrayLike) -> tuple[Real, Real]: ...


@overload
def regular_precession_rates(top: Top, theta: ArrayLike, psi_dot: Many) -> tuple[Real, Real]: ...


def regular_precession_rates(
    top: Top, theta: ArrayLike, psi_dot: ArrayLike
) -> tuple[float | Real, float | Real]:
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
    slow, fast : float or ndarray (...)
        In rad/s, with |slow| <= |fast|; nan for a rate that does not exist. If the equation is
        linear, as for a horizontal axis, there is no fast rate; if the spin is too small, there is
        neither. The rates are the doubles nearest to the exact rates of the given doubles, except
        that |cos(theta)| <= 2.2e-16 counts as zero, because no double is exactly pi/2.

    Raises
    ------
    ValueError
        If an argument is not a finite number.

    Examples
    --------
    >>> from symtop_ros.physics import Top, regular_precession_rates
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> [round(rate, 2) for rate in regular_precession_rates(top, theta=0.5, psi_dot=200.0)]
    [6.5, 69.82]
    >>> import math
    >>> slow, fast = regular_precession_rates(top, theta=math.pi / 2, psi_dot=200.0)
    >>> round(slow, 2), fast
    (5.94, nan)
    >>> slows, fasts = regular_precession_rates(top, theta=0.5, psi_dot=[100.0, 200.0])
    >>> slows.round(2).tolist(), fasts.round(2).tolist()
    ([nan, 6.5], [nan, 69.82])
    """
    theta, psi_dot = validate_together({"theta": theta, "psi_dot": psi_dot}, ("rad", "rad/s"))
    shape, (tops, thetas, spins) = spread_tops(top, theta, psi_dot)
    rates = bindings.find_regular_rates(tops, thetas, spins, hold=0)
    if not shape:
        slow, fast = rates[0].tolist()
        return slow, fast
    slow, fast = (np.ascontiguousarray(rates[:, k]).reshape(shape) for k in range(2))
    return slow, fast


def spread_tops(top: Top, *columns: Any) -> tuple[tuple[int, ...], list[Real]]:
    """Return the shape of all arguments together, the tops (n, 3), and the others (n,)."""
    if not top.shape and are_floats(columns):
        return (), [np.array([each]) for each in (top.moments, *columns)]
    shapes = [top.shape, *map(np.shape, columns)]
    listed = f"{top.shape} and {next(filter(None, shapes[1:]), ())}"
    shape = fit_shapes("top and theta", *shapes, listed=listed)
    flat = [np.array(np.broadcast_to(each, shape)).reshape(-1) for each in (*top.moments, *columns)]
    return shape, [np.stack(flat[:3], axis=-1), *flat[3:]]


@bindings.compute_soundly
def theta_torque(top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike) -> Real:
    """Return Ix theta''/sin(theta): zero in regular precession, negative if theta'' is.

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
    gravity, coriolis, centrifugal, _ = _find_tilt_torques(top, theta, phi_dot, psi_dot)
    return np.asarray(centrifugal + coriolis + gravity)


def _find_tilt_torques(top: Top, theta: Any, phi_dot: Any, psi_dot: Any) -> list[Real]:
    """Return gravity, Coriolis and centrifugal torque over sin(theta), and sin(theta), (...)."""
    shape, columns = spread_tops(
        top,
        validate_array("theta", theta, unit="rad"),
        validate_rate("phi_dot", phi_dot),
        validate_rate("psi_dot", psi_dot),
    )
    found = bindings.find_tilt_torques(*columns).T
    return [np.ascontiguousarray(each).reshape(shape) for each in found]


@bindings.compute_soundly
def theta_acceleration(top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike) -> Real:
    """Return theta'' as in the article: sin(theta)/Ix times `theta_torque`.

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
    *torques, sine = _find_tilt_torques(top, theta, phi_dot, psi_dot)
    return np.asarray(sine / top.Ix * (torques[2] + torques[1] + torques[0]))


class FrameTorques(NamedTuple):
    """Torques about the line of nodes in the precessing frame, in N m; positive lowers the axis."""

    gravity: Real
    coriolis: Real
    centrifugal: Real

    @property
    def total(self) -> Real:
        """Sum of the three torques: Ix theta'' if no other torque acts."""
        return self.gravity + self.coriolis + self.centrifugal


@bindings.compute_soundly
def precessing_frame_torques(
    top: Top, theta: ArrayLike, phi_dot: ArrayLike, psi_dot: ArrayLike
) -> FrameTorques:
    """Return the torques about the line of nodes for an observer who precesses with the top.

    The observer turns with phi' about the vertical and sees theta' and psi' only. For any theta',

        Ix theta'' = Mgl sin(theta) - Iz psi' phi' sin(theta)
                     + (Ix - Iz) phi'^2 sin(theta) cos(theta),

    the torques of gravity, of the Coriolis force and of the centrifugal force. The force that a
    change of phi' causes (the Euler force) has no torque about the line of nodes, which is a
    principal axis.

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
    *torques, sine = _find_tilt_torques(top, theta, phi_dot, psi_dot)
    return FrameTorques(*(np.asarray(torque * sine) for torque in torques))
