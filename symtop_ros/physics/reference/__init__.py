"""The motion to any number of digits, slowly: what the numbers of the kernel are compared with.

`exact_state` has states as balls, numbers with a proved radius: under gravity by `fall`, with
friction and torques by `enclosure`, whose polynomials come from `series`. `exact_constants` has
what is constant under gravity.

Of `symtop_ros.physics` only certificates import this, when one is asked for, and it uses no number
of the kernel. It needs python-flint: `pip install -e '.[reference]'` in a checkout.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from symtop_ros.physics.reference.balls import ProvedState
from symtop_ros.physics.reference.constants import (
    ProvedConstants,
    prove_constants,
    prove_held_constants,
)
from symtop_ros.physics.reference.proved import prove_state
from symtop_ros.physics.reference.series import Inputs
from symtop_ros.physics.times import SECOND, ExactTimes

if TYPE_CHECKING:
    from symtop_ros.physics.state import State
    from symtop_ros.physics.top import Friction, Top

__all__ = ["ProvedConstants", "ProvedState", "exact_constants", "exact_state"]


def exact_state(
    top: Top,
    start: State,
    t: float | ExactTimes,
    digits: int = 50,
    friction: Friction | None = None,
    torque: Sequence[float] = (0.0, 0.0, 0.0),
) -> ProvedState:
    """Return the state of a motion at a time as balls: numbers with a proved radius.

    The motion under gravity alone has a closed form. With friction or a torque it is integrated by
    Taylor series, which takes a time proportional to `t`: half a minute for 10 s of a top of 200
    rad/s.

    Parameters
    ----------
    top : Top
        One top; its doubles are taken as exact.
    start : State
        The state at t = 0. Its `given_orientation` is normalised with all digits.
    t : float or ExactTimes
        Time in s, of any sign, or one exact time.
    digits : int
        The radius is at most 10^-digits for the quaternion, and at most 10^-digits of the `size` of
        the state for the angular velocity.
    friction : Friction, optional
        Friction at the pivot and in the air.
    torque : sequence of three floats
        A constant torque in the world frame, in N m.

    Returns
    -------
    ProvedState
        Orientation and angular velocity, each of `flint.arb`; `print` has all digits.

    Raises
    ------
    ValueError
        If the top or the start are many, the time is not one finite number, the torque is not three
        numbers, or digits are not positive.
    ArithmeticError
        If more than 200 000 bits are needed.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top
    >>> from symtop_ros.physics.reference import exact_state
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> cusps = State.from_euler(theta=0.5, psi_dot=200.0)
    >>> exact_state(top, cusps, 10.0).orientation[0].str(25, radius=False)
    '0.5831799034733807704174033'
    """
    _check(top, start, digits)
    if len(torque) != 3 or not all(map(math.isfinite, torque)):
        raise ValueError(f"torque must be three finite numbers, got {torque}")
    drag = friction.coefficients if friction else (0.0, 0.0)
    return prove_state(Inputs.of(top, start), _read_time(t), digits, drag, torque)


def exact_constants(
    top: Top, start: State, digits: int = 50, clamped: bool = False
) -> ProvedConstants:
    """Return kind, period, turning angles and mean rates of a motion under gravity as balls.

    Parameters
    ----------
    top : Top
        One top.
    start : State
        The state at t = 0.
    digits : int
        Radii are at most 10^-digits: for angles in rad, for the period relative to the period, and
        for the rates relative to the larger rate.
    clamped : bool
        True if a hand holds phi, as in `Motion`.

    Returns
    -------
    ProvedConstants
        The constants; the kind is decided in fractions.

    Raises
    ------
    ValueError
        If the top or the start are many, digits are not positive, or a clamped axis is vertical.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top
    >>> from symtop_ros.physics.reference import exact_constants
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> found = exact_constants(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> found.kind, found.period.str(20, radius=False)
    ('cusps', '0.15954481400192355269')
    """
    _check(top, start, digits)
    inputs = Inputs.of(top, start)
    if not clamped:
        return prove_constants(inputs, digits)
    if start.is_vertical:
        raise ValueError(
            "start must be tilted for a clamped motion: phi is undefined on the vertical"
        )
    return prove_held_constants(inputs, digits)


def _check(top: Top, start: State, digits: int) -> None:
    if top.shape or start.given_orientation.shape != (4,):
        shapes = f"shapes {top.shape} and {start.given_orientation.shape[:-1]}"
        raise ValueError(f"top and start must be those of one motion, got {shapes}")
    if digits < 1:
        raise ValueError(f"digits must be 1 or more, got {digits}")


def _read_time(t: float | ExactTimes) -> float | Fraction:
    if isinstance(t, ExactTimes):
        if not isinstance(t.nanoseconds, int):
            raise ValueError(f"t must be one time, got shape {t.shape}")
        return t.advance(t.nanoseconds) / SECOND
    if not math.isfinite(t):
        raise ValueError(f"t must be a finite number, got {t} s")
    return t
