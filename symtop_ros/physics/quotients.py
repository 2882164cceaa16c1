"""The three functions of time that make up the motion, each a quotient of theta functions.

A, B and conj(omega), the Cayley-Klein parameters and the angular velocity omega = omega_x +
i omega_y across the axis, are all of the form

    C  th_k(v + i shift) / th4(v)  exp(i rate t),        v = v0 + Omega t.

Each vanishes at one height u_P of the axis: A at the lower pole u = -1, B at the upper pole u = 1,
omega where the whole energy would be potential. There f(u_P) = -d**2, d = (p_phi - p_psi u_P)/Ix,
and shift and rate follow from d and the distances of u_P from the three roots of f in the same way
for all three. (Klein & Sommerfeld, Theory of the Top, ch. VI; Whittaker, Analytical Dynamics,
sections 72-73. The third function obeys the same argument.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal

from scipy.special import elliprf

from symtop_ros.physics.nutation import Heights, Start
from symtop_ros.physics.precise import HALF, ONE, TWO, ZERO

CONVERGED = Decimal("1e-17")  # convergence is quadratic: this leaves 34 digits


@dataclass(frozen=True, slots=True)
class Quotient:
    """Where one quotient vanishes: d and the distances of u_P from u1, u2, u3.

    `beneath` tells A, which vanishes below the motion, from the other two, which do so above it.
    """

    beneath: bool
    d: Decimal
    from_u1: Decimal
    from_u2: Decimal
    from_u3: Decimal

    @property
    def nearness(self) -> Decimal:
        """Distance of u_P from the near turning point, relative to that from the far one."""
        if self.beneath:
            return self.from_u1 / self.from_u2
        return self.from_u2 / self.from_u1


def quotients(start: Start, heights: Heights) -> tuple[Quotient, Quotient, Quotient]:
    """Return where A, B and omega vanish."""
    return (
        _vanishing_beneath(start, heights),
        _vanishing_above(start, heights, start.below),
        _vanishing_above(start, heights, start.across / start.pull),
    )


def _vanishing_beneath(start: Start, heights: Heights) -> Quotient:
    d = start.momentum_about(-start.above)
    from_u2, from_u3 = start.above + heights.s2, start.above + heights.s3
    return Quotient(True, d, d * d / (start.pull * from_u2 * from_u3), from_u2, from_u3)


def _vanishing_above(start: Start, heights: Heights, height: Decimal) -> Quotient:
    """Of the distances from u2 and u3 the smaller comes from the product f(u_P) = -d**2."""
    d = start.momentum_about(height)
    from_u1, from_u2, from_u3 = height - heights.s1, height - heights.s2, heights.s3 - height
    product = d * d / (start.pull * from_u1)
    if heights.s32 == 0:
        from_u2 = from_u3 = ZERO
    elif from_u2 <= from_u3:
        from_u2 = product / from_u3
    else:
        from_u3 = product / from_u2
    return Quotient(False, d, from_u1, from_u2, from_u3)


def shifts(found: tuple[Quotient, ...], heights: Heights) -> list[float]:
    """K' - |shift| of each quotient, to rounding however close to K' the shift is.

    The complement of an elliptic integral of the first kind, by Carlson's R_F (DLMF 19.25.5).
    """
    return [_from_quarter_period(quotient, heights) for quotient in found]


def _from_quarter_period(quotient: Quotient, heights: Heights) -> float:
    s21, s31, s32 = heights.s21, heights.s31, heights.s32
    g1, g2, g3 = quotient.from_u1, quotient.from_u2, quotient.from_u3
    if quotient.beneath:
        share = float(s21 / g2)
        return math.sqrt(g1 / g2) * float(elliprf(share, share * float(g3 / s31), 1.0))
    if s32 == 0:
        return 0.0  # both roots are the pole, reached at t = infinity only
    share = float(s21 / g1)
    scale = math.sqrt(g2 / s32 * s31 / g1)
    return scale * float(elliprf(share * float(g3 / s32), share, 1.0))


def mean_rates(
    start: Start, found: tuple[Quotient, ...], k: Decimal
) -> tuple[Decimal, tuple[Decimal, ...]]:
    """Arithmetic-geometric mean of 1 and k, and the mean of d/(2 |u - u_P|) over a nutation.

    k = sqrt(1 - m) is the complementary modulus. The means are complete elliptic integrals of the
    third kind divided by the one of the first kind, computed as in R. Bulirsch, Numer. Math. 13
    (1969) 305, procedure cel, with its first step done by hand: it is the one that would divide by
    the distance from a pole which the axis passes.
    """
    if k == 0:
        return ZERO, tuple(q.d / (TWO * q.from_u2) if q.beneath else ZERO for q in found)
    mean, products = _means(k)
    rates = []
    for quotient in found:
        scale = mean * HALF * (start.pull * quotient.from_u3).sqrt()
        rates.append((scale * _third_kind(quotient, k, mean, products)).copy_sign(quotient.d))
    return mean, tuple(rates)


def _means(k: Decimal) -> tuple[Decimal, list[Decimal]]:
    """Arithmetic-geometric mean of 1 and k, and 4**n a_n b_n of its steps from the first on."""
    a, b, power, products = ONE, k, ONE, []
    while a - b > CONVERGED * a:
        a, b, power = (a + b) * HALF, (a * b).sqrt(), 4 * power
        products.append(power * a * b)
    return (a + b) * HALF, products


def _third_kind(quotient: Quotient, k: Decimal, mean: Decimal, products: list[Decimal]) -> Decimal:
    """Complete integral of the third kind times sqrt(g1 g2) 2/pi, for near/far = g1/g2 or g2/g1."""
    near = quotient.nearness
    c, d = ONE + near, TWO * (ONE + k)
    p = ONE + k * near if quotient.beneath else k + near
    for product in products:
        e = product / p
        c, d, p = near * d / p + c, TWO * (c * e + d), near * e + p
    m = mean * Decimal(2 ** (len(products) + 1))
    root = near.sqrt()
    return (c * m + root * d) / (m * (root * m + p))
