"""The cubic of the nutation, (du/dt)^2 = f(u) for u = cos(theta), and its roots.

Goldstein (Classical Mechanics, section 5.7) writes

    (du/dt)^2 = (1 - u^2)(alpha - beta u) - (b - a u)^2.

Expanded in powers of u, as there, the coefficients cancel: for a small tilt the roots are near 1,
and their distances from 1, on which everything depends, keep no digit. So the height is measured
from the start, s = u - u0. Each coefficient is then a sum of products of the given numbers:

=====================  ===========================  ================================================
name                   textbook                     in terms of the start
=====================  ===========================  ================================================
`a`                    a = p_psi/Ix                 (Iz/Ix) omega_z, in rad/s
`beta`                 beta = 2 Mgl/Ix              in rad^2/s^2
`one_minus_u`          1 - u0                       2 |B|^2, with Cayley-Klein parameters A and B
`one_plus_u`           1 + u0                       2 |A|^2
`b_minus_au`           b - a u0                     sin^2(theta) phi', in rad/s
`u_dot`                du/dt                        -sin(theta) theta', in rad/s
`omega_xy_squared`     alpha - beta u0              theta'^2 + sin^2(theta) phi'^2, in rad^2/s^2
`u_dot_dot`            d2u/dt2                      half of f'(u) at u0, in rad/s^2
`b_minus_a`            b - a                        (p_phi - p_psi)/Ix, in rad/s
`b_plus_a`             b + a                        (p_phi + p_psi)/Ix, in rad/s
`b_minus_au_highest`   b - a alpha/beta             b - a u where all energy would be potential
`alpha_minus_beta`     alpha - beta                 kinetic energy left upright, in rad^2/s^2
=====================  ===========================  ================================================

On the separatrix b = a and alpha = beta: the axis has just the energy to come to rest upright. Near
it these two numbers decide on everything, and all digits of their terms may cancel. A sum that is
zero decides on the kind of the motion: regular precession, a cusp, a way through a pole. Of a zero
50 digits leave some 1e-50, another number in each order of operations. In both cases the sums are
computed again in fractions of integers, exactly.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from decimal import Decimal, getcontext
from fractions import Fraction
from typing import Any

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.precise import HALF, ONE, TWO, ZERO
from symtop_ros.physics.values import EPS

# A sum below this share of its terms has lost 10 of its 50 digits. It is computed exactly instead.
CANCELLED = Decimal("1e-10")
# Decimal digits after which a sum has none of its terms' digits, and may be zero.
LOST_DIGITS = 40
MOST_STEPS = 60  # of Newton's method in doubles; from the bound some 5 are usual


@dataclass(frozen=True, slots=True)
class Nutation:
    """The numbers at t = 0 on which the motion of the axis depends; names as in the table above."""

    a: Decimal
    beta: Decimal
    one_minus_u: Decimal
    one_plus_u: Decimal
    b_minus_au: Decimal
    u_dot: Decimal
    omega_xy_squared: Decimal
    u_dot_dot: Decimal
    b_minus_a: Decimal
    b_plus_a: Decimal
    b_minus_au_highest: Decimal
    alpha_minus_beta: Decimal

    @classmethod
    def of(cls, moments: Vector, orientation: Quaternion, angular_velocity: Vector) -> "Nutation":
        """Return the nutation of a top (Ix, Iz, Mgl) that starts at a state."""
        given = moments, orientation, angular_velocity
        numbers, (along, of_spin, of_rise) = _form(*(map(Decimal, each) for each in given))
        rounded = cls(*numbers)
        if not rounded._has_lost_digits(along, of_spin, of_rise):
            return rounded
        fractions, _ = _form(*(map(Fraction, each) for each in given))
        return replace(  # only sums lose digits
            cls(*map(_round, fractions)),
            a=rounded.a,
            beta=rounded.beta,
            one_minus_u=rounded.one_minus_u,
            one_plus_u=rounded.one_plus_u,
            omega_xy_squared=rounded.omega_xy_squared,
        )

    def _has_lost_digits(self, along: Decimal, of_spin: Decimal, of_rise: Decimal) -> bool:
        """Return True if a sum has lost too many digits, by its terms."""
        squared = self.omega_xy_squared
        return (
            abs(self.b_minus_a) <= CANCELLED * along
            or abs(self.alpha_minus_beta) <= CANCELLED * squared
            or is_lost(self.u_dot * self.u_dot, squared, 2)
            or is_lost(self.b_minus_au * self.b_minus_au, squared, 2)
            or is_lost(self.b_plus_a, self.b_minus_au)
            or is_lost(self.b_minus_au_highest, self.b_minus_au)
            or is_lost(self.u_dot_dot, of_spin)
            or is_lost(self.u_dot_dot, of_rise)
        )

    @property
    def u(self) -> Decimal:
        """cos(theta) at the start."""
        return (self.one_plus_u - self.one_minus_u) * HALF

    @property
    def height_left(self) -> Decimal:
        """alpha/beta - u0: how much higher the axis could rise if all energy were potential."""
        return self.omega_xy_squared / self.beta

    def b_minus_au_at(self, s: Decimal) -> Decimal:
        """Return b - a u = sin^2(theta) phi' at the height u = u0 + s, in rad/s."""
        return self.b_minus_au - self.a * s


def is_lost(value: Decimal, term: Decimal, power: int = 1) -> bool:
    """Return True if a sum is so small, compared with one of its terms, that it may be zero.

    `power` is that of the sum in `value`: its digits are lost as often.
    """
    return bool(value and term) and value.adjusted() < term.adjusted() - power * LOST_DIGITS


def _form(
    moments: Iterable[Any], orientation: Iterable[Any], angular_velocity: Iterable[Any]
) -> tuple[tuple[Any, ...], tuple[Any, Any, Any]]:
    """Return the fields of `Nutation` and terms of their sums, of Decimals or of Fractions."""
    (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, angular_velocity
    upper, lower = w * w + z * z, x * x + y * y
    # The doubles of a quaternion have norm 1 to rounding only. With this factor 1 - u0 and 1 + u0
    # have the sum 2 exactly, as the cubic assumes.
    twice = 2 / (upper + lower)
    gx, gy = twice * (x * z - w * y), twice * (y * z + w * x)  # z' seen from the body
    a, beta, squared = wz * Iz / Ix, 2 * Mgl / Ix, wx * wx + wy * wy
    one_minus_u, one_plus_u = twice * lower, twice * upper
    b_minus_au = wx * gx + wy * gy
    of_spin, of_rise = a * b_minus_au, (one_plus_u - one_minus_u) / 2 * squared
    of_weight, of_height = beta / 2 * one_plus_u * one_minus_u, a * squared / beta
    numbers = (
        *(a, beta, one_minus_u, one_plus_u, b_minus_au, wy * gx - wx * gy, squared),
        of_spin - of_rise - of_weight,
        *(b_minus_au - a * one_minus_u, b_minus_au + a * one_plus_u),
        *(b_minus_au - of_height, squared - beta * one_minus_u),
    )
    return numbers, (abs(wx * gx) + abs(wy * gy), of_spin, of_rise)


def _round(x: Fraction) -> Decimal:
    return Decimal(x.numerator) / Decimal(x.denominator)


@dataclass(frozen=True, slots=True)
class Roots:
    """Roots s1 <= 0 <= s2 <= s3 of f, measured from the start.

    `s21` and `s32` are their differences s2 - s1 and s3 - s2; `below_pole` and `above_pole` are the
    distances 1 - u2 and u3 - 1 from the upper pole. They are stored because subtraction would lose
    their digits where roots nearly meet.
    """

    s1: Decimal
    s2: Decimal
    s3: Decimal
    s21: Decimal
    s32: Decimal
    below_pole: Decimal
    above_pole: Decimal

    @property
    def s31(self) -> Decimal:
        """s3 - s1."""
        return self.s21 + self.s32


def find_roots(nutation: Nutation) -> Roots:
    """Return the roots of f(s)/beta = s^3 + a2 s^2 + a1 s + a0.

    a0 = (du/dt)^2/beta and a1 = 2 (d2u/dt2)/beta at the start. One root is well apart from the
    other two, on one side of their mean -a2/3. Newton's method finds it from outside, where the
    cubic is convex and the iteration monotone: it cannot jump to another root. The other two
    follow from their sum and their product (Vieta). Viete's trigonometric solution would give all
    three to the absolute error of the largest, which leaves no digit of a small s2.
    """
    beta, u = nutation.beta, nutation.u
    a2 = TWO * u - (nutation.omega_xy_squared + nutation.a * nutation.a) / beta
    a1, a0 = TWO * nutation.u_dot_dot / beta, nutation.u_dot * nutation.u_dot / beta
    if not (a1 or a0):  # regular precession: the start is a double root
        below, share = nutation.one_minus_u, nutation.b_minus_a / nutation.one_minus_u
        above = share * share / beta  # f(1) = -(b - a)^2 is the product of the distances
        return Roots(ZERO, ZERO, below + above, ZERO, below + above, below, above)
    mean = -a2 / 3
    if _cubic(mean, a2, a1, a0) > 0:  # s1 < mean < s2
        return _roots_from_lowest(nutation, a2, a1, a0)
    return _roots_from_highest(nutation, a2, a1, a0)


def _roots_from_lowest(nutation: Nutation, a2: Decimal, a1: Decimal, a0: Decimal) -> Roots:
    # s1 is the largest root of the reflected cubic; u1 >= -1 bounds it.
    s1 = min(-_find_largest_root(-a2, a1, -a0, nutation.one_plus_u), ZERO)
    total = -(a2 + s1)  # s2 + s3
    # If s2 and s3 are both small compared with s1, their sum has lost its digits. From a start at
    # the upper turning point, a0 = 0, the product is exactly zero, as s2 is.
    product = a1 - s1 * total if total >= -s1 and (a0 or not s1) else -a0 / s1
    below, above = _distances_from_pole(nutation, nutation.one_minus_u - s1)
    s3 = nutation.one_minus_u + above
    s2 = product / s3  # one_minus_u - below would cancel
    return Roots(s1, s2, s3, s2 - s1, below + above, below, above)


def _distances_from_pole(nutation: Nutation, v1: Decimal) -> tuple[Decimal, Decimal]:
    """Return 1 - u2 and u3 - 1, which decide how near the separatrix is.

    In terms of v = 1 - u the cubic is

        f/beta = -v^3 + ... + 2 (alpha - beta - a (b - a)) v/beta - (b - a)^2/beta

    so that v2 + v3 and v2 v3 follow from two numbers that are known to all digits, and from the
    root v1 = 1 - u1 that is apart. v2 >= 0 >= v3 makes their difference free of cancellation. From
    the coefficients of powers of s, gaps below 1e-19 would have no digit left.
    """
    scale = nutation.beta * v1
    product = nutation.b_minus_a * nutation.b_minus_a / scale  # -v2 v3
    excess = nutation.alpha_minus_beta - nutation.a * nutation.b_minus_a
    half_sum = HALF * product / v1 - excess / scale
    half_gap = (half_sum * half_sum + product).sqrt()
    if half_sum > 0:
        return half_sum + half_gap, product / (half_sum + half_gap)
    above = half_gap - half_sum
    return product / above if above else ZERO, above


def _roots_from_highest(nutation: Nutation, a2: Decimal, a1: Decimal, a0: Decimal) -> Roots:
    # Lagrange's bound on the largest root (a0 >= 0 adds nothing to it); u3 >= 1 is another.
    bound = max(-a2, ZERO) + max(-a1, ZERO).sqrt()
    s3 = _find_largest_root(a2, a1, a0, max(bound, nutation.one_minus_u))
    product = a0 / s3  # -s1 s2
    half_sum = (a1 + product) / (TWO * s3)  # -(a2 + s3)/2 would cancel: s3 may be huge
    half_gap = (half_sum * half_sum + product).sqrt()
    # Of half_sum + half_gap and half_sum - half_gap one cancels; it comes from the product.
    s2 = half_sum + half_gap if half_sum >= 0 else product / (half_gap - half_sum)
    s1 = half_sum - half_gap if half_sum < 0 else -product / s2 if s2 else ZERO
    below, above = nutation.one_minus_u - s2, s3 - nutation.one_minus_u
    return Roots(s1, s2, s3, TWO * half_gap, s3 - s2, below, above)


def _cubic(s: Decimal, a2: Decimal, a1: Decimal, a0: Decimal) -> Decimal:
    return ((s + a2) * s + a1) * s + a0


def _find_largest_root(a2: Decimal, a1: Decimal, a0: Decimal, s: Decimal) -> Decimal:
    """Return the largest root, by Newton's method from an upper bound s.

    The iterates decrease until rounding stops them, or until the next step would be lost in it:
    the root is apart from the others, so that each step is about the square of the one before.
    A start at the turning point is the root 0, which relative steps would approach for ever.
    """
    if a0 == 0 and a1 > 0 and a2 > 0:
        return ZERO
    estimate = _estimate_largest_root(float(a2), float(a1), float(a0), float(s))
    if 3 * estimate > -a2 and _cubic(estimate, a2, a1, a0) > 0:  # above the root as well
        s = estimate
    converged = ONE.scaleb(-(getcontext().prec // 2 + 1))  # its square is below all digits
    while True:
        value = _cubic(s, a2, a1, a0)
        slope = (3 * s + TWO * a2) * s + a1
        if value <= 0 or slope <= 0:
            return s
        step = value / slope
        if step < converged * s:
            return s - step
        s -= step


def _estimate_largest_root(a2: float, a1: float, a0: float, s: float) -> Decimal:
    """Return a number just above the largest root, found in doubles from an upper bound s.

    In doubles that are too coarse or too small the number is wrong; the caller tests it.
    """
    for _ in range(MOST_STEPS):
        value, slope = ((s + a2) * s + a1) * s + a0, (3 * s + 2 * a2) * s + a1
        if not (value > 0 and slope > 0) or value < 4 * EPS * slope * s:
            break
        s -= value / slope
    return Decimal(s * (1 + 32 * EPS)) if math.isfinite(s) else ZERO
