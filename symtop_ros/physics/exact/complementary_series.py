"""The theta quotients summed in the nome q', for m > 1/2, after Jacobi's imaginary transformation.

The transformation turns cos(n x) into cosh(n y) with y = x K/K', which overflows near the
separatrix. The common factor exp(|y|) and its powers are therefore divided out, and the basis is
1, h^n, E^n with E = exp(-|y|) and h = exp(|y| - pi K/K'). All of them are at most 1. At the
separatrix (K infinite, h = q' = 0) only the first terms remain, the hyperbolic functions.

Each numerator is the sum over all integers n of (-1)^n q'^(n^2 - n) w^n, up to a phase, with
w = E exp(i phi) for A and w = h exp(-i phi) for the other two, phi = pi (K' - shift)/K'. Its terms
n and 1 - n have the common factor 1 - w. It vanishes if the axis passes the pole, and is written
with expm1; what remains of the sum is called the cofactor here. So the digits of a quotient are
relative to its own size there.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from symtop_ros.physics.exact.direct_series import raise_to_squares
from symtop_ros.physics.exact.elementary import (
    FloatPair,
    Location,
    Number,
    Pair,
    Shift,
    choose_smaller,
    cosine_and_sine,
    expand_exponential,
    exponential,
    exponential_minus_1,
    find_sign,
    find_size,
    multiply,
    to_floats,
)

# Coefficients of 1 and h^n, and of E^n.
Exponentials = tuple[list[float], list[float]]


class ComplementaryNumerator(NamedTuple):
    """One theta function without its factor 1 - w, and what 1 - w is made of."""

    real: Exponentials  # of the cofactor
    imaginary: Exponentials
    angle: float  # pi shift/K'
    versine: float  # 1 - cos(phi)
    sine: float  # sin(phi)
    is_below: bool  # True for A, whose w falls with |y| from the lower turning point
    winding: int


class Basis(NamedTuple):
    """Common parts of the three quotients at one place."""

    sign: Number  # of y
    decay: Number  # exp(-|y|/2)
    h: Number
    E: Number
    rising_gap: Number  # 1 - h
    falling_gap: Number  # 1 - E
    divisor: Number  # theta_4 without its exponential growth


class ComplementarySeries:
    """Sums in the nome q'."""

    def __init__(self, K: float, Kc: float, shifts: Sequence[Shift], root_of_nome: float) -> None:
        self._K, self._Kc, self._root = K, Kc, root_of_nome
        q = float(exponential(-math.pi * K / Kc))
        powers, inverses = _sum_powers(q)
        self._numerators = [_expand_numerator(powers, inverses, Kc, shift) for shift in shifts]
        # Theta_4 and theta_2 change places (DLMF 20.7.31 and 20.7.33), theta_3 stays theta_3.
        self._divisor = (
            [1.0, *raise_to_squares(q)],
            [1.0, *_raise_to_pairs(q)[:3]],
        )

    def values(self, at: Location) -> list[Pair]:
        """Return real and imaginary parts of the three quotients."""
        basis = self._find_basis(at)
        quotients = []
        for each in self._numerators:
            size = 1 / basis.divisor if each.is_below else basis.decay / basis.divisor
            phase = (each.angle / (2 * math.pi) + each.winding) * at.x
            if each.is_below:
                phase = phase - basis.sign * (0.5 * each.angle)
            numerator = multiply(_sum_cofactor(each, basis), _compute_one_minus_w(each, basis))
            c, s = cosine_and_sine(phase)
            quotients.append(multiply(numerator, (size * c, -size * s)))
        return quotients

    def _find_basis(self, at: Location) -> Basis:
        decay = self._find_decay(at)
        power, p = expand_exponential(-at.above)
        h, E = power + power * p, decay * decay
        return Basis(
            find_sign(at.below),
            decay,
            h,
            E,
            (1.0 - power) - power * p,
            -exponential_minus_1(-find_size(at.below)),
            _sum_exponentials(self._divisor, h, E),
        )

    def _find_decay(self, at: Location) -> Number:
        """Return exp(-|y|/2), from the distance of the nearer turning point.

        The rounding of a large |y| would be an error of the small result. exp(-|y|/2) is therefore
        sqrt(q') exp(above/2) in the upper half of the nutation. What the rounding of the distance
        has lost is a factor 1 + low/2, since its square is nothing.
        """
        size = find_size(at.below)
        scale = choose_smaller(at.above, size, self._root, 1.0)
        decay = scale * exponential(choose_smaller(at.above, size, at.above, -size) / 2)
        return decay + decay * (0.5 * at.low)

    def slope(self, k: int, at: Location) -> FloatPair:
        """Return the derivative of quotient k with respect to v, with the winding held.

        A quotient is decay cofactor (1 - w) exp(-i phase)/divisor, without the decay for A. All but
        the phase depend on |y|, and d|y|/dv is sign pi/K'; the phase depends on x, dx/dv = pi/K.
        """
        each, value = self._numerators[k], to_floats(self.values(at)[k])
        basis = self._find_basis(at._replace(low=0.0))
        sign, h, E, divisor = map(float, (basis.sign, basis.h, basis.E, basis.divisor))
        factor = to_floats(_compute_one_minus_w(each, basis))
        cofactor = to_floats(_sum_cofactor(each, basis))
        cofactor_slope = _sum_slopes(each.real, h, E), sign * _sum_slopes(each.imaginary, h, E)
        # of 1 - w: w for A, -w for the others
        w_slope = (1 - factor[0], -factor[1]) if each.is_below else (factor[0] - 1, factor[1])
        first, second = multiply(cofactor_slope, factor), multiply(cofactor, w_slope)
        turn = each.angle / (2 * math.pi)
        phase = turn * at.x + each.winding * at.x
        if each.is_below:
            phase -= 0.5 * sign * each.angle
        c, s = to_floats(cosine_and_sine(phase))
        size = (1.0 if each.is_below else float(basis.decay)) / divisor
        real, imaginary = to_floats(
            multiply((first[0] + second[0], first[1] + second[1]), (size * c, -size * s))
        )
        # Logarithmic derivatives of what the value is divided by: the divisor, and 1/decay.
        falling = _sum_slopes(self._divisor, h, E) / divisor + (0.0 if each.is_below else 0.5)
        in_y, in_x = sign * math.pi / self._Kc, math.pi / self._K * turn
        return (
            in_y * (real - value[0] * falling) + in_x * value[1],
            in_y * (imaginary - value[1] * falling) - in_x * value[0],
        )


def _sum_cofactor(each: ComplementaryNumerator, basis: Basis) -> Pair:
    imaginary = basis.sign * _sum_exponentials(each.imaginary, basis.h, basis.E)
    return _sum_exponentials(each.real, basis.h, basis.E), imaginary


def _compute_one_minus_w(each: ComplementaryNumerator, basis: Basis) -> Pair:
    """Return 1 - w = (1 - r) + r (1 - cos(phi)) -+ i r sin(phi), with r = |w| = E or h.

    Both terms of the real part are positive: nothing cancels where w is near 1.
    """
    if each.is_below:
        real = each.versine * basis.E + basis.falling_gap
        return real, -each.sine * (basis.sign * basis.E)
    real = each.versine * basis.h + basis.rising_gap
    return real, each.sine * (basis.sign * basis.h)


def _sum_exponentials(coefficients: Exponentials, h: Number, E: Number) -> Number:
    """Return the sum of rising[n] h^n, n = 0 ..., and falling[n - 1] E^n, n = 1 ..."""
    (c0, c1, c2, c3, c4), (d1, d2, d3, d4) = coefficients
    return c0 + (h * (c1 + h * (c2 + h * (c3 + h * c4))) + E * (d1 + E * (d2 + E * (d3 + E * d4))))


def _sum_slopes(coefficients: Exponentials, h: float, E: float) -> float:
    """Return the derivative of `_sum_exponentials` in |y|, with which h grows and E falls."""
    (_, c1, c2, c3, c4), (d1, d2, d3, d4) = coefficients
    rising = h * (c1 + h * (2 * c2 + h * (3 * c3 + h * (4 * c4))))
    return rising - E * (d1 + E * (2 * d2 + E * (3 * d3 + E * (4 * d4))))


def _raise_to_pairs(q: float) -> tuple[float, float, float, float]:
    """Return q^2, q^6, q^12 and q^20: q to the power of n (n + 1)."""
    second = q * q
    fourth = second * second
    eighth = fourth * fourth
    return second, fourth * second, eighth * fourth, eighth * eighth * fourth


def _sum_powers(q: float) -> tuple[list[float], list[float]]:
    """Return the sums over k = n ... 4 of (-1)^k q^(k^2 + k), and those of (-1)^k q^(k^2 + k - n).

    The second are written out: divided by q^n, since q may be zero, and the smallest term first.
    """
    q2, q6, q12, q20 = _raise_to_pairs(q)
    q4 = q2 * q2
    q5, q8 = q4 * q, q4 * q4
    powers = [1 - (q2 - (q6 - (q12 - q20))), -(q2 - (q6 - (q12 - q20))), q6 - (q12 - q20)]
    q9, q16, q10 = q8 * q, q8 * q8, q8 * q2
    inverses = [powers[0], -(q - (q5 - (q10 * q - q16 * q2 * q))), q4 - (q10 - q16 * q2)]
    return [*powers, -(q12 - q20), q20], [*inverses, -(q9 - q16 * q), q16]


def _expand_numerator(
    powers: list[float], inverses: list[float], Kc: float, shift: Shift
) -> ComplementaryNumerator:
    """Return the coefficients of a numerator divided by 1 - w: of 1 and h^n, and of E^n.

    The cofactor is the sum over k of (-1)^k q^(k^2 + k) (1 + w + 1/w + ... + w^k + 1/w^k). With
    h E = q, 1/w is h exp(-i phi)/q for A and E exp(i phi)/q for the others. The q in this
    denominator is divided out of q^(k^2 + k) first: h and q may both be zero.
    """
    phi = shift.sign * math.pi * shift.complement / Kc
    of_h, of_E = (inverses, powers) if shift.is_below else (powers, inverses)
    turns = [to_floats(cosine_and_sine(phi * n)) for n in range(5)]
    half_sine = to_floats(cosine_and_sine(phi / 2))[1]
    return ComplementaryNumerator(
        real=(
            [size * c for size, (c, _) in zip(of_h, turns, strict=True)],
            [size * c for size, (c, _) in zip(of_E[1:], turns[1:], strict=True)],
        ),
        imaginary=(
            [-size * s for size, (_, s) in zip(of_h, turns, strict=True)],
            [size * s for size, (_, s) in zip(of_E[1:], turns[1:], strict=True)],
        ),
        angle=shift.sign * math.pi * (1 - shift.complement / Kc),
        versine=2 * half_sine * half_sine,
        sine=turns[1][1],
        is_below=shift.is_below,
        winding=shift.winding,
    )
