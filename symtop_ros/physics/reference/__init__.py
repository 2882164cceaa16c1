"""The motion to any number of digits, slowly: what the numbers of the kernel are compared with.

`exact_state` has states as balls, numbers with a proved radius: under gravity by `fall`, with
friction and torques by `enclosure`. `closed_form` and `series` give the same motions in mpmath;
the first is written to be read next to docs/derivation.md.

Of `symtop_ros.physics` only certificates import this, when one is asked for, and it uses no number
of the kernel. It needs python-flint and mpmath: `pip install -e '.[reference]'` in a checkout.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from symtop_ros.physics.reference.balls import ProvedState
from symtop_ros.physics.reference.closed_form import ClosedForm
from symtop_ros.physics.reference.proved import prove_state
from symtop_ros.physics.reference.series import ExactState, Inputs, Series

if TYPE_CHECKING:
    from symtop_ros.physics.state import State
    from symtop_ros.physics.top import Friction, Top

__all__ = ["ClosedForm", "ExactState", "Inputs", "ProvedState", "Series", "exact_state"]


def exact_state(
    top: Top,
    start: State,
    t: float,
    digits: int = 50,
    friction: Friction | None = None,
    torque: Sequence[float] = (0.0, 0.0, 0.0),
) -> ProvedState:
    """Return the state of a motion at a time as balls: numbers with a radius that is a proof.

    The motion under gravity alone has a closed form. With friction or a torque it is integrated by
    Taylor series, which takes time in proportion to `t`: 10 s of a top of 200 rad/s half a minute.

    Parameters
    ----------
    top : Top
        One top; its doubles are taken as exact.
    start : State
        The state at t = 0. Its `given_orientation` is normalised with all digits.
    t : float
        Time in s, of any sign.
    digits : int
        The radius is 10^-digits at most: of the quaternion, and of the angular velocity relative to
        the `size` of the state.
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
        If the top or the start are many, the time is not finite, or digits are not positive.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top
    >>> from symtop_ros.physics.reference import exact_state
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> cusps = State.from_euler(theta=0.5, psi_dot=200.0)
    >>> exact_state(top, cusps, 10.0).orientation[0].str(25, radius=False)
    '0.5831799034733807704174033'
    """
    _check(top, start, t, digits)
    drag = friction.coefficients if friction else (0.0, 0.0)
    return prove_state(Inputs.of(top, start), t, digits, drag, torque)


def _check(top: Top, start: State, t: float, digits: int) -> None:
    if top.shape or start.given_orientation.shape != (4,):
        shapes = f"shapes {top.shape} and {start.given_orientation.shape[:-1]}"
        raise ValueError(f"top and start must be those of one motion, got {shapes}")
    if not math.isfinite(t):
        raise ValueError(f"t must be a finite number, got {t} s")
    if digits < 1:
        raise ValueError(f"digits must be 1 or more, got {digits}")
