"""The theta quotients summed in the nome q, for m <= 1/2.

A sum in cos(n x) would lose a quotient near its zero, where it is a small difference of large
terms. Each quotient is therefore expanded about the turning point at which it may vanish: A about
the lower one, B and omega_xy about the upper one. Its value there is formed without cancellation,
and the rest are terms in 1 - cos(n delta), with delta the distance from that turning point. They
are products of sin(delta/2). So the digits of a quotient are relative to its own size, and the
tilt of an axis that passes a pole is right to rounding of itself.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from symtop_ros.physics.exact.elementary import (
    ORDERS,
    FloatPair,
    Location,
    Number,
    Pair,
    Shift,
    choose_smaller,
    cosine_and_sine,
    cosine_and_sine_near_0,
    exponential,
    exponential_minus_1,
    find_sign,
    find_size,
    multiply,
    to_floats,
)

NEGLIGIBLE = 2.0**-60  # of the largest coefficient, which is 1: such a term changes no sum
# 1 - cos(n delta) is one of these factors times a product of y = sin(delta/2)^2 and polynomials in
# it that have no factor in common (`_list_versines`):
#   1 - cos(delta)   =  2 y
#   1 - cos(2 delta) =  8 y (1 - y)
#   1 - cos(3 delta) =  2 y (3 - 4 y)^2
#   1 - cos(4 delta) = 32 y (1 - y) cos(delta)^2
# The factors are powers of two. They go into the coefficients, where they round nothing.
VERSINE_FACTORS = (2, 8, 2, 32)


class DirectNumerator(NamedTuple):
    """Coefficients of one theta function; the denominator theta_4 has the same form."""

    even: list[float]  # of cos(n x), n = 0, 1, ...
    odd: list[float]  # of sin(n x), n = 1, 2, ...
    versines: list[float]  # the value at the zero's turning point, and of 1 - cos(n delta)
    is_below: bool  # True if that turning point is the lower one
    winding: int


class DirectSeries:
    """Sums in the nome q."""

    def __init__(self, K: float, Kc: float, shifts: Sequence[Shift]) -> None:
        self._K = K
        nome = float(exponential(-math.pi * Kc / K))
        # theta_4 is theta_3 with alternating signs. It is the numerator of A and the denominator.
        q, q4, q9, q16 = raise_to_squares(nome)
        divisor = [1.0, -2 * q, 2 * q4, -2 * q9, 2 * q16]
        parts = [_expand_numerator(K, Kc, shift) for shift in shifts]
        self._order = max(n for n in ORDERS if n == 1 or any(even[n] for even, _, _ in parts))
        self._numerators = [
            self._collect(*part, shift) for part, shift in zip(parts, shifts, strict=True)
        ]
        unshifted = Shift(1.0, Kc, is_below=True)
        self._divisor = self._collect(divisor, [0.0] * 5, _add(divisor), unshifted)

    def _collect(
        self, even: list[float], odd: list[float], least: float, shift: Shift
    ) -> DirectNumerator:
        """Return the coefficients up to the order in use.

        About the upper turning point cos(n x) is (-1)^n cos(n delta).
        """
        versines = [least]
        for n, factor in zip(ORDERS, VERSINE_FACTORS, strict=True):
            parity = 1 if shift.is_below else (-1) ** n
            versines.append(-factor * parity * even[n])
        end = self._order + 1
        return DirectNumerator(even, odd[1:end], versines[:end], shift.is_below, shift.winding)

    def values(self, at: Location) -> list[Pair]:
        """Return real and imaginary parts of the three quotients."""
        s, c = _find_half_angle(at)
        sine_x, cosine_x = 2 * s * c, (c - s) * (c + s)
        lower, upper = self._list_versines(s * s, c * c, cosine_x)
        sines = self._list_sines(sine_x, cosine_x)
        per_divisor = 1 / _sum(self._divisor.versines, lower)
        quotients = []
        for each in self._numerators:
            real = _sum(each.versines, lower if each.is_below else upper) * per_divisor
            quotient = real, _sum(each.odd, sines) * per_divisor
            if each.winding:
                turn = cosine_x, -math.copysign(1.0, each.winding) * sine_x
                for _ in range(abs(each.winding)):
                    quotient = multiply(quotient, turn)
            quotients.append(quotient)
        return quotients

    def _list_versines(
        self, lower: Number, upper: Number, cosine_x: Number
    ) -> tuple[list[Number], list[Number]]:
        """Return 1 and the parts of 1 - cos(n delta), for delta = |x| and delta = pi - |x|.

        `lower` and `upper` are y = sin(delta/2)^2 for the two, and each is 1 - y of the other one.
        So the parts of orders 2 and 4 are the same for both.
        """
        below: list[Number] = [1.0, lower]
        above: list[Number] = [1.0, upper]
        if self._order > 1:
            product = lower * upper
            below.append(product)
            above.append(product)
        if self._order > 2:
            for parts, y in (below, lower), (above, upper):
                triple = 3 - 4 * y
                parts.append(y * (triple * triple))
        if self._order > 3:
            fourth = product * (cosine_x * cosine_x)
            below.append(fourth)
            above.append(fourth)
        return below, above

    def _list_sines(self, sine_x: Number, cosine_x: Number) -> list[Number]:
        """Return sin(n x) for all orders, by the Chebyshev polynomials of the second kind."""
        sines = [sine_x]
        if self._order > 1:
            sines.append(2 * sine_x * cosine_x)
        if self._order > 2:
            square = 4 * cosine_x * cosine_x
            sines += [sine_x * (square - 1), sines[1] * (square - 2)][: self._order - 2]
        return sines

    def slope(self, k: int, at: Location) -> FloatPair:
        """Return the derivative of quotient k with respect to v, with the winding held."""
        numerator, divisor = self._numerators[k], self._divisor.even
        value = to_floats(self.values(at)[k])
        size, real, imaginary, rate_of_size = divisor[0], 0.0, 0.0, 0.0
        for n in range(1, self._order + 1):
            c, s = to_floats(cosine_and_sine(n * at.x))
            size += divisor[n] * c
            rate_of_size -= n * divisor[n] * s
            real -= n * (numerator.even[n] * s)
            imaginary += n * (numerator.odd[n - 1] * c)
        if numerator.winding:
            c, s = to_floats(cosine_and_sine(numerator.winding * at.x))
            real, imaginary = to_floats(multiply((real, imaginary), (c, -s)))
        # The quotient rule (N/D)' = (N' - (N/D) D')/D, and dx/dv = pi/K.
        scale = math.pi / self._K
        return (
            scale * (real - value[0] * rate_of_size) / size,
            scale * (imaginary - value[1] * rate_of_size) / size,
        )


def _find_half_angle(at: Location) -> Pair:
    """Return sin(x/2) and cos(x/2), each right to rounding of itself.

    Both come from the distance of the nearer turning point, which has its digits.
    """
    size = find_size(at.x)
    c, s = cosine_and_sine_near_0(0.5 * choose_smaller(size, at.above, size, at.above))
    sign = find_sign(at.x)
    return sign * choose_smaller(size, at.above, s, c), choose_smaller(size, at.above, c, s)


def raise_to_squares(q: float) -> tuple[float, float, float, float]:
    """Return q, q^4, q^9 and q^16."""
    second = q * q
    fourth = second * second
    eighth = fourth * fourth
    return q, fourth, eighth * q, eighth * eighth


def _add(terms: Sequence[float]) -> float:
    """Return a sum, the smallest term first."""
    total = 0.0
    for term in reversed(terms):
        total += term
    return total


def _sum(coefficients: Sequence[float], basis: Sequence[Number]) -> Number:
    total = coefficients[0] * basis[0]
    for coefficient, term in zip(coefficients[1:], basis[1:], strict=True):
        total = total + coefficient * term
    return total


def _expand_numerator(K: float, Kc: float, shift: Shift) -> tuple[list[float], list[float], float]:
    """Return the coefficients of cos(n x) and of sin(n x), and the value where it may vanish.

    q^(n^2) is tiny and exp(n pi |shift|/K) is huge, up to overflow; so their exponents are added
    first. `large` and `small` belong to +|shift| and -|shift|, with |shift| = K' - complement.

    The value at the point of the zero is the sum of the even terms with alternating signs. With its
    terms n and 1 - n paired it is the sum of
    (-1)^n small_n (1 - exp(-(2 n + 1) pi complement/K)), in which nothing cancels.
    """
    rate, complement = -math.pi / K, shift.complement
    even, odd, least = (
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0] * 5,
        -float(exponential_minus_1(rate * complement)),
    )
    if Kc == math.inf:  # m = 0, regular precession: the quotient is constant
        return even, odd, least
    for n in ORDERS:
        parity = (-1) ** n
        large = float(exponential(rate * (Kc * (n * n - n) + complement * n)))
        if large < NEGLIGIBLE:
            break
        small = float(exponential(rate * (Kc * (n * n + n) - complement * n)))
        own = parity if shift.is_below else 1
        even[n], odd[n] = own * (small + large), own * shift.sign * (small - large)
        least -= parity * small * float(exponential_minus_1(rate * complement * (2 * n + 1)))
    return even, odd, least
