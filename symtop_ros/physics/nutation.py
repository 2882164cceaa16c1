"""The cubic that the height u = cos(theta) of the axis obeys, (du/dt)**2 = f(u), and its roots.

The height is measured from the start, s = u - u0: expanded about u = 0 the coefficients of f lose
the digits of a small tilt, about the start each is a sum of products of the data. All rates are
divided by Ix, which leaves `pull` = 2 Mgl/Ix and `spin` = p_psi/Ix beside the angular velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from symtop_ros.physics.precise import HALF, TWO, ZERO

SAME = Decimal("1e-30")  # two roots closer than sqrt(SAME) of their size are one, given as doubles
Four = tuple[float, float, float, float]
Three = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Start:
    """What the motion of the axis depends on, at t = 0.

    Attributes
    ----------
    pull : Decimal
        2 Mgl/Ix, in rad^2/s^2.
    spin : Decimal
        p_psi/Ix = (Iz/Ix) omega_z, in rad/s.
    below, above : Decimal
        1 - u0 = 2 |B|^2 and 1 + u0 = 2 |A|^2, the distances from the two poles.
    around : Decimal
        sin^2(theta) phi', in rad/s.
    fall : Decimal
        sin(theta) theta' = -du/dt, in rad/s.
    across : Decimal
        theta'^2 + sin^2(theta) phi'^2, in rad^2/s^2: the angular velocity across the axis, squared.
    """

    pull: Decimal
    spin: Decimal
    below: Decimal
    above: Decimal
    around: Decimal
    fall: Decimal
    across: Decimal

    @classmethod
    def of(cls, moments: Three, orientation: Four, angular_velocity: Three) -> Start:
        """Return the start of a top (Ix, Iz, Mgl) at (w, x, y, z) with a body angular velocity."""
        Ix, Iz, Mgl = (Decimal(x) for x in moments)
        w, x, y, z = (Decimal(c) for c in orientation)
        wx, wy, wz = (Decimal(c) for c in angular_velocity)
        upper, lower = w * w + z * z, x * x + y * y
        twice = TWO / (upper + lower)
        gx, gy = twice * (x * z - w * y), twice * (y * z + w * x)
        return cls(
            pull=TWO * Mgl / Ix,
            spin=wz * Iz / Ix,
            below=twice * lower,
            above=twice * upper,
            around=wx * gx + wy * gy,
            fall=wx * gy - wy * gx,
            across=wx * wx + wy * wy,
        )

    @property
    def u(self) -> Decimal:
        """cos(theta) at the start."""
        return (self.above - self.below) * HALF

    def momentum_about(self, s: Decimal) -> Decimal:
        """(p_phi - p_psi u)/Ix at u = u0 + s, in rad/s: sin^2(theta) phi' at that height."""
        return self.around - self.spin * s


@dataclass(frozen=True, slots=True)
class Heights:
    """Roots s1 <= 0 <= s2 <= s3 of f, measured from the start, and their differences."""

    s1: Decimal
    s2: Decimal
    s3: Decimal
    s21: Decimal
    s32: Decimal

    @property
    def s31(self) -> Decimal:
        """The largest difference."""
        return self.s21 + self.s32


def turning_heights(start: Start) -> Heights:
    """Roots of f(s)/pull = s**3 + a2 s**2 + a1 s + a0.

    f(0) = (du/dt)**2 and f'(0) = 2 d2u/dt2 at the start. Newton's method finds the root that stands
    alone, coming from outside, where it is monotone; the other two follow from their sum and
    product (Vieta).
    """
    pull, u = start.pull, start.u
    bend = start.spin * start.around - u * start.across
    a2 = TWO * u - (start.across + start.spin * start.spin) / pull
    a1 = TWO * bend / pull - start.above * start.below
    a0 = start.fall * start.fall / pull
    middle = -a2 / 3
    if _cubic(middle, a2, a1, a0) > 0:  # s1 < middle < s2: the lower root stands alone
        s1 = min(-_outer_root(-a2, a1, -a0, start.above), ZERO)
        total = -(a2 + s1)  # of s2 and s3
        if total >= -s1:
            product = a1 - s1 * total
        else:  # both are small beside s1, and their sum has lost its digits
            product = -a0 / s1
            total = (a1 - product) / s1
        half_sum = total * HALF
        half_gap = _half_gap(half_sum, product)
        s3 = half_sum + half_gap
        s2 = product / s3
        return Heights(s1, s2, s3, s2 - s1, TWO * half_gap)
    bound = max(-a2, ZERO) + max(-a1, ZERO).sqrt()  # Lagrange's: a0 >= 0
    s3 = _outer_root(a2, a1, a0, max(bound, start.below))
    product = a0 / s3  # of s2 and -s1
    half_sum = (a1 + product) / (TWO * s3)
    half_gap = (half_sum * half_sum + product).sqrt()
    s2 = half_sum + half_gap if half_sum >= 0 else product / (half_gap - half_sum)
    s1 = half_sum - half_gap if half_sum < 0 else -product / s2 if s2 else ZERO
    return Heights(s1, s2, s3, TWO * half_gap, s3 - s2)


def _half_gap(half_sum: Decimal, product: Decimal) -> Decimal:
    """Half the difference of two roots; 0 where they agree to all digits that doubles can tell."""
    square = half_sum * half_sum
    discriminant = square - product
    return discriminant.sqrt() if discriminant > SAME * square else ZERO


def _cubic(s: Decimal, a2: Decimal, a1: Decimal, a0: Decimal) -> Decimal:
    return ((s + a2) * s + a1) * s + a0


def _outer_root(a2: Decimal, a1: Decimal, a0: Decimal, s: Decimal) -> Decimal:
    """Largest root, by Newton's method from a bound s on it, until rounding stops the descent."""
    while True:
        value = _cubic(s, a2, a1, a0)
        slope = (3 * s + TWO * a2) * s + a1
        if value <= 0 or slope <= 0:
            return s
        following = s - value / slope
        if not following < s:
            return s
        s = following
