"""The first instants of a motion, as a Taylor series about the start.

An axis that starts at rest moves slowly at first. Quotients of theta functions are right to
rounding of the largest angular velocity of the motion; the first, small angular velocities are
differences of large numbers there. The series has them to rounding of themselves.
"""

import math
from collections.abc import Sequence
from decimal import Decimal

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.elementary import (
    Components,
    FloatPair,
    Number,
    find_modulus,
    multiply,
)
from symtop_ros.physics.exact.phases import Phases
from symtop_ros.physics.exact.precise import HALF
from symtop_ros.physics.times import ExactTimes

TERMS = 14
# Radians of the fastest rate. The first term left out is 0.1^14 times a coefficient below 1.
REACH = 0.1
SLOWEST = 1e-290  # rad/s; the quotient Mgl/Ix may be zero in doubles


class FirstInstants:
    """A, B and omega_xy near t = 0."""

    def __init__(self, moments: Vector, orientation: Quaternion, angular_velocity: Vector) -> None:
        (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, angular_velocity
        # In this unit of time all rates are below 1: no power of them overflows. It is a power of
        # two, so that nothing is rounded.
        self._unit = 2.0 ** math.frexp(_find_fastest_rate(moments, angular_velocity))[1]
        half_spin = 0.5 * (wz / self._unit) * (Iz / Ix)
        beta = 2 * (Mgl / Ix / self._unit) / self._unit
        A, B, omega = [(w, z)], [(x, y)], [(wx / self._unit, wy / self._unit)]  # Taylor series
        for n in range(TERMS):
            # Euler's equations and q' = q (0, omega)/2 in the frame that does not turn by c: there
            # gravity alone changes omega_xy. All products are convolutions.
            over, along = _convolve(B, omega, -1.0), _convolve(omega, A)
            weight, order = _convolve(B, A, -1.0), n + 1
            real, imaginary = A[n]
            A.append(
                (
                    (-half_spin * imaginary - over[0] / 2) / order,
                    (half_spin * real - over[1] / 2) / order,
                )
            )
            real, imaginary = B[n]
            B.append(
                (
                    (along[0] / 2 + half_spin * imaginary) / order,
                    (along[1] / 2 - half_spin * real) / order,
                )
            )
            omega.append((beta * weight[0] / order, beta * weight[1] / order))
        self._series = [list(zip(*each, strict=True)) for each in (A, B, omega)]
        self._phases = Phases(HALF * Decimal(wz) * (Decimal(Ix) - Decimal(Iz)) / Decimal(Ix))

    def cayley_klein(self, t: Number | ExactTimes) -> Components:
        """Return A, B and omega_xy at times in s or exact times, as real and imaginary parts."""
        time = self._unit * (t.seconds if isinstance(t, ExactTimes) else t)
        A, B, omega = (
            (_sum_powers(real, time), _sum_powers(imaginary, time))
            for real, imaginary in self._series
        )
        [half_turn] = self._phases.at(t)
        turn = half_turn.unit
        back = turn[0], -turn[1]
        omega_x, omega_y = multiply(multiply(omega, back), back)
        omega_xy = omega_x * self._unit, omega_y * self._unit
        return multiply(A, turn), multiply(B, back), omega_xy


def _sum_powers(coefficients: Sequence[float], time: Number) -> Number:
    *lower, last = coefficients
    total = last * time
    for coefficient in lower[:0:-1]:
        total = (total + coefficient) * time
    return total + lower[0]


def find_end(moments: Vector, angular_velocity: Vector) -> float:
    """Return the largest |t| in s at which the series holds."""
    return REACH / _find_fastest_rate(moments, angular_velocity)


def _find_fastest_rate(moments: Vector, angular_velocity: Vector) -> float:
    (Ix, Iz, Mgl), (wx, wy, wz) = moments, angular_velocity
    rates = find_modulus((wx, wy)), abs(wz) * (Iz / Ix), math.sqrt(2 * (Mgl / Ix))
    return max(*rates, SLOWEST)


def _convolve(left: list[FloatPair], right: list[FloatPair], sign: float = 1.0) -> FloatPair:
    """Return the coefficient of the product of two series that both have as many as it needs.

    With sign -1 it is that of the product with the conjugate of the second series.
    """
    real = imaginary = 0.0
    for (x, y), (u, v) in zip(left, reversed(right), strict=True):
        real += x * u - sign * (y * v)
        imaginary += y * u + sign * (x * v)
    return real, imaginary
