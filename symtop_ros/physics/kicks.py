"""Kicks: instantaneous changes of the angular velocity at fixed attitude.

If phi' changes by delta with theta' and psi' held, the angular velocity changes by delta z' (z' is
the world's vertical). If theta' and the axial momentum are held, only the part of this across the
axis is added. Neither divides by sin(theta), except to find the present phi'.
"""

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.arrays import Real, split
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top, match
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    fit_shapes,
    ignore_underflow,
    refuse,
    validate_array,
    validate_numbers,
    validate_rate,
    validate_vector,
)

Hold = Literal["spin_rate", "spin_momentum"]
HOLDS: tuple[Hold, ...] = ("spin_rate", "spin_momentum")


def set_precession_rate(state: State, phi_dot: ArrayLike, hold: Hold = "spin_rate") -> State:
    """Return the state with a new precession rate phi', theta' held.

    Parameters
    ----------
    state : State
        One state, or many of shape (...).
    phi_dot : float or array_like (...)
        New precession rate in rad/s; states and rates are broadcast together.
    hold : {"spin_rate", "spin_momentum"}
        The second quantity that is held: psi' (the article's comparison) or L_z = Iz omega_z (a
        push on the axle, which cannot change it; psi' then changes by -delta phi' cos(theta)).

    Raises
    ------
    ValueError
        If the axis is vertical, where phi' is undefined, or if an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import State, set_precession_rate
    >>> state = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
    >>> rates = set_precession_rate(state, 9.1).euler_rates
    >>> round(rates.phi, 9), round(rates.psi, 9)
    (9.1, 200.0)
    """
    rate, hold = validate_rate("phi_dot", phi_dot), validate_hold(hold)
    _validate_fit(state, np.shape(rate))
    change = np.asarray(rate - precession_rate(state))[..., np.newaxis] * state.vertical
    if hold == "spin_momentum":
        change[..., 2] = 0.0
    return _add(state, change)


def hurry(state: State, factor: ArrayLike = 1.4, hold: Hold = "spin_rate") -> State:
    """Return the state with phi' multiplied by a factor.

    Parameters
    ----------
    state : State
        One state, or many of shape (...).
    factor : float or array_like (...)
        Above 1 it hurries the precession, between 0 and 1 it delays it.
    hold : {"spin_rate", "spin_momentum"}
        As in `set_precession_rate`.

    Raises
    ------
    ValueError
        As in `set_precession_rate`.

    Examples
    --------
    >>> from symtop_ros.physics import State, hurry
    >>> state = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
    >>> round(hurry(state, factor=1.4).euler_rates.phi, 9)
    9.1
    >>> hurry(state, hold="spin_momentum").angular_velocity[2] == state.angular_velocity[2]
    np.True_
    >>> hurry(state, factor=[1.1, 1.2]).euler_rates.phi.round(9).tolist()
    [7.15, 7.8]
    """
    factor = validate_numbers("factor", factor)
    _validate_fit(state, np.shape(factor))
    with np.errstate(over="ignore", under="ignore"):  # a rate that is too large is refused
        return set_precession_rate(state, factor * precession_rate(state), hold)


def apply_impulse(top: Top, state: State, impulse: ArrayLike) -> State:
    """Return the state after an angular impulse is added to the angular momentum.

    Parameters
    ----------
    top : Top
        The top: its moments of inertia turn a momentum into an angular velocity; one or many of
        shape (...).
    state : State
        One state, or many of shape (...).
    impulse : array_like (..., 3)
        Angular impulse in the world frame, in N m s; tops, states and impulses are broadcast
        together.

    Raises
    ------
    ValueError
        If the impulse is not 3 finite numbers, or makes a top faster than 1e100 rad/s.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, apply_impulse
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> state = State.from_euler(theta=0.0, psi_dot=200.0)
    >>> apply_impulse(top, state, (0.000228, 0, 0)).angular_velocity.tolist()
    [1.0, 0.0, 200.0]
    """
    unit = "N m s, world frame"
    if np.ndim(impulse) <= 1:
        J = np.array(validate_vector("impulse", impulse, unit))
    else:
        J = validate_array("impulse", impulse, 3, unit)
    _validate_fit(state, J.shape[:-1])
    x, y, z = split(state.to_body(J))
    Ix, Iz = match(top.Ix, state), match(top.Iz, state)
    with np.errstate(over="ignore", under="ignore"):
        change = np.stack(np.broadcast_arrays(x / Ix, y / Ix, z / Iz), axis=-1)
    if not (np.abs(change) <= LARGEST_ANGULAR_VELOCITY).all():
        condition = f"so small that no rate changes by more than {LARGEST_ANGULAR_VELOCITY:g} rad/s"
        raise refuse("impulse", condition, f"{float(np.abs(J).max()):g} {unit}")
    return _add(state, change)


def _add(state: State, change: Real) -> State:
    """Return states with a change of their angular velocity, (..., 3), in the body frame."""
    omega = state.angular_velocity + change
    kicked = State(np.broadcast_to(state.orientation, (*omega.shape[:-1], 4)), omega)
    vars(kicked)["time_axes"] = state.time_axes
    return kicked


def _validate_fit(state: State, shape: tuple[int, ...]) -> None:
    states = state.orientation.shape[:-1]
    fit_shapes("state and kick", states, shape, listed=f"{states} and {shape}")


@ignore_underflow
def precession_rate(state: State) -> Any:
    """Return phi' in rad/s, a float or (...).

    Parameters
    ----------
    state : State
        One state, or many of shape (...).

    Raises
    ------
    ValueError
        If an axis is vertical, where phi' is undefined.

    Examples
    --------
    >>> from symtop_ros.physics import State, precession_rate
    >>> precession_rate(State.from_euler(theta=0.5, phi_dot=4.0))
    4.0
    """
    if np.any(state.is_vertical):
        condition = "tilted (phi' is undefined on the vertical; an angular impulse works there)"
        theta = float(np.extract(state.is_vertical, state.euler_angles.theta)[0])
        raise refuse("axis", condition, f"theta = {theta:g} rad")
    return state.euler_rates.phi


def validate_hold(hold: Any) -> Hold:
    """Return what a kick holds.

    Parameters
    ----------
    hold : {"spin_rate", "spin_momentum"}
        The argument of a kick.

    Raises
    ------
    ValueError
        If it is anything else.

    Examples
    --------
    >>> from symtop_ros.physics import validate_hold
    >>> validate_hold("spin")
    Traceback (most recent call last):
    ValueError: hold must be 'spin_rate' or 'spin_momentum', got 'spin'
    """
    for each in HOLDS:
        if isinstance(hold, str) and hold == each:
            return each
    raise refuse("hold", " or ".join(map(repr, HOLDS)), repr(hold))
