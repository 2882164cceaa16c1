"""The motion to any number of digits, slowly: what the numbers of the kernel are compared with.

Of `symtop_ros.physics` only certificates import this, when one is asked for, and it uses no number
of the kernel. It is written to
be read next to docs/derivation.md, and needs mpmath: `pip install -e '.[reference]'` in a checkout.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from mpmath import mp

from symtop_ros.physics.reference.closed_form import ClosedForm
from symtop_ros.physics.reference.series import ExactState, Inputs, Number, Series

if TYPE_CHECKING:
    from symtop_ros.physics.state import State
    from symtop_ros.physics.top import Friction, Top

__all__ = ["ClosedForm", "ExactState", "Inputs", "Series", "exact_state"]


def exact_state(
    top: Top,
    start: State,
    t: float,
    digits: int = 50,
    friction: Friction | None = None,
    torque: Sequence[float] = (0.0, 0.0, 0.0),
) -> ExactState:
    """Return the state of a motion at a time to any number of digits.

    The motion under gravity alone has a closed form. With friction or a torque it is integrated by
    Taylor series, which takes time in proportion to `t`. Either is computed with more and more
    digits, until two states agree to those that are asked for.

    Parameters
    ----------
    top : Top
        One top; its doubles are taken as exact.
    start : State
        The state at t = 0. Its `given_orientation` is normalised with all digits.
    t : float
        Time in s, of any sign.
    digits : int
        Decimal digits of the result: of the quaternion, and of the angular velocity relative to its
        size, as long as friction leaves a part of 10^-digits of that.
    friction : Friction, optional
        Friction at the pivot and in the air.
    torque : sequence of three floats
        A constant torque in the world frame, in N m.

    Raises
    ------
    ValueError
        If the top or the start are many, the time is not finite, or digits are not positive.

    Examples
    --------
    >>> from mpmath import nstr
    >>> from symtop_ros.physics import State, Top
    >>> from symtop_ros.physics.reference import exact_state
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> cusps = State.from_euler(theta=0.5, psi_dot=200.0)
    >>> nstr(exact_state(top, cusps, 10.0).orientation[0], 25)
    '0.5831799034733807704174033'
    """
    _check(top, start, t, digits)
    inputs, working = Inputs.of(top, start), digits + 15
    drag = friction.coefficients if friction else (0.0, 0.0)

    def compute() -> ExactState:
        if any(drag) or any(torque):
            return Series(inputs, working, drag, torque).at(t)
        return ClosedForm(inputs, working).at(t)

    found, before = compute(), None
    swing = float(abs(inputs.Mgl) / inputs.Ix) ** 0.5
    fastest = swing + float(max(map(abs, inputs.angular_velocity)))
    while before is None or not _agree(found, before, digits, fastest):
        working += 15
        found, before = compute(), found
    return found


def _check(top: Top, start: State, t: float, digits: int) -> None:
    if top.shape or start.given_orientation.shape != (4,):
        shapes = f"shapes {top.shape} and {start.given_orientation.shape[:-1]}"
        raise ValueError(f"top and start must be those of one motion, got {shapes}")
    if not math.isfinite(t):
        raise ValueError(f"t must be a finite number, got {t} s")
    if digits < 1:
        raise ValueError(f"digits must be 1 or more, got {digits}")


def _agree(found: ExactState, before: ExactState, digits: int, fastest: float) -> bool:
    """Return True if quaternions, and rates relative to their size, agree to so many digits."""
    with mp.workdps(digits + 10):
        pairs = zip(found, before, strict=True)
        apart = [mp.norm([a - b for a, b in zip(*each, strict=True)]) for each in pairs]
        least: Number = mp.mpf(10) ** -digits
        size = mp.norm(found.angular_velocity) + least * fastest
        return bool(apart[0] < least and apart[1] <= least * size)
