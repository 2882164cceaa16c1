"""Kicks: instantaneous changes of the angular velocity at fixed attitude.

A change of phi' by delta with theta' and psi' held adds delta to the angular velocity about z';
with theta' and the axial momentum held it adds the part of that which lies across the axis.
Neither needs sin(theta), except to say what phi' was.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top

Hold = Literal["spin_rate", "spin_momentum"]
HOLDS: tuple[Hold, ...] = ("spin_rate", "spin_momentum")


def set_precession_rate(top: Top, state: State, phi_dot: float, hold: Hold = "spin_rate") -> State:
    """Return the state with another precession rate phi' (rad/s), theta' held.

    Parameters
    ----------
    top : Top
    state : State
        One state.
    phi_dot : float
        New precession rate in rad/s.
    hold : {"spin_rate", "spin_momentum"}
        What else is held: psi' (the article's comparison), or L_z = Iz omega_z (a push on the axle,
        which cannot change it; psi' then changes by -delta phi' cos(theta)).

    Raises
    ------
    ValueError
        Where the axis is vertical, so that phi' is undefined, or an argument is not allowed.
    """
    _check(phi_dot, hold)
    delta = phi_dot - precession_rate(state)
    change = delta * state.vertical
    if hold == "spin_momentum":
        change[2] = 0.0
    return State(state.orientation, state.angular_velocity + change)


def hurry(top: Top, state: State, factor: float = 1.4, hold: Hold = "spin_rate") -> State:
    """Return the state with phi' multiplied by `factor`; else as set_precession_rate."""
    if not math.isfinite(factor):
        msg = f"factor: got {factor}, allowed is a finite number"
        raise ValueError(msg)
    return set_precession_rate(top, state, factor * precession_rate(state), hold)


def push(top: Top, state: State, factor: float = 1.4) -> State:
    """Hurry by a push on the axle: the axial momentum L_z is held."""
    return hurry(top, state, factor, "spin_momentum")


def impulse(top: Top, state: State, angular_impulse: ArrayLike) -> State:
    """Return the state after an angular impulse (3,) in N m s, world frame, is added to L."""
    J = np.asarray(angular_impulse, dtype=float)
    if J.shape != (3,) or not np.isfinite(J).all():
        msg = (
            f"angular_impulse: got {angular_impulse!r}, allowed are 3 finite numbers (N m s, world)"
        )
        raise ValueError(msg)
    change = state.to_body(J) / np.array([top.Ix, top.Ix, top.Iz])
    return State(state.orientation, state.angular_velocity + change)


def precession_rate(state: State) -> float:
    """Phi' in rad/s of one state; ValueError on the vertical, where it is undefined."""
    x, y = state.vertical[:2]
    if x == 0 and y == 0:
        msg = (
            "the axis is vertical: the precession rate phi' is undefined there, "
            "allowed is an angular impulse"
        )
        raise ValueError(msg)
    return float(state.euler_rates.phi)


def _check(phi_dot: float, hold: str) -> None:
    if not math.isfinite(phi_dot):
        msg = f"phi_dot: got {phi_dot}, allowed is a finite number (rad/s)"
        raise ValueError(msg)
    if hold not in HOLDS:
        msg = f"hold: got {hold!r}, allowed is {' or '.join(map(repr, HOLDS))}"
        raise ValueError(msg)
