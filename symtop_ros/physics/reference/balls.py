"""Balls: numbers with a radius that is a proof, in the arithmetic of FLINT.

Assumed: that FLINT and Python's fractions are right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple, TypeVar

from symtop_ros.base.missing import name_remedy

try:
    from flint import acb, arb, ctx, fmpq
except ModuleNotFoundError as error:
    words = f"No module named 'flint': {name_remedy('flint')}"
    raise ModuleNotFoundError(words, name="flint") from error

Ball = Any  # of FLINT: arb or acb
Found = TypeVar("Found")
MOST_BITS = 200_000


class TooFewBitsError(ArithmeticError):
    """A ball is too wide at this precision, or at the largest."""


class ProvedState(NamedTuple):
    """A state in balls: each contains the exact number.

    Attributes
    ----------
    orientation : tuple of flint.arb
        Unit quaternion (w, x, y, z), body to world.
    angular_velocity : tuple of flint.arb
        Angular velocity in the body frame, in rad/s.
    size : flint.arb
        The largest abs(omega_xy) of the motion in rad/s. With friction or a torque, a power of two
        from a quarter to half of the fastest of these rates: omega at the start, the decay by
        friction, and the square root of (|Mgl| + the largest component of the torque)/Ix.
    """

    orientation: tuple[Ball, ...]
    angular_velocity: tuple[Ball, ...]
    size: Ball

    def __str__(self) -> str:
        """Return the digits that are known."""
        parts = {"orientation": self.orientation, "angular_velocity": self.angular_velocity}
        lines = (f"{name}: {' '.join(map(show, balls))}" for name, balls in parts.items())
        return "\n".join(lines)

    def is_within(self, least: Ball) -> bool:
        """Return True if the radii are at most `least`, and for omega `least` times `size`."""
        limits = [least] * 4 + [least * self.size] * 3
        balls = (*self.orientation, *self.angular_velocity)
        # a comparison with nan is False, so a ball that is not finite must be looked for
        return all(
            b.is_finite() and bool(b.is_exact() or b.rad() <= limit)
            for b, limit in zip(balls, limits, strict=True)
        )


def show(ball: Ball) -> str:
    """Return the digits of a ball; of an exact one those of a double."""
    if not ball.mid().is_finite():
        return str(float(ball.mid()))
    digits = 17 if ball.is_exact() else int(ball.rel_accuracy_bits() * math.log10(2))
    return str(ball.str(max(digits, 1), radius=ball.rel_accuracy_bits() < 4))


def refine(compute: Callable[[int], Found], is_small: Callable[[Found], bool], bits: int) -> Found:
    """Return what is computed with a precision of more and more bits, until its balls are small."""
    while bits <= MOST_BITS:
        try:
            with ctx.workprec(bits):
                found = compute(bits)
                if is_small(found):
                    return found
        except (TooFewBitsError, ValueError, ZeroDivisionError):
            pass  # a wide ball contains a zero or a pole
        bits += bits // 2
    raise TooFewBitsError(f"the balls need more than {MOST_BITS} bits")


def to_ball(x: Fraction) -> Ball:
    """Return a rational number."""
    return arb(fmpq(x.numerator, x.denominator))


def carlson_rf(*arguments: Ball) -> Ball:
    """Return Carlson's R_F of real numbers >= 0."""
    return acb.elliptic_rf(*map(acb, arguments)).real


def norm(parts: Sequence[Ball]) -> Ball:
    """Return the Euclidean norm; of balls about 0 the root of a negative number is avoided."""
    least, most = (
        sum((bound**2 for bound in bounds), arb(0)).sqrt()
        for bounds in ([p.abs_lower() for p in parts], [p.abs_upper() for p in parts])
    )
    return least.union(most)
