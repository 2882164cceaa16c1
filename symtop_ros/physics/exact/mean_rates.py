"""Mean phi' and psi' of a nutation, with as many digits as their terms lose.

They are sum and difference of the mean rates of arg A and arg B. Under weak gravity these may
cancel: a sphere that hardly feels its weight turns about L, and the mean psi' is as small as the
weight. Then the constants of the motion are computed again, with more digits.
"""

from decimal import Decimal, localcontext

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.nutation import Nutation, Roots, find_roots
from symtop_ros.physics.exact.precise import PRECISE, ZERO
from symtop_ros.physics.exact.quotients import Zeros, compute_mean_rates, find_zeros

KEPT = 20  # digits that a sum of the rates must have (design/lost_sums.py)
# Digits that are tried. No double is so small that more could be lost: what is left is zero.
MORE_DIGITS = (110, 250, 700)


def solve(
    moments: Vector, orientation: Quaternion, angular_velocity: Vector
) -> tuple[Nutation, Roots, Zeros, tuple[Decimal, tuple[Decimal, ...]]]:
    """Return the constants of a motion, with the digits in use: the last two are its mean rates."""
    nutation = Nutation.of(moments, orientation, angular_velocity)
    roots = find_roots(nutation)
    zeros = find_zeros(nutation, roots)
    # The complementary modulus from s32, not as sqrt(1 - m): near the separatrix that would have no
    # digits.
    k = (roots.s32 / roots.s31).sqrt()
    return nutation, roots, zeros, compute_mean_rates(nutation, zeros, k)


def add_means(
    a: Decimal,
    b: Decimal,
    c: Decimal,
    moments: Vector,
    orientation: Quaternion,
    angular_velocity: Vector,
) -> tuple[Decimal, Decimal]:
    """Return a + b and a - b + c, for the means a and b of arg A and arg B, and c.

    They are given with 50 digits. If the sums have lost too many, a, b and c are computed again.
    """
    sums = _add(a, b, c, PRECISE.prec)
    for digits in MORE_DIGITS:
        if None not in sums:
            break
        with localcontext(PRECISE) as context:
            context.prec = digits
            sums = _add(*_compute_terms(moments, orientation, angular_velocity), digits)
    precession, spin = sums
    return precession or ZERO, spin or ZERO


def _add(a: Decimal, b: Decimal, c: Decimal, digits: int) -> tuple[Decimal | None, Decimal | None]:
    """Return a + b and a - b + c, each None if rounding is all that it has."""
    lost = max(abs(a), abs(b), abs(c)).scaleb(KEPT - digits)
    precession, spin = a + b, a - b + c
    return (
        precession if abs(precession) >= lost else None,
        spin if abs(spin) >= lost else None,
    )


def _compute_terms(
    moments: Vector, orientation: Quaternion, angular_velocity: Vector
) -> tuple[Decimal, Decimal, Decimal]:
    *_, (_, (a, b, _)) = solve(moments, orientation, angular_velocity)
    Ix, Iz, wz = map(Decimal, (moments[0], moments[1], angular_velocity[2]))
    return a, b, wz * (Ix - Iz) / Ix
