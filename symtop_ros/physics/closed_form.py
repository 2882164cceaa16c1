"""The motion of the heavy top for Mgl > 0, in closed form and without a singular coordinate.

The Cayley-Klein parameters A and B have no pole on the vertical, in contrast to Euler's angles, and
their phases grow linearly in time except for a periodic part. So nothing is divided by sin(theta),
and no error accumulates (Klein & Sommerfeld, The Theory of the Top, chapter VI).
"""

from __future__ import annotations

import math
from decimal import Decimal, localcontext
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import elliprf

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.elementary import (
    Components,
    Number,
    Pair,
    choose_smaller,
    find_rest,
    find_sign,
    find_size,
    multiply,
    multiply_by_conjugate,
    round_to_integer,
    to_complex,
)
from symtop_ros.physics.first_moments import FirstMoments, find_end
from symtop_ros.physics.kind import Kind, classify
from symtop_ros.physics.nutation import Nutation, Roots, find_roots
from symtop_ros.physics.precise import (
    HALF,
    ONE,
    PRECISE,
    TWO,
    TWO_PI,
    ZERO,
    Phases,
    integrate_rf,
    split,
    split_short,
)
from symtop_ros.physics.quotients import (
    compute_mean,
    compute_mean_rates,
    compute_shift_complement,
    find_zeros,
)
from symtop_ros.physics.spin import spin_reverses
from symtop_ros.physics.theta import Series, choose_series
from symtop_ros.physics.times import ExactTimes

# From this ratio K/K' on phases are computed with all digits: they are then stretched.
STRETCHED = 1.5
# From this share of |A|^2 or |B|^2 at the far turning point left at the near one, the rounding of a
# phase counts: theta changes fast compared with itself.
NEAR_POLE = Decimal("0.01")
PI_HIGH, PI_LOW = split(TWO_PI * HALF)

Location = tuple[Number, Number, Number, Number]  # arguments of `Series.values`


class ClosedFormMotion:
    """A, B and omega_xy = omega_x + i omega_y at any time, for Mgl > 0 and an axis that moves.

    u(t) = u1 + (u2 - u1) sn(v)^2 with v = v0 + Omega t (Whittaker, section 72). The phase of the
    nutation is x = pi v/K; x = 0 is the lower turning point u1, x = pi the upper one.

    Parameters
    ----------
    moments : (float, float, float)
        Ix and Iz in kg m^2, Mgl > 0 in J.
    orientation : (float, float, float, float)
        (w, x, y, z) at t = 0.
    angular_velocity : (float, float, float)
        In the body frame at t = 0, in rad/s.

    Attributes
    ----------
    nutation : Nutation
        The cubic for u = cos(theta).
    roots : Roots
        Its roots.
    zeros : tuple of Zero
        The heights at which A, B and omega_xy vanish.
    nutation_rate : Decimal
        2 pi over the period of theta, in rad/s; 0 for a motion that never returns.
    rates : tuple of Decimal
        Mean rates of the arguments of A, B and omega_xy, in rad/s.
    """

    def __init__(self, moments: Vector, orientation: Quaternion, angular_velocity: Vector) -> None:
        with localcontext(PRECISE):
            self.nutation = Nutation.of(moments, orientation, angular_velocity)
            self.roots = find_roots(self.nutation)
            self.zeros = find_zeros(self.nutation, self.roots)
            # The complementary modulus from s32, not as sqrt(1 - m): near the separatrix that
            # would have no digits.
            k = (self.roots.s32 / self.roots.s31).sqrt()
            mean, means = compute_mean_rates(self.nutation, self.zeros, k)
            self._means = float(means[0]), float(means[1]), float(means[2])
            frequency = (self.nutation.beta * self.roots.s31).sqrt()  # 2 Omega
            self.nutation_rate = frequency * mean
            self.rates = _argument_rates(moments, Decimal(angular_velocity[2]), means)
            self._K = math.pi / (2 * float(mean)) if mean else math.inf
            self._mean = mean
            self._Omega = float(frequency) / 2
        self._first_end = find_end(moments, angular_velocity)
        norm = math.hypot(*orientation)
        w, x, y, z = (component / norm for component in orientation)
        self._arguments = moments, (w, x, y, z), angular_velocity
        self._given = _initial_values(*self._arguments)

    @cached_property
    def kind(self) -> Kind:
        """Name of the motion."""
        return classify(self.nutation, self.roots, self.zeros)

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite at the separatrix."""
        rate = float(self.nutation_rate)
        return 2 * math.pi / rate if rate else math.inf

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad.

        tan(theta/2)^2 = (1 - u)/(1 + u): both distances are known to all digits, while the arc
        cosine of u loses half of them near a pole.
        """
        below, above, _ = self.zeros
        return (
            2 * math.atan2(math.sqrt(above.from_u2), math.sqrt(below.from_u2)),
            2 * math.atan2(math.sqrt(above.from_u1), math.sqrt(below.from_u1)),
        )

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s: sum and difference of the rates of arg A and arg B."""
        a, b = float(self.rates[0]), float(self.rates[1])
        return a + b, a - b

    @property
    def precession_per_nutation(self) -> float:
        """Turns of the precession in a nutation; nan at the separatrix."""
        with localcontext(PRECISE):
            turn = self.rates[0] + self.rates[1]
            return float(turn / self.nutation_rate) if self.nutation_rate else math.nan

    @property
    def spin_reverses(self) -> bool:
        """True if psi' takes both signs."""
        return spin_reverses(self.nutation, self.roots, self.zeros, self._arguments[2][2])

    def cayley_klein(self, t: Number | ExactTimes) -> Components:
        """Return A, B and omega_xy at times in s or exact times, as real and imaginary parts."""
        seconds = t.rough_seconds if isinstance(t, ExactTimes) else t
        is_first = find_size(seconds) <= self._first_end
        if isinstance(is_first, np.ndarray):
            if is_first.any() and not is_first.all():
                first = self._first_moments.cayley_klein(_select(t, is_first))
                return _merge(is_first, first, self._evaluate(_select(t, ~is_first)))
            is_first = bool(is_first.any())
        elif seconds == 0:
            return self._return_start()  # as the first moments do, without their coefficients
        return self._first_moments.cayley_klein(t) if is_first else self._evaluate(t)

    def _return_start(self) -> Components:
        A, B, omega_xy = ((value.real, value.imag) for value in self._given[0])
        return A, B, omega_xy

    def _evaluate(self, t: Number | ExactTimes) -> Components:
        nutation, a, b = self._phases.at(t)
        location = self._locate(t, *nutation.radians)
        turn_A, turn_B = a.unit, b.unit
        turn_omega = multiply_by_conjugate(turn_B, turn_A)
        A, B, omega_xy = self._series.values(*location)
        factors = self._factors
        return (
            multiply(multiply(factors[0], A), turn_A),
            multiply(multiply(factors[1], B), turn_B),
            multiply(multiply_by_conjugate(factors[2], omega_xy), turn_omega),
        )

    def _locate(self, t: Number | ExactTimes, high: Number, low: Number) -> Location:
        """Return x in [-pi, pi] and, both times K/K' if K > K', x and pi - |x|; and a rest.

        The phase is kept as two doubles until its distance from the nearer turning point is known.
        Near the separatrix this distance is stretched by K/K', and so would be its rounding.
        """
        from_top, (begin, rest) = self._begin
        if not self._mean:  # no period: y = x K/K' grows for ever, while x stays 0
            y = begin + 2 * self._Omega * (t.seconds if isinstance(t, ExactTimes) else t)
            return 0.0 * y, y, math.inf + 0.0 * y, 0.0
        total = high + begin
        part = total - high
        error = (high - (total - part)) + (begin - part) + (low + rest)  # Knuth's two-sum
        # 2 pi is subtracted exactly: the numbers are within a factor 2 of each other.
        turns = round_to_integer(total / (2 * math.pi))
        total = total - turns * (2 * PI_HIGH)
        error = error - turns * (2 * PI_LOW)
        sign, size = find_sign(total), find_size(total)
        near = size, sign * error
        far = PI_HIGH - size, PI_LOW - near[1]  # the first difference is exact if it is the nearer
        below, above = (far, near) if from_top else (near, far)
        x = (below[0] + below[1]) * (-sign if from_top else sign)
        if self._Kc >= self._K:  # the direct series is not stretched
            return x, x, above[0] + above[1], 0.0
        return self._stretch(x, below, above)

    def _stretch(self, x: Number, below: Pair, above: Pair) -> Location:
        """Return a location for `ComplementarySeries`, from |x| and pi - |x| as two doubles each.

        A quotient is as small as exp(-y/2) of itself elsewhere, y being the smaller one of the two
        distances times K/K'. The rounding of y, half an ulp of up to pi/2 K/K', would be the
        largest error of a small tilt.
        """
        ratio, parts = self._ratio
        y, rise = x * ratio, (above[0] + above[1]) * ratio
        if not self._is_stretched:
            return x, y, rise, 0.0
        size = find_size(y)
        high = choose_smaller(rise, size, above[0], -below[0])
        low = choose_smaller(rise, size, above[1], -below[1])
        return x, y, rise, find_rest((high, low), parts, (high + low) * ratio)

    # A verdict needs only turning angles and roots. What only states need, more than half of the
    # set-up, is computed with the first state.

    @cached_property
    def _first_moments(self) -> FirstMoments:
        return FirstMoments(*self._arguments)

    @cached_property
    def _phases(self) -> Phases:
        return Phases(self.nutation_rate, *self.rates[:2])

    @cached_property
    def _winding(self) -> int:
        """Whole turns of omega_xy in a nutation, compared with conj(A) B.

        In the frame of the line of nodes omega_xy is theta' + i sin(theta) phi', which is periodic.
        conj(A) B has the argument of the line of nodes in the body. So the mean rates of the two
        arguments differ by whole turns in a nutation, one if phi' reverses. With the integer known
        no third phase is needed, and its rounding cannot separate omega_xy from the attitude.
        """
        a, b, omega = self.rates
        return round((omega - (b - a)) / self.nutation_rate) if self.nutation_rate else 0

    @cached_property
    def _begin(self) -> tuple[bool, tuple[float, float]]:
        """The nearer turning point at t = 0 (True: the upper one), and the phase from there."""
        precise = self._is_stretched or self._comes_near_a_pole
        with localcontext(PRECISE):
            from_top, v = _starting_phase(self.nutation, self.roots, precise)
            return from_top, split(TWO * (self._mean or ONE) * v)  # pi v/K, or 2 v for K' = pi/2

    @cached_property
    def _start(self) -> tuple[float, float, float, float]:
        """The phase at t = 0 as `_locate` returns it."""
        x, below, above, rest = self._locate(0.0, 0.0, 0.0)
        return float(x), float(below), float(above), float(rest)

    @cached_property
    def _Kc(self) -> float:
        with localcontext(PRECISE):
            return quarter_period(float((self.roots.s21 / self.roots.s31).sqrt()))

    @cached_property
    def _series(self) -> Series:
        with localcontext(PRECISE):
            signs = [math.copysign(1.0, zero.d) for zero in self.zeros]
            complements = [compute_shift_complement(zero, self.roots) for zero in self.zeros]
        return choose_series(
            self._K, self._Kc, self._root_of_nome, signs, complements, self._winding
        )

    @cached_property
    def _ratio(self) -> tuple[float, tuple[float, float]]:
        """K/K', and the same in two parts for `find_rest`, of which the first one is short."""
        exact = self._exact_ratio
        return (float(exact), split_short(exact)) if exact else (self._K / self._Kc, (0.0, 0.0))

    @cached_property
    def _exact_ratio(self) -> Decimal:
        """K/K' with all digits if phases are stretched, and 0 elsewhere."""
        if not (self._is_stretched and self._mean):
            return ZERO
        with localcontext(PRECISE):
            return compute_mean((self.roots.s21 / self.roots.s31).sqrt()) / self._mean

    @cached_property
    def _root_of_nome(self) -> float:
        """exp(-pi K/(2 K')), right to rounding: of a double, pi K/(2 K') would be rounded."""
        if not self._exact_ratio:
            return math.exp(-math.pi / 2 * self._K / self._Kc)
        with localcontext(PRECISE):
            return float((-HALF * TWO_PI * HALF * self._exact_ratio).exp())

    @cached_property
    def _factors(self) -> list[Pair]:
        """Constant factors that make A, B and omega_xy right at t = 0.

        A factor is start/value. If the function nearly vanishes at the start, both have lost their
        digits, and the factor comes from the derivatives instead. Value and derivative never
        vanish together.
        """
        values = self._series.values(*self._start)
        factors = [self._find_factor(k, to_complex(value)) for k, value in enumerate(values)]
        factors[2] *= self._modulus_of_third_factor / abs(factors[2])
        factors[2] = factors[2].conjugate()
        return [(factor.real, factor.imag) for factor in factors]

    @property
    def _modulus_of_third_factor(self) -> float:
        """Modulus of the factor of omega_xy.

        At the lower turning point |omega_xy|^2 is alpha - beta u1, and largest. From a start at
        which omega_xy is small, its rounding would be an error of all later ones.
        """
        largest = math.sqrt(self.nutation.beta * self.zeros[2].from_u1)
        above = math.pi * max(1.0, self._K / self._Kc)
        return largest / abs(to_complex(self._series.values(0.0, 0.0, above)[2]))

    def _find_factor(self, k: int, value: complex) -> complex:
        starts, changes = self._given
        start, change = starts[k], changes[k]
        if k == 2:  # the series is that of conj(omega_xy)
            start, change = start.conjugate(), change.conjugate()
        zero, nutation = self.zeros[k], self.nutation
        distance = (nutation.one_plus_u, nutation.one_minus_u, nutation.height_left)[k]
        # The square of a function is in proportion to the distance from its zero. Above half of its
        # largest size it has all its digits.
        if 4 * distance < max(zero.from_u1, zero.from_u2):
            slope = self._series.slope(k, *self._start[:3])
            nearby = 0.5 / math.pi * min(self._K, self._Kc)  # width in v of the fastest change
            if abs(value) < nearby * abs(slope):
                return (change - 1j * self._means[k] * start) / (slope * self._Omega)
        return start / value

    @property
    def _comes_near_a_pole(self) -> bool:
        """True if the axis passes so near a pole that the rounding of phases matters."""
        lower, upper, _ = self.zeros
        return (
            lower.from_u1 < NEAR_POLE * lower.from_u2 or upper.from_u2 < NEAR_POLE * upper.from_u1
        )

    @property
    def _is_stretched(self) -> bool:
        """True near the separatrix, if K/K' is so large that the rounding of phases matters."""
        return STRETCHED * self._Kc < self._K


def _select(t: Any, mask: NDArray[np.bool_]) -> Any:
    return t.select(mask) if isinstance(t, ExactTimes) else t[mask]


def _merge(is_first: NDArray[np.bool_], first: Components, rest: Components) -> Components:
    """Return values of which some come from the first moments, and the others from the series."""
    values = np.empty((3, 2, is_first.size))
    values[:, :, is_first], values[:, :, ~is_first] = first, rest
    A, B, omega_xy = ((real, imaginary) for real, imaginary in values)
    return A, B, omega_xy


def _argument_rates(
    moments: Vector, omega_z: Decimal, means: tuple[Decimal, ...]
) -> tuple[Decimal, ...]:
    """Return the mean rates of arg A, arg B and arg omega_xy.

    To the means over a nutation it adds the terms that do not depend on u: the body turns about its
    axis by c = p_psi (1/Iz - 1/Ix) in addition, written here without the difference of reciprocals.
    """
    Ix, Iz = Decimal(moments[0]), Decimal(moments[1])
    half_c = HALF * omega_z * (Ix - Iz) / Ix
    a, b, omega = means
    return a + half_c, b - half_c, -(omega + omega_z * (TWO * Ix - Iz) / (TWO * Ix))


def _initial_values(
    moments: Vector, orientation: Quaternion, angular_velocity: Vector
) -> tuple[tuple[complex, ...], tuple[complex, ...]]:
    """Return A, B, omega_xy at t = 0, and their time derivatives without the rotation by c.

    The derivatives are q' = q (0, omega)/2 and Euler's equations with p_psi/Ix in place of omega_z.
    The rotation by c commutes and is added exactly, in `_argument_rates`. In these derivatives it
    would be so large for a thin rod that no digit of the other terms would remain.
    """
    (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, angular_velocity
    A, B = complex(w, z), complex(x, y)
    omega_xy, half_spin = complex(wx, wy), 0.5j * wz * (Iz / Ix)
    A_dot = half_spin * A - omega_xy.conjugate() * B / 2
    B_dot = omega_xy * A / 2 - half_spin * B
    omega_xy_dot = half_spin * omega_xy + 2 * (Mgl / Ix) * A.conjugate() * B
    return (A, B, omega_xy), (A_dot, B_dot, omega_xy_dot)


def quarter_period(modulus: float) -> float:
    """Return the complete elliptic integral K from the complementary modulus sqrt(1 - m).

    K = pi/2 divided by the arithmetic-geometric mean of 1 and the complementary modulus (DLMF
    19.8.5). In terms of m it would lose its digits towards m = 1.

    Examples
    --------
    >>> round(quarter_period(0.5), 9)  # m = 3/4
    2.156515647
    """
    if modulus == 0:
        return math.inf
    a, b = 1.0, modulus
    while a - b > 1e-8 * a:  # convergence is quadratic: the next mean is right to rounding
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (a + b)


def _starting_phase(nutation: Nutation, roots: Roots, precise: bool) -> tuple[bool, Decimal]:
    """Return the nearer turning point (True: the upper) and v from there, at t = 0.

    v is an incomplete elliptic integral (DLMF 19.25.5). From the farther turning point it would be
    nearly complete, and the small distance from the nearer one would be lost in it. Halfway, at
    v = K/2, s2/s1 is sqrt(1 - m).
    """
    s1, s2, s3 = -roots.s1, roots.s2, roots.s3  # distances from the start, all >= 0
    s21, s31, s32 = roots.s21, roots.s31, roots.s32
    integral = integrate_rf if precise else _integrate_rf_in_doubles
    if s21 == 0:
        return False, ZERO
    if s2 * s2 * s31 >= s1 * s1 * s32:
        v = (s1 / s21).sqrt() * integral(s2 / s21, s3 / s31)
        return False, -v if nutation.u_dot < 0 else v
    v = (s2 * s31 / (s21 * s3)).sqrt() * integral(s32 * s1 / (s21 * s3), s32 / s3)
    return True, v if nutation.u_dot < 0 else -v


def _integrate_rf_in_doubles(x: Decimal, y: Decimal) -> Decimal:
    return Decimal(float(elliprf(float(x), float(y), 1.0)))
