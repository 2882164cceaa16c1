"""The three functions of time that make up the motion: quotients of theta functions.

A, B and conj(omega_xy), that is the Cayley-Klein parameters and the angular velocity
omega_xy = omega_x + i omega_y across the axis, all have the form

    C  th_k(v + i shift)/th4(v)  exp(i rate t),        v = v0 + Omega t

(Klein & Sommerfeld, The Theory of the Top, chapter VI; Whittaker, Analytical Dynamics, chapter VI;
the argument holds for the third function as well). Each vanishes at one height u_P of the axis:
A at the lower pole u = -1, B at the upper pole u = 1, omega_xy at u = alpha/beta, where the
whole energy would be potential. There f(u_P) = -d^2 with d = b - a u_P (Goldstein's a and b, see
`nutation`). Shift and rate follow from d and from the distances of u_P to the three roots of f, in
the same way for all three.
"""

import math
from collections.abc import Callable
from decimal import Decimal, getcontext
from typing import NamedTuple

from symtop_ros.physics.exact.elementary import (
    FloatPair,
    Shift,
    divide,
    find_modulus,
    integrate_rf_in_doubles,
)
from symtop_ros.physics.exact.nutation import CANCELLED, Nutation, Roots
from symtop_ros.physics.exact.precise import HALF, ONE, TWO, ZERO


class Zero(NamedTuple):
    """The height u_P at which one of the three functions vanishes."""

    is_below: bool  # True for A, whose zero lies below the motion; False for B and omega_xy
    d: Decimal  # b - a u_P in rad/s
    from_u1: Decimal  # distances of u_P from the roots of f, all >= 0
    from_u2: Decimal
    from_u3: Decimal

    @property
    def sign(self) -> float:
        """Sign of d; 1 for d = 0, whatever sign the zero has."""
        return -1.0 if self.d < 0 else 1.0

    @property
    def nearness(self) -> Decimal:
        """Distance of u_P from the near turning point divided by that from the far one."""
        if self.is_below:
            return self.from_u1 / self.from_u2
        return self.from_u2 / self.from_u1


class Zeros(NamedTuple):
    """The zeros of the three functions."""

    A: Zero  # the lower pole
    B: Zero  # the upper pole
    omega_xy: Zero  # alpha/beta, where all energy would be potential

    @property
    def largest_sine_squared(self) -> Decimal:
        """The largest sin^2(theta) of a nutation."""
        if self.A.from_u1 < 1 < self.A.from_u2:  # u1 < 0 < u2: the axis becomes horizontal
            return ONE
        return max(self.A.from_u1 * self.B.from_u1, self.A.from_u2 * self.B.from_u2)


def find_zeros(nutation: Nutation, roots: Roots) -> Zeros:
    """Return the zeros of A, B and omega_xy."""
    above = nutation.omega_xy_squared / nutation.beta
    d = nutation.b_minus_au_highest
    from_u2, from_u3 = above - roots.s2, roots.s3 - above
    if roots.s32 < CANCELLED * nutation.one_minus_u:
        # All three heights are so near the pole that from the start no digit would be left.
        lift = nutation.alpha_minus_beta / nutation.beta  # alpha/beta - 1
        d = nutation.b_minus_a - nutation.a * lift
        from_u2, from_u3 = roots.below_pole + lift, roots.above_pole - lift
    from_pole = nutation.one_minus_u - roots.s1, roots.below_pole, roots.above_pole
    return Zeros(
        _zero_below(nutation, roots),
        _zero_above(nutation, nutation.b_minus_a, from_pole),
        _zero_above(nutation, d, (above - roots.s1, from_u2, from_u3)),
    )


def _zero_below(nutation: Nutation, roots: Roots) -> Zero:
    """Return the zero at u = -1.

    Near the pole u1 + 1 would be the difference of nearly equal numbers. It comes from the product
    beta (u_P - u1)(u_P - u2)(u_P - u3) = f(u_P) = -d^2, whose other factors are not small.
    """
    d = nutation.b_plus_a
    from_u2, from_u3 = nutation.one_plus_u + roots.s2, nutation.one_plus_u + roots.s3
    return Zero(True, d, d * d / (nutation.beta * from_u2 * from_u3), from_u2, from_u3)


def _zero_above(nutation: Nutation, d: Decimal, distances: tuple[Decimal, ...]) -> Zero:
    """Return a zero that lies between u2 and u3, at these distances from u1, u2 and u3.

    The smaller of the distances from u2 and u3 comes from the product, as in `_zero_below`.
    """
    from_u1, from_u2, from_u3 = distances
    product = d * d / (nutation.beta * from_u1)
    if from_u2 + from_u3 == 0:
        from_u2 = from_u3 = ZERO
    elif from_u2 <= from_u3:
        from_u2 = product / from_u3
    else:
        from_u3 = product / from_u2
    return Zero(False, d, from_u1, from_u2, from_u3)


class Quotient(NamedTuple):
    """One of the three functions: C th_k(v + i shift)/th4(v) exp(i rate t)."""

    zero: Zero
    mean: float  # its mean rate in a nutation, in rad/s, without the body's turning by c
    start: FloatPair  # its value at t = 0; for omega_xy the conjugate
    change: FloatPair  # the time derivative of `start`, without the body's turning by c
    from_start: Decimal  # |u_P - u0|

    def find_shift(self, roots: Roots, Kc: float, winding: int) -> Shift:
        """Return the shift of its theta function."""
        complement = min(_compute_shift_complement(self.zero, roots), Kc)
        return Shift(self.zero.sign, complement, self.zero.is_below, winding)

    def find_factor(
        self, value: FloatPair, find_slope: Callable[[], FloatPair], width: float
    ) -> FloatPair:
        """Return C, so that the function is right at t = 0.

        C is start/value. If the function nearly vanishes at the start, both have lost their digits,
        and C comes from the derivatives instead. Value and derivative never vanish together.

        `value` is the theta quotient at t = 0, `find_slope` returns its time derivative, and
        `width` is the time of the fastest change.
        """
        # The square of a function is in proportion to the distance from its zero. Above half of its
        # largest size it has all its digits.
        if 4 * self.from_start < max(self.zero.from_u1, self.zero.from_u2):
            slope = find_slope()
            if find_modulus(value) < width * find_modulus(slope):
                (x, y), (change_x, change_y) = self.start, self.change
                return divide((change_x + self.mean * y, change_y - self.mean * x), slope)
        return divide(self.start, value)


def _compute_shift_complement(zero: Zero, roots: Roots) -> float:
    """Return K' - |shift|, right to rounding however close to K' the shift is.

    The textbooks give the shift itself as an incomplete elliptic integral of the first kind. When
    the axis passes near a pole it is close to K', and all depends on the difference, which a
    subtraction would lose. The difference is again such an integral, from the other limit: one
    Carlson R_F (DLMF 19.25.5). R_F is homogeneous, so its arguments are scaled to be near 1.
    """
    s21, s31, s32 = roots.s21, roots.s31, roots.s32
    g1, g2, g3 = zero.from_u1, zero.from_u2, zero.from_u3
    if zero.is_below:
        share = float(s21 / g2)
        return math.sqrt(g1 / g2) * integrate_rf_in_doubles(share, share * float(g3 / s31))
    if s32 == 0:
        return 0.0  # u2 = u3 is the pole itself, which is reached at t = infinity only
    share = float(s21 / g1)
    scale = math.sqrt(g2 / s32 * s31 / g1)
    return scale * integrate_rf_in_doubles(share * float(g3 / s32), share)


def compute_mean_rates(
    nutation: Nutation, zeros: Zeros, k: Decimal
) -> tuple[Decimal, tuple[Decimal, ...]]:
    """Return the arithmetic-geometric mean of 1 and k, and the mean rates of the three functions.

    A mean rate is the mean of d/(2 |u - u_P|) over a nutation. k = sqrt(1 - m) is the
    complementary modulus. The means are complete elliptic integrals of the third kind divided by
    the one of the first kind, computed as in R. Bulirsch, Numer. Math. 13 (1969) 305, procedure
    cel. Its first step divides by the distance of u_P from the near turning point, which is zero
    for a pole that the axis passes; here this step is done by hand, and the distance cancels.
    """
    if k == 0:  # the separatrix: the axis spends all its time at u2 = u3, except for an instant
        return ZERO, tuple(z.d / (TWO * z.from_u2) if z.is_below else ZERO for z in zeros)
    mean, products = _iterate_mean(k)
    rates = []
    for zero in zeros:
        rate = (nutation.beta * zero.from_u3).sqrt()
        # sqrt(nearness), by the product of the three distances: a root of 50 digits is slow.
        near = zero.from_u2 if zero.is_below else zero.from_u1
        root = abs(zero.d) / (rate * near) if rate else zero.nearness.sqrt()
        integral = _third_kind(zero, root, k, mean, products)
        size = mean * HALF * rate * integral
        rates.append(-size if zero.sign < 0 else size)
    return mean, tuple(rates)


def compute_mean(k: Decimal) -> Decimal:
    """Return the arithmetic-geometric mean of 1 and k."""
    return _iterate_mean(k)[0]


def _iterate_mean(k: Decimal) -> tuple[Decimal, list[Decimal]]:
    """Return the arithmetic-geometric mean of 1 and k, and 4^n a_n b_n of its steps n >= 1."""
    a, b, power, products = ONE, k, ONE, []
    # Convergence is quadratic: of 50 digits this leaves 48.
    converged = ONE.scaleb(-(getcontext().prec // 2 - 1))
    while a - b > converged * a:
        a, b, power = (a + b) * HALF, (a * b).sqrt(), 4 * power
        products.append(power * a * b)
    return (a + b) * HALF, products


def _third_kind(
    zero: Zero, root: Decimal, k: Decimal, mean: Decimal, products: list[Decimal]
) -> Decimal:
    """Return the complete integral of the third kind, times 2/pi sqrt(from_u1 from_u2).

    `root` is the square root of the nearness.
    """
    near = root * root
    # With root = sqrt(near) these are Bulirsch's a, b/root and p root after the first step. In
    # these variables nothing is divided by the nearness, which is 0 for a pole on the way.
    c, d = ONE + near, TWO * (ONE + k)
    p = ONE + k * near if zero.is_below else k + near
    for product in products:
        e = product / p
        c, d, p = near * d / p + c, TWO * (c * e + d), near * e + p
    m = mean * Decimal(2 ** (len(products) + 1))
    return (c * m + root * d) / (m * (root * m + p))
