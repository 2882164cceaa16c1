"""The motion of the heavy top for Mgl > 0, in closed form and without a singular coordinate."""

from __future__ import annotations

import cmath
import math
from decimal import Decimal, localcontext
from functools import cached_property

import numpy as np
from scipy.special import elliprf

from symtop_ros.physics.kind import Kind, kind_of
from symtop_ros.physics.nutation import Four, Heights, Start, Three, turning_heights
from symtop_ros.physics.phase import Phases
from symtop_ros.physics.precise import HALF, PRECISE, TWO, ratio
from symtop_ros.physics.quotients import mean_rates, quotients, shifts
from symtop_ros.physics.theta import Complex, Real, Series, series

INFINITY = 1e200  # stands for an infinite quarter period: finite, so that 0 * INFINITY is 0


class HeavyMotion:
    """A, B and omega = omega_x + i omega_y at any time, for Mgl > 0 and an axis that can move.

    u(t) = u1 + (u2 - u1) sn(v)**2 with v = v0 + Omega t; the phase of the nutation is x = pi v/K.

    Attributes
    ----------
    start, heights, zeros
        The problem in u = cos(theta), its roots, and where A, B and omega vanish.
    nutation_rate : Decimal
        2 pi over the period of theta, in rad/s; 0 for a motion that never returns.
    rates : tuple of Decimal
        Mean rates of the arguments of A, B and omega, in rad/s.
    """

    def __init__(self, moments: Three, orientation: Four, angular_velocity: Three) -> None:
        with localcontext(PRECISE):
            self.start = Start.of(moments, orientation, angular_velocity)
            self.heights = turning_heights(self.start)
            self.zeros = quotients(self.start, self.heights)
            k = (self.heights.s32 / self.heights.s31).sqrt()
            mean, means = mean_rates(self.start, self.zeros, k)
            self._means = float(means[0]), float(means[1]), -float(means[2])
            self.nutation_rate = (self.start.pull * self.heights.s31).sqrt() * mean
            self.rates = _argument_rates(moments, Decimal(angular_velocity[2]), means)
            self._K = math.pi / (2 * float(mean)) if mean else INFINITY
            self._speed = (
                float((self.start.pull * self.heights.s31).sqrt()) * math.pi / (2 * self._K)
            )
        self._given = _initial_values(moments, orientation, angular_velocity)

    @cached_property
    def kind(self) -> Kind:
        """Name of the motion."""
        return kind_of(self.start, self.heights, self.zeros)

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite at the separatrix."""
        rate = float(self.nutation_rate)
        return 2 * math.pi / rate if rate else math.inf

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        below, above, _ = self.zeros
        return (
            2 * math.atan2(math.sqrt(above.from_u2), math.sqrt(below.from_u2)),
            2 * math.atan2(math.sqrt(above.from_u1), math.sqrt(below.from_u1)),
        )

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s."""
        a, b = float(self.rates[0]), float(self.rates[1])
        return a + b, a - b

    def parameters(self, t: Real) -> Complex:
        """A, B and omega (3, n) at times t (n,) in s."""
        phases = self._phases.at(t)
        x = phases[0] + self._x0
        x -= (2 * math.pi) * np.rint(x / (2 * math.pi))
        turns = np.empty((3, t.size), dtype=complex)
        turns[:2] = np.exp(1j * phases[1:])
        turns[2] = turns[1] * turns[0].conj()
        if self._winding:
            turns[2] = turns[2] * np.exp(
                1j * self._winding * x
            )  # *= rounds a lone number otherwise
        return np.asarray(self._factors * _with_omega(self._series.values(x)) * turns)

    # What only states need is made with the first of them: a verdict asks for none.

    @cached_property
    def _phases(self) -> Phases:
        nutation = self.nutation_rate or Decimal(self._speed)
        return Phases(nutation, *self.rates[:2])

    @cached_property
    def _winding(self) -> int:
        """Turns of omega about the vertical, as both are seen in the body, in a nutation.

        Beside the line of nodes omega has theta' and sin(theta) phi', which nutate: its argument
        grows as that of conj(A) B does but for whole turns, one where phi' reverses.
        """
        a, b, across = self.rates
        return round((across - (b - a)) / self.nutation_rate) if self.nutation_rate else 0

    @cached_property
    def _x0(self) -> float:
        with localcontext(PRECISE):
            return _starting_phase(self.start, self.heights, self._K)

    @cached_property
    def _Kc(self) -> float:
        with localcontext(PRECISE):
            return quarter_period(float((self.heights.s21 / self.heights.s31).sqrt()))

    @cached_property
    def _series(self) -> Series:
        with localcontext(PRECISE):
            sign = [math.copysign(1.0, zero.d) for zero in self.zeros]
            rest = shifts(self.zeros, self.heights)
        return series(self._K, self._Kc, sign, rest)

    @cached_property
    def _factors(self) -> Complex:
        """Factors that make A, B, omega right at t = 0; by the derivative where one vanishes."""
        values, slopes = (_with_omega(each) for each in self._series.at_start(self._x0))
        nearby = 0.5 * min(1.0, self._Kc / self._K)  # in x, where a nutation may be stretched
        factors = [
            (change - 1j * mean * start) / (slope * self._speed)
            if abs(value) < nearby * abs(slope)
            else start / value
            for start, change, value, slope, mean in zip(
                *self._given, values, slopes, self._means, strict=True
            )
        ]
        factors[2] *= cmath.exp(-1j * self._winding * self._x0)
        return np.array(factors)[:, np.newaxis]


def _with_omega(values: Complex) -> Complex:
    """Turn the third quotient, which is conj(omega), into omega, in place."""
    np.conjugate(values[2:], out=values[2:])
    return values


def _argument_rates(moments: Three, wz: Decimal, means: tuple[Decimal, ...]) -> tuple[Decimal, ...]:
    """Add what does not depend on u: c = p_psi (1/Iz - 1/Ix) turns the body about its axis."""
    Ix, Iz = Decimal(moments[0]), Decimal(moments[1])
    half_c = HALF * wz * (Ix - Iz) / Ix
    a, b, across = means
    return a + half_c, b - half_c, -(across + wz * (TWO * Ix - Iz) / (TWO * Ix))


def _initial_values(
    moments: Three, orientation: Four, angular_velocity: Three
) -> tuple[tuple[complex, ...], tuple[complex, ...]]:
    """A, B, omega at t = 0, and their changes but for the turn about the axis by c.

    q' = q (0, omega)/2 and Euler's equations, with p_psi/Ix in the place of omega_z: for a thin rod
    what the turn adds is so much more that it would leave no digit of the rest.
    """
    (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, angular_velocity
    A, B = complex(w, z), complex(x, y)
    across, half_spin = complex(wx, wy), 0.5j * wz * (Iz / Ix)
    A_dot = half_spin * A - across.conjugate() * B / 2
    B_dot = across * A / 2 - half_spin * B
    across_dot = half_spin * across + 2 * (Mgl / Ix) * A.conjugate() * B
    return (A, B, across), (A_dot, B_dot, across_dot)


def quarter_period(modulus: float) -> float:
    """Complete elliptic integral K from the complementary modulus (DLMF 19.8.5)."""
    if modulus == 0:
        return INFINITY
    a, b = 1.0, modulus
    while a - b > 1e-8 * a:  # convergence is quadratic
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (a + b)


def _starting_phase(start: Start, heights: Heights, K: float) -> float:
    """Phase x at t = 0: an elliptic integral from the nearer turning point (DLMF 19.25.5)."""
    s1, s2, s3 = -heights.s1, heights.s2, heights.s3
    s21, s31, s32 = heights.s21, heights.s31, heights.s32
    if s21 == 0:
        return 0.0
    if s1 <= s2 or s32 == 0:
        sn = float((s1 / s21).sqrt())
        x = math.pi / K * sn * float(elliprf(ratio(s2, s21), ratio(s3, s31), 1.0))
    else:
        sn = float((s2 * s31 / (s21 * s3)).sqrt())
        from_top = sn * float(elliprf(ratio(s32 * s1, s21 * s3), ratio(s32, s3), 1.0))
        x = math.pi - math.pi / K * from_top
    return -x if start.fall > 0 else x
