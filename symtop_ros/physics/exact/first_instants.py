"""The first instants of a motion, as a Taylor series about the start.

An axis that starts at rest moves slowly at first. Quotients of theta functions are right to
rounding of the largest angular velocity of the motion; the first, small angular velocities are
differences of large numbers there. The series has them to rounding of themselves.
"""

import math
from decimal import Decimal

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.elementary import Components, Number, Pair, multiply
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
        half_spin = 0.5j * (wz / self._unit) * (Iz / Ix)
        beta = 2 * (Mgl / Ix / self._unit) / self._unit
        A, B, omega = [complex(w, z)], [complex(x, y)], [complex(wx, wy) / self._unit]
        for n in range(TERMS):
            # Euler's equations and q' = q (0, omega)/2 in the frame that does not turn by c: there
            # gravity alone changes omega_xy. All products are convolutions.
            slope_A = half_spin * A[n] - _convolve(_conjugate(omega), B) / 2
            slope_B = _convolve(omega, A) / 2 - half_spin * B[n]
            omega.append(beta * _convolve(_conjugate(A), B) / (n + 1))
            A.append(slope_A / (n + 1))
            B.append(slope_B / (n + 1))
        self._polynomials = [
            [coefficient for pair in ((c.real, c.imag) for c in series) for coefficient in pair]
            for series in (A, B, omega)
        ]
        self._phases = Phases(HALF * Decimal(wz) * (Decimal(Ix) - Decimal(Iz)) / Decimal(Ix))

    def cayley_klein(self, t: Number | ExactTimes) -> Components:
        """Return A, B and omega_xy at times in s or exact times, as real and imaginary parts."""
        time = self._unit * (t.seconds if isinstance(t, ExactTimes) else t)
        A, B, omega = (_sum_powers(series, time) for series in self._polynomials)
        [half_turn] = self._phases.at(t)
        turn = half_turn.unit
        back = turn[0], -turn[1]
        omega_x, omega_y = multiply(multiply(omega, back), back)
        omega_xy = omega_x * self._unit, omega_y * self._unit
        return multiply(A, turn), multiply(B, back), omega_xy


def _sum_powers(coefficients: list[float], time: Number) -> Pair:
    """Return real and imaginary part of a polynomial; the coefficients alternate between them."""
    *lower, real, imaginary = coefficients
    x, y = real * time, imaginary * time
    for n in range(len(lower) - 2, 0, -2):
        x, y = (x + lower[n]) * time, (y + lower[n + 1]) * time
    return x + lower[0], y + lower[1]


def find_end(moments: Vector, angular_velocity: Vector) -> float:
    """Return the largest |t| in s at which the series holds."""
    return REACH / _find_fastest_rate(moments, angular_velocity)


def _find_fastest_rate(moments: Vector, angular_velocity: Vector) -> float:
    (Ix, Iz, Mgl), (wx, wy, wz) = moments, angular_velocity
    rates = math.hypot(wx, wy), abs(wz) * (Iz / Ix), math.sqrt(2 * (Mgl / Ix))
    return max(*rates, SLOWEST)


def _convolve(left: list[complex], right: list[complex]) -> complex:
    return sum((a * b for a, b in zip(left, reversed(right), strict=True)), 0j)


def _conjugate(series: list[complex]) -> list[complex]:
    return [each.conjugate() for each in series]
