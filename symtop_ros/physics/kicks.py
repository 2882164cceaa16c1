"""Kicks: instantaneous changes of the angular velocity at fixed attitude.

The formulas are in the kernel (`kernel/rule/kicks.hpp`).
"""

from typing import Any, get_args, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.base.one_or_many import Many, N
from symtop_ros.base.refusals import Words, refuse
from symtop_ros.physics.kernel import bindings, records
from symtop_ros.physics.kernel.records import Hold, KickKind
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    fit_shapes,
    validate_numbers,
    validate_rate,
    validate_vectors,
)

HOLDS: tuple[Hold, ...] = get_args(Hold)
ANY_TOP = np.ones(3)  # a change of phi' asks for no top


@overload
def set_precession_rate(state: State[N], phi_dot: float, hold: Hold = "spin_rate") -> State[N]: ...


@overload
def set_precession_rate(state: State, phi_dot: Many, hold: Hold = "spin_rate") -> State[Real]: ...


def set_precession_rate(state: State, phi_dot: ArrayLike, hold: Hold = "spin_rate") -> State:
    """Return the state with a new precession rate phi' and the same theta'.

    Parameters
    ----------
    state : State
        One state, or many of shape (...).
    phi_dot : float or array_like (...)
        New precession rate in rad/s; states and rates are broadcast together.
    hold : {"spin_rate", "spin_momentum"}
        The second quantity that is held: psi' (the article's comparison) or L_z = Iz omega_z (a
        push on the axle, which cannot change it; psi' then changes by -delta phi' cos(theta)).

    Returns
    -------
    State
        Its phi' differs from the new rate by at most 15 eps (eps is 2^-52) times the angular
        velocity (the larger one of before and after) divided by sin(theta). So next to the vertical
        phi' may have few correct digits.

    Raises
    ------
    ValueError
        If the axis is vertical, where phi' is undefined, or if an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import State, set_precession_rate
    >>> state = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
    >>> rates = set_precession_rate(state, 9.1).euler_rates
    >>> round(rates.phi_dot, 9), round(rates.psi_dot, 9)
    (9.1, 200.0)
    """
    rate, hold = validate_rate("phi_dot", phi_dot), validate_hold(hold)
    return _kick(ANY_TOP, state, "rate", hold, rate, "phi_dot")


@overload
def hurry(state: State[N], factor: float = 1.4, hold: Hold = "spin_rate") -> State[N]: ...


@overload
def hurry(state: State, factor: Many, hold: Hold = "spin_rate") -> State[Real]: ...


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
    >>> round(hurry(state, factor=1.4).euler_rates.phi_dot, 9)
    9.1
    >>> hurry(state, hold="spin_momentum").angular_velocity[2] == state.angular_velocity[2]
    np.True_
    >>> hurry(state, factor=[1.1, 1.2]).euler_rates.phi_dot.round(9).tolist()
    [7.15, 7.8]
    """
    factor, hold = validate_numbers("factor", factor), validate_hold(hold)
    return _kick(ANY_TOP, state, "factor", hold, factor, "factor")


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
    J = validate_vectors("impulse", impulse, "N m s, world frame")
    return _kick(_stack_moments(top), state, "impulse", "spin_rate", J, "impulse")


@overload
def push_axle(top: Top[float], state: State[N], impulse: float) -> State[N]: ...


@overload
def push_axle(top: Top[Real], state: State, impulse: ArrayLike) -> State[Real]: ...


@overload
def push_axle(top: Top, state: State, impulse: Many) -> State[Real]: ...


def push_axle(top: Top, state: State, impulse: ArrayLike) -> State:
    """Return the state after a horizontal push on the axle in the direction of increasing phi.

    It keeps theta' and p_psi = L_z: its angular impulse is perpendicular to the axle, in the
    vertical plane of the axle.

    Parameters
    ----------
    top : Top
        The top: its moment Ix turns an impulse into an angular velocity; one or many of shape
        (...).
    state : State
        One state, or many of shape (...).
    impulse : float or array_like (...)
        Angular impulse in N m s: the impulse of the push times its distance from the pivot;
        negative for a push to the other side.

    Raises
    ------
    ValueError
        If the axis is vertical, where phi is undefined, or if an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, push_axle
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> state = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
    >>> pushed = push_axle(top, state, 0.00005)
    >>> round(float(pushed.euler_rates.phi_dot), 6)
    6.957419
    >>> pushed.angular_velocity[2] == state.angular_velocity[2]
    np.True_
    """
    amount = validate_numbers("impulse", impulse, "N m s")
    return _kick(_stack_moments(top), state, "axle", "spin_momentum", amount, "impulse")


def _stack_moments(top: Top) -> Real:
    return np.stack([np.asarray(each) for each in top.moments], axis=-1)


def _kick(tops: Real, state: State, kind: KickKind, hold: Hold, amounts: Any, name: str) -> State:
    """Return states after kicks of one kind; tops, states and amounts are broadcast together.

    A kick leaves the attitude unchanged, with the digits that were given.
    """
    given = np.asarray(amounts, np.float64)
    axes = given.ndim - (kind == "impulse")
    parts: tuple[Real, ...] = (tops, *state._parts, given)
    if axes or tops.ndim > 1 or state.orientation.ndim > 1:
        parts = _spread(parts, axes)
    rows, orientation, omega, given = parts
    how = records.KICK_KINDS.index(kind), records.HOLDS.index(hold)
    kicked, done, status = bindings.kick(rows, orientation, omega, *how, given)
    if status == records.OK:
        attitude = state.given_orientation
        if attitude.shape != orientation.shape:
            attitude = np.broadcast_to(attitude, orientation.shape)
        return State._wrap(orientation, kicked, attitude)
    flat = [part.reshape(-1, width) for part, width in zip(parts[1:3], (4, 3), strict=True)]
    if status == records.VERTICAL:
        raise _refuse_vertical(State._wrap(*(part[done].copy() for part in flat)))
    if status == records.BAD_KICK:
        raise refuse(
            name,
            f"so small that rates stay within {LARGEST_ANGULAR_VELOCITY:g} rad/s",
            float(np.abs(given.reshape(len(flat[0]), -1)[done]).max()),
        )
    raise bindings.refuse_status(status)


def _spread(parts: tuple[Real, ...], axes: int) -> tuple[Real, ...]:
    """Return copies of one shape of tops, orientations, angular velocities and amounts."""
    shapes = [part.shape[:-1] for part in parts[:3]] + [parts[3].shape[:axes]]
    given = dict.fromkeys(filter(None, shapes))  # those of more than one
    shape = fit_shapes("state and kick", *shapes, listed=" and ".join(map(str, given)))
    widths = [part.shape[-1:] for part in parts[:3]] + [parts[3].shape[axes:]]
    return tuple(
        np.array(np.broadcast_to(part, shape + width))
        for part, width in zip(parts, widths, strict=True)
    )


def precession_rate(state: State[N]) -> N:
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
        raise _refuse_vertical(
            state if state.orientation.ndim == 1 else state[state.is_vertical][0]
        )
    return state.euler_rates.phi_dot


def _refuse_vertical(state: State) -> ValueError:
    return refuse(
        "axis",
        "tilted (phi' is undefined on the vertical; an angular impulse works there)",
        Words(f"theta = {state.euler_angles.theta:g} rad"),
    )


def validate_hold(hold: Any) -> Hold:
    """Return what a kick holds, if it is valid.

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
    symtop_ros.base.refusals.RefusedError: hold must be 'spin_rate' or 'spin_momentum', got 'spin'
    """
    for each in HOLDS:
        if isinstance(hold, str) and hold == each:
            return each
    raise refuse("hold", " or ".join(map(repr, HOLDS)), hold)
