"""States as balls whose radius is a proof, and proved bounds of the errors of doubles.

Under gravity alone by `fall`, in closed form; with friction or a torque by `enclosure`. What is
computed in balls is computed with more bits until they are small.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction

from flint import arb, ctx

from symtop_ros.physics.reference.balls import Ball, ProvedState, norm, refine
from symtop_ros.physics.reference.enclosure import NO_DRIVE, Enclosure
from symtop_ros.physics.reference.fall import find_fall
from symtop_ros.physics.reference.series import Inputs

BITS_PER_DIGIT = math.log2(10)
ERROR_BITS = 256  # in which errors of doubles are computed
Solve = Callable[[Fraction], ProvedState]


def prove_state(
    inputs: Inputs,
    t: float | Fraction,
    digits: int = 30,
    friction: Sequence[float] = NO_DRIVE[0],
    torque: Sequence[float] = NO_DRIVE[1],
) -> ProvedState:
    """Return the state at a time as balls, each with a radius that is a proof.

    Parameters
    ----------
    inputs : Inputs
        A top and its start, as exact fractions.
    t : float or Fraction
        Time in s, of any sign.
    digits : int
        The radius is 10^-digits at most, of rates relative to the `size` of the state.
    friction : (float, float)
        Axial and transverse coefficient in N m s.
    torque : (float, float, float)
        A constant torque in the world frame, in N m.

    Returns
    -------
    ProvedState
        Orientation and angular velocity.

    Raises
    ------
    ValueError
        If the time is not finite.
    TooFewBitsError
        If more than 200 000 bits are needed.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top
    >>> from symtop_ros.physics.reference.series import Inputs
    >>> from symtop_ros.physics.reference.proved import prove_state
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> cusps = State.from_euler(theta=0.5, psi_dot=200.0)
    >>> found = prove_state(Inputs.of(top, cusps), 10.0)
    >>> print(found.orientation[0].str(20, radius=False))
    0.58317990347338077042
    >>> bool(found.orientation[0].rad() < 1e-30)
    True
    """
    return prove_states(inputs, [t], digits, friction, torque)[0]


def prove_states(
    inputs: Inputs,
    times: Iterable[float | Fraction],
    digits: int = 30,
    friction: Sequence[float] = NO_DRIVE[0],
    torque: Sequence[float] = NO_DRIVE[1],
) -> list[ProvedState]:
    """Return the states at some times, as `prove_state` does; a driven motion is followed once."""
    exact = [_to_fraction(t) for t in times]
    if not (any(friction) or any(torque)):
        return [_prove_fall(inputs, t, digits) for t in exact]
    farthest = max(map(abs, exact), default=Fraction(0))
    bits = _estimate_bits(inputs, farthest, digits) + _estimate_growth(inputs, farthest, torque)
    return _refine(lambda bits: Enclosure(inputs, bits, friction, torque).at, exact, digits, bits)


def _prove_fall(inputs: Inputs, t: Fraction, digits: int) -> ProvedState:
    bits = _estimate_bits(inputs, abs(t), digits)
    return _refine(lambda _: lambda time: find_fall(inputs, time), [t], digits, bits)[0]


def _to_fraction(t: float | Fraction) -> Fraction:
    if not math.isfinite(t):
        raise ValueError(f"t must be a finite number, got {t} s")
    return Fraction(t)


def _estimate_bits(inputs: Inputs, time: Fraction, digits: int) -> int:
    """Return the bits of the digits, of the angle by which a motion turns, and some more."""
    turned = time * max(map(abs, (*inputs.angular_velocity, inputs.Mgl / inputs.Ix, Fraction(1))))
    return int(BITS_PER_DIGIT * digits) + 40 + int(turned + 1).bit_length()


def _estimate_growth(inputs: Inputs, time: Fraction, torque: Sequence[float]) -> int:
    """Return about the bits that the bound of a driven motion loses until a time."""
    Ix, Iz, Mgl, _, omega = inputs
    pull = abs(Mgl) / Ix + sum(map(abs, map(Fraction, torque))) / min(Ix, Iz)
    swing = math.sqrt(pull)
    nods = float(pull) / max(abs(float(omega[2] * Iz / Ix)), swing, math.ulp(0.0))
    across = abs(float((Ix - Iz) / Ix)) * (math.hypot(*map(float, omega[:2])) + nods) / 2
    return int(float(time) * (swing + across) / math.log(2))


def _refine(
    make: Callable[[int], Solve], times: Sequence[Fraction], digits: int, bits: int
) -> list[ProvedState]:
    """Return states with small radii, of solvers that are made with more and more bits."""

    def is_small(found: list[ProvedState]) -> bool:
        return all(each.is_within(arb(10) ** -digits) for each in found)

    return refine(lambda bits: list(map(make(bits), times)), is_small, bits)


def bound_errors(
    exact: ProvedState, orientation: Sequence[float], angular_velocity: Sequence[float]
) -> tuple[Ball, Ball]:
    """Return the errors of doubles as balls, of the attitude in rad and of the rates in rad/s.

    The attitude's is the angle of the rotation that would correct it, that of the rates the length
    of the difference.
    """
    with ctx.workprec(ERROR_BITS):
        a, b, c, d = exact.orientation
        w, x, y, z = map(arb, orientation)
        across = (  # vector part of the conjugate exact quaternion times the other
            a * x - b * w - c * z + d * y,
            a * y + b * z - c * w - d * x,
            a * z - b * y + c * x - d * w,
        )
        angle = 2 * arb.atan2(norm(across), abs(a * w + b * x + c * y + d * z))
        pairs = zip(exact.angular_velocity, map(arb, angular_velocity), strict=True)
        return angle, norm([p - r for p, r in pairs])
