"""The motion of the heavy top for Mgl > 0, in closed form and without a singular coordinate.

The Cayley-Klein parameters A and B have no pole on the vertical, in contrast to Euler's angles, and
their phases grow linearly in time except for a periodic part. So nothing is divided by sin(theta),
and no error accumulates (Klein & Sommerfeld, The Theory of the Top, chapter VI).
"""

import math
from decimal import Decimal
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.elementary import (
    Components,
    FloatPair,
    Number,
    arc_tangent,
    find_modulus,
    multiply,
    multiply_by_conjugate,
    normalize,
    to_floats,
)
from symtop_ros.physics.exact.first_instants import FirstInstants, find_end
from symtop_ros.physics.exact.kind import Kind, classify
from symtop_ros.physics.exact.mean_rates import add_means, solve
from symtop_ros.physics.exact.nutation import is_lost
from symtop_ros.physics.exact.nutation_phase import NutationPhase
from symtop_ros.physics.exact.phases import Phases
from symtop_ros.physics.exact.precise import HALF, TWO, ZERO
from symtop_ros.physics.exact.quotients import Quotient
from symtop_ros.physics.exact.spin import spin_reverses
from symtop_ros.physics.exact.theta import Series, choose_series
from symtop_ros.physics.times import ExactTimes, to_rough_seconds


class ClosedFormMotion:
    """A, B and omega_xy = omega_x + i omega_y at any time, for Mgl > 0 and an axis that moves.

    u(t) = u1 + (u2 - u1) sn(v)^2 with v = v0 + Omega t (DLMF 22.2). The phase of the
    nutation is x = pi v/K; x = 0 is the lower turning point u1, x = pi the upper one.

    `moments` are Ix and Iz in kg m^2 and Mgl > 0 in J, `orientation` is (w, x, y, z) at t = 0, and
    `angular_velocity` that of the body frame at t = 0 in rad/s.
    """

    def __init__(self, moments: Vector, orientation: Quaternion, angular_velocity: Vector) -> None:
        self._given = moments, orientation, angular_velocity
        self.nutation, self.roots, self.zeros, (self._mean, self._means) = solve(*self._given)
        self._frequency = (self.nutation.beta * self.roots.s31).sqrt()  # 2 Omega
        # 2 pi over the period of theta in rad/s; 0 for a motion that never returns.
        self.nutation_rate = self._frequency * self._mean
        # In addition to the means over a nutation, the body turns about its axis by
        # c = p_psi (1/Iz - 1/Ix), written here without the difference of reciprocals. c may exceed
        # the means by all their digits, so it is kept apart.
        Ix, Iz, wz = map(Decimal, (moments[0], moments[1], angular_velocity[2]))
        self._half_c = HALF * wz * (Ix - Iz) / Ix
        # A state at a time of at most this size comes from a Taylor series.
        self._first_end = find_end(moments, angular_velocity)
        self._arguments = moments, normalize(orientation), angular_velocity

    @cached_property
    def kind(self) -> Kind:
        """Name of the motion."""
        return classify(self.nutation, self.roots, self.zeros)

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite at the separatrix."""
        rate = float(self.nutation_rate)
        return 2 * math.pi / rate if rate else math.inf

    def turning_angles(self, from_below: bool) -> tuple[float, float]:
        """Return the smallest and the largest angle in rad from the upper or the lower pole.

        tan(theta/2)^2 = (1 - u)/(1 + u): both distances are known to all digits, while the arc
        cosine of u loses half of them near a pole, and pi - theta those of a small angle.
        """
        near, far = self.zeros.B, self.zeros.A
        if from_below:
            near, far = far, near
        first = 2 * float(arc_tangent(math.sqrt(near.from_u2), math.sqrt(far.from_u2)))
        second = 2 * float(arc_tangent(math.sqrt(near.from_u1), math.sqrt(far.from_u1)))
        return (second, first) if from_below else (first, second)

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s: sum and difference of the rates of arg A and arg B."""
        precession, spin = self._mean_rates
        return float(precession), float(spin)

    @property
    def precession_per_nutation(self) -> float:
        """Turns of the precession in a nutation; nan at the separatrix."""
        return float(self._mean_rates[0] / self.nutation_rate) if self.nutation_rate else math.nan

    @cached_property
    def _mean_rates(self) -> tuple[Decimal, Decimal]:
        # The rates of arg A and arg B are a + c/2 and b - c/2, with the means a and b.
        a, b, _ = self._means
        return add_means(a, b, TWO * self._half_c, *self._given)

    @property
    def spin_reverses(self) -> bool:
        """True if psi' takes both signs."""
        return spin_reverses(self.nutation, self.roots, self.zeros, self._arguments[2][2])

    def cayley_klein(self, t: Number | ExactTimes) -> Components:
        """Return A, B and omega_xy at times in s or exact times, as real and imaginary parts."""
        seconds = to_rough_seconds(t)
        is_first = abs(seconds) <= self._first_end
        if isinstance(is_first, np.ndarray):
            if is_first.any() and not is_first.all():
                some: Any = t
                return _merge(
                    is_first, self._begin(some[is_first]), self._evaluate(some[~is_first])
                )
            is_first = bool(is_first.any())
        elif seconds == 0:
            return self._return_start()  # as the first instants do, without their coefficients
        return self._begin(t) if is_first else self._evaluate(t)

    def _begin(self, t: Number | ExactTimes) -> Components:
        """Return the values near t = 0, and at t = 0 those of the start, with their signs of 0."""
        values = self._first_instants.cayley_klein(t)
        is_start = to_rough_seconds(t) == 0
        if isinstance(is_start, np.ndarray) and is_start.any():
            for parts, start in zip(values, self._return_start(), strict=True):
                for part, number in zip(parts, start, strict=True):
                    part[is_start] = number  # type: ignore[index]
        return values

    def _return_start(self) -> Components:
        _, (w, x, y, z), (wx, wy, _) = self._arguments
        return (w, z), (x, y), (wx, wy)

    def _evaluate(self, t: Number | ExactTimes) -> Components:
        nutation, a, b = self._phases.at(t)
        location = self._nutation_phase.locate(t, *nutation.radians)
        turn_A, turn_B = a.unit, b.unit
        turn_omega = multiply_by_conjugate(turn_B, turn_A)
        A, B, omega_xy = self._series.values(location)
        factors = self._factors
        return (
            multiply(multiply(factors[0], A), turn_A),
            multiply(multiply(factors[1], B), turn_B),
            multiply(multiply_by_conjugate(factors[2], omega_xy), turn_omega),
        )

    # A verdict needs only turning angles and roots. What only states need, more than half of the
    # set-up, is computed with the first state.

    @cached_property
    def _first_instants(self) -> FirstInstants:
        return FirstInstants(*self._arguments)

    @cached_property
    def _phases(self) -> Phases:
        a, b, _ = self._means
        rates = _add(a, self._half_c), _add(b, -self._half_c)
        return Phases(self.nutation_rate, *rates)

    @cached_property
    def _nutation_phase(self) -> NutationPhase:
        return NutationPhase(self.nutation, self.roots, self.zeros, self._mean, self._frequency)

    @cached_property
    def _quotients(self) -> tuple[Quotient, Quotient, Quotient]:
        """A, B and conj(omega_xy), of which the third has the form of the other two."""
        (A, B, omega_xy), (A_dot, B_dot, omega_xy_dot) = _initial_values(*self._arguments)
        nutation, zeros, (a, b, omega) = self.nutation, self.zeros, map(float, self._means)
        return (
            Quotient(zeros.A, a, A, A_dot, nutation.one_plus_u),
            Quotient(zeros.B, b, B, B_dot, nutation.one_minus_u),
            Quotient(
                zeros.omega_xy,
                omega,
                _conjugate(omega_xy),
                _conjugate(omega_xy_dot),
                nutation.height_left,
            ),
        )

    @cached_property
    def _series(self) -> Series:
        phase, windings = self._nutation_phase, (0, 0, self._winding)
        shifts = [
            quotient.find_shift(self.roots, phase.Kc, winding)
            for quotient, winding in zip(self._quotients, windings, strict=True)
        ]
        return choose_series(phase.K, phase.Kc, phase.root_of_nome, shifts)

    @cached_property
    def _winding(self) -> int:
        """Whole turns of omega_xy in a nutation, compared with conj(A) B.

        In the frame of the line of nodes omega_xy is theta' + i sin(theta) phi', which is periodic.
        conj(A) B has the argument of the line of nodes in the body. So the mean rates of the two
        arguments differ by whole turns in a nutation, one if phi' reverses. With the integer known
        no third phase is needed, and its rounding cannot separate omega_xy from the attitude.
        """
        a, b, omega = self._means
        # The rate of arg omega_xy is -omega - p_psi/(2 Ix) - c: c cancels.
        difference = a - b - omega - HALF * self.nutation.a
        return round(difference / self.nutation_rate) if self.nutation_rate else 0

    @cached_property
    def _factors(self) -> tuple[FloatPair, FloatPair, FloatPair]:
        """Constant factors that make A, B and omega_xy right at t = 0."""
        values = self._series.values(self._nutation_phase.start)
        A, B, omega_xy = (self._find_factor(k, to_floats(each)) for k, each in enumerate(values))
        size = find_modulus(omega_xy)
        if size:  # else it is below all doubles, as is its change
            share = self._find_modulus_of_third_factor(size) / size
            omega_xy = omega_xy[0] * share, omega_xy[1] * share
        return A, B, _conjugate(omega_xy)

    def _find_factor(self, k: int, value: FloatPair) -> FloatPair:
        phase, series = self._nutation_phase, self._series

        def find_slope() -> FloatPair:
            real, imaginary = series.slope(k, phase.start)
            return real * phase.Omega, imaginary * phase.Omega

        return self._quotients[k].find_factor(value, find_slope, phase.shortest_change)

    def _find_modulus_of_third_factor(self, from_start: float) -> float:
        """Return the modulus of the factor of omega_xy, of which the start gives one estimate.

        |omega_xy|^2 = alpha - beta u is known at three places: the start and both turning points.
        Where it is small its rounding would be an error of all later ones; of the others the mean
        is taken, because each quotient has its own rounding.
        """
        zero, phase = self.zeros.omega_xy, self._nutation_phase
        estimates = []
        for square, place in (
            (zero.from_u1, phase.lower_turning_point),
            (zero.from_u2, phase.upper_turning_point),
        ):
            if 4 * square >= zero.from_u1:
                value = find_modulus(to_floats(self._series.values(place)[2]))
                estimates.append(math.sqrt(self.nutation.beta * square) / value)
        if 4 * self.nutation.height_left >= zero.from_u1:
            estimates.append(from_start)
        total = 0.0
        for estimate in estimates:  # not `sum`, which rounds in another way from Python 3.12 on
            total += estimate
        return total / len(estimates)


def _add(mean: Decimal, half_c: Decimal) -> Decimal:
    """Return the rate of arg A or arg B: zero if rounding is all that is left of the sum.

    phi' + psi' and phi' - psi' may be exactly zero in a regular precession. A rate of 1e-50 instead
    would be visible in a component of the quaternion that is zero.
    """
    rate = mean + half_c
    return ZERO if is_lost(rate, half_c) else rate


def _merge(is_first: NDArray[np.bool_], first: Components, rest: Components) -> Components:
    """Return values of which some come from the first instants, and the others from the series."""
    values = np.empty((3, 2, is_first.size))
    values[:, :, is_first], values[:, :, ~is_first] = first, rest
    A, B, omega_xy = ((real, imaginary) for real, imaginary in values)
    return A, B, omega_xy


def _conjugate(a: FloatPair) -> FloatPair:
    return a[0], -a[1]


def _initial_values(
    moments: Vector, orientation: Quaternion, angular_velocity: Vector
) -> tuple[tuple[FloatPair, ...], tuple[FloatPair, ...]]:
    """Return A, B, omega_xy at t = 0, and their time derivatives without the rotation by c.

    The derivatives are q' = q (0, omega)/2 and Euler's equations with p_psi/Ix in place of omega_z.
    The rotation by c commutes and is added exactly, to the phases. In these derivatives it
    would be so large for a thin rod that no digit of the other terms would remain.
    """
    (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, angular_velocity
    A, B, omega_xy = (w, z), (x, y), (wx, wy)
    spin, weight = 0.5 * wz * (Iz / Ix), 2 * (Mgl / Ix)
    # A' = i spin A - conj(omega_xy) B/2, B' = omega_xy A/2 - i spin B,
    # omega_xy' = i spin omega_xy + weight conj(A) B
    of_A = multiply_by_conjugate(B, omega_xy)
    of_B, of_omega_xy = multiply(omega_xy, A), multiply_by_conjugate(B, A)
    A_dot = -spin * z - of_A[0] / 2, spin * w - of_A[1] / 2
    B_dot = of_B[0] / 2 + spin * y, of_B[1] / 2 - spin * x
    omega_xy_dot = weight * of_omega_xy[0] - spin * wy, weight * of_omega_xy[1] + spin * wx
    changes = to_floats(A_dot), to_floats(B_dot), to_floats(omega_xy_dot)
    return (A, B, omega_xy), changes
