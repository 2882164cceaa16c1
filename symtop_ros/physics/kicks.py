"""Kicks: instantaneous changes of the angular velocity at fixed attitude.

If phi' changes by delta with theta' and psi' held, the angular velocity changes by delta z' (z' is
the world's vertical). If theta' and the axial momentum are held, only the part of this across the
axis is added. Neither divides by sin(theta), except to find the present phi'.
"""

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top, validate_one
from symtop_ros.physics.values import refuse, validate_number, validate_vector

Hold = Literal["spin_rate", "spin_momentum"]
HOLDS: tuple[Hold, ...] = ("spin_rate", "spin_momentum")


def set_precession_rate(state: State, phi_dot: float, hold: Hold = "spin_rate") -> State:
    """Return the state with a new precession rate phi', theta' held.

    Parameters
    ----------
    state : State
        One state.
    phi_dot : float
        New precession rate in rad/s.
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
    rate = validate_number("phi_dot", phi_dot, "rad/s")
    hold = validate_hold(hold)
    change = (rate - precession_rate(state)) * state.vertical
    if hold == "spin_momentum":
        change[2] = 0.0
    return State(state.orientation, state.angular_velocity + change)


def hurry(state: State, factor: float = 1.4, hold: Hold = "spin_rate") -> State:
    """Return the state with phi' multiplied by a factor.

    Parameters
    ----------
    state : State
        One state.
    factor : float
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
    """
    factor = validate_number("factor", factor)
    return set_precession_rate(state, factor * precession_rate(state), hold)


def apply_impulse(top: Top, state: State, impulse: ArrayLike) -> State:
    """Return the state after an angular impulse is added to the angular momentum.

    Parameters
    ----------
    top : Top
        The top: its moments of inertia turn a momentum into an angular velocity.
    state : State
        One state.
    impulse : array_like (3,)
        Angular impulse in the world frame, in N m s.

    Raises
    ------
    ValueError
        If the impulse is not 3 finite numbers.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, apply_impulse
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> state = State.from_euler(theta=0.0, psi_dot=200.0)
    >>> apply_impulse(top, state, (0.000228, 0, 0)).angular_velocity.tolist()
    [1.0, 0.0, 200.0]
    """
    validate_one(top)
    J = validate_vector("impulse", impulse, "N m s, world frame")
    change = state.to_body(J) / np.array([top.Ix, top.Ix, top.Iz])
    return State(state.orientation, state.angular_velocity + change)


def precession_rate(state: State) -> float:
    """Return phi' of one state in rad/s.

    Parameters
    ----------
    state : State
        One state.

    Raises
    ------
    ValueError
        If the axis is vertical, where phi' is undefined.

    Examples
    --------
    >>> from symtop_ros.physics import State, precession_rate
    >>> precession_rate(State.from_euler(theta=0.5, phi_dot=4.0))
    4.0
    """
    if state.orientation.ndim != 1:
        raise refuse("state", "one state", f"{state.orientation.shape[:-1]} states")
    if state.is_vertical:
        condition = "tilted (phi' is undefined on the vertical; an angular impulse works there)"
        raise refuse("axis", condition, f"theta = {state.euler_angles.theta:g} rad")
    return float(state.euler_rates.phi)


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
