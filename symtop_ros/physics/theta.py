"""The theta quotients as functions of the nutation phase, summed in the smaller nome.

Each of A, B and conj(omega_xy) is th_k(v + i shift)/th4(v) times a constant and an exponential,
with k = 4 for A and k = 3 for the other two. th_k(v) = theta_k(pi v/(2 K) | q) are Jacobi's theta
functions (DLMF 20.2). The series in the nome q = exp(-pi K'/K) converge fast for m <= 1/2 and
ever more slowly towards the separatrix m = 1. For m > 1/2 they are summed after Jacobi's imaginary
transformation (DLMF 20.7.30 to 20.7.33) in the nome q' = exp(-pi K/K'). With the better of the two
no nome exceeds exp(-pi) = 0.043, and the first term left out is below 1e-16 of the sum.

`scipy.special.ellipj` is not used: for m near 1 and for large arguments it loses all digits (SciPy
issue 8480).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Protocol

from symtop_ros.physics.elementary import (
    Number,
    Pair,
    choose_smaller,
    cosine,
    exponential,
    exponential_minus_1,
    find_sign,
    find_size,
    multiply,
    sine,
    to_complex,
)

ORDERS = range(1, 5)
NEGLIGIBLE = 2.0**-60  # of the largest coefficient, which is 1: such a term changes no sum

# Coefficients of 1 and h^n, and of E^n, for the real and the imaginary part.
Cofactor = tuple[tuple[list[float], list[float]], tuple[list[float], list[float]]]


class Series(Protocol):
    """The three quotients, 2 pi-periodic in the phase x; x = 0 is the lower turning point.

    A phase is given as x in [-pi, pi] and as its distances from the turning points: below = x and
    above = pi - |x|, both multiplied by K/K' for `ComplementarySeries`. Each of the three is right
    to rounding of itself. What rounding left of the smaller distance may be given, too: `rest` is
    to be added to -|below| or to above, whichever is smaller in size.
    """

    def values(self, x: Number, below: Number, above: Number, rest: Number = 0.0) -> list[Pair]:
        """Return real and imaginary parts of the three quotients."""

    def slope(self, k: int, x: float, below: float, above: float) -> complex:
        """Return the derivative of quotient k with respect to v, with the winding held."""


def choose_series(
    K: float,
    Kc: float,
    root_of_nome: float,
    signs: Sequence[float],
    complements: Sequence[float],
    winding: int = 0,
) -> Series:
    """Return the series in the smaller nome.

    Parameters
    ----------
    K, Kc : float
        Complete elliptic integrals K and K'.
    root_of_nome : float
        exp(-pi K/(2 K')), right to rounding however large K/K' is.
    signs : sequence of float
        Signs of the three shifts.
    complements : sequence of float
        K' - |shift| of the three quotients. The shift itself would not do: close to K' the numbers
        K' - |shift|, on which the small coefficients depend, would be lost.
    winding : int
        The third quotient is multiplied by exp(-i winding x).
    """
    within = [min(complement, Kc) for complement in complements]
    if Kc >= K:
        return DirectSeries(K, Kc, signs, within, winding)
    return ComplementarySeries(K, Kc, signs, within, root_of_nome, winding)


class DirectSeries:
    """Sums in the nome q.

    Near its zero a quotient is small, and summed in cos(n x) it would be a difference of large
    terms. Each is therefore expanded about the turning point at which it may vanish (A about the
    lower one, B and omega_xy about the upper one): its value there, and terms in 1 - cos(n delta),
    which are formed from sin(delta/2). So its digits are relative to its own size, and the tilt of
    an axis that passes a pole is right to rounding of itself.
    """

    def __init__(
        self,
        K: float,
        Kc: float,
        signs: Sequence[float],
        complements: Sequence[float],
        winding: int = 0,
    ) -> None:
        self._K, self._winding = K, winding
        nome = math.exp(-math.pi * Kc / K)
        # theta_4 is theta_3 with alternating signs. It is the numerator of A and the denominator.
        denominator = [1.0, *(2 * (-1) ** n * nome ** (n * n) for n in ORDERS)]
        numerators = [
            _expand_numerator(K, Kc, complement, sign, is_A=k == 0)
            for k, (sign, complement) in enumerate(zip(signs, complements, strict=True))
        ]
        self._even = [*(even for even, _, _ in numerators), denominator]
        self._order = max(n for n in ORDERS if n == 1 or any(even[n] for even in self._even[:3]))
        self._odd = [odd[1 : self._order + 1] for _, odd, _ in numerators]
        at_zero = [*(least for _, _, least in numerators), math.fsum(denominator)]
        # 1 - cos(n delta) of B and omega_xy is about the upper turning point: cos(n (pi - delta)).
        parities = (1, -1, -1, 1)
        self._versines = [
            (least, -2 * p * row[1], -8 * row[2], -2 * p * row[3], -32 * row[4])[: self._order + 1]
            for least, row, p in zip(at_zero, self._even, parities, strict=True)
        ]

    def values(self, x: Number, below: Number, above: Number, rest: Number = 0.0) -> list[Pair]:
        """Return real and imaginary parts of the three quotients."""
        # cos(x/2) as the sine of its distance from the zero keeps its digits there.
        s, c = sine(0.5 * x), sine(0.5 * above)
        sine_x, cosine_x = 2 * s * c, (c - s) * (c + s)
        lower, upper = self._list_versines(s * s, c * c, cosine_x)
        sines = self._list_sines(sine_x, cosine_x)
        divisor = _sum(self._versines[3], lower)
        quotients = [
            (_sum(even, versines) / divisor, _sum(odd, sines) / divisor)
            for even, odd, versines in zip(
                self._versines[:3], self._odd, (lower, upper, upper), strict=True
            )
        ]
        if self._winding:
            turn = cosine_x, -math.copysign(1.0, self._winding) * sine_x
            for _ in range(abs(self._winding)):
                quotients[2] = multiply(quotients[2], turn)
        return quotients

    def _list_versines(
        self, lower: Number, upper: Number, cosine_x: Number
    ) -> tuple[list[Number], list[Number]]:
        """Return 1 and the parts of 1 - cos(n delta), for delta = |x| and delta = pi - |x|.

        With y = sin(delta/2)^2, of which 1 - y is the same for the other turning point:
        1 - cos(delta) = 2 y, 1 - cos(2 delta) = 8 y (1 - y), 1 - cos(3 delta) = 2 y (3 - 4 y)^2,
        1 - cos(4 delta) = 32 y (1 - y) cos(delta)^2.
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
        """Return sin(n x) for all orders."""
        sines = [sine_x]
        if self._order > 1:
            sines.append(2 * sine_x * cosine_x)
        if self._order > 2:
            square = 4 * cosine_x * cosine_x
            sines += [sine_x * (square - 1), sines[1] * (square - 2)][: self._order - 2]
        return sines

    def slope(self, k: int, x: float, below: float, above: float) -> complex:
        """Return the derivative of quotient k with respect to v."""
        value = to_complex(self.values(x, below, above)[k])
        divisor, even, odd = self._even[3], self._even[k], self._odd[k]
        size, rate, rate_of_size = divisor[0], 0j, 0.0
        for n in range(1, self._order + 1):
            c, s = math.cos(n * x), math.sin(n * x)
            size += divisor[n] * c
            rate_of_size -= n * divisor[n] * s
            rate += n * complex(-even[n] * s, odd[n - 1] * c)
        if k == 2:
            rate *= cmath.exp(-1j * self._winding * x)
        return complex(math.pi / self._K * (rate - value * rate_of_size) / size)


def _sum(coefficients: Sequence[float], basis: Sequence[Number]) -> Number:
    total = coefficients[0] * basis[0]
    for coefficient, term in zip(coefficients[1:], basis[1:], strict=True):
        total = total + coefficient * term
    return total


def _expand_numerator(
    K: float, Kc: float, complement: float, sign: float, is_A: bool
) -> tuple[list[float], list[float], float]:
    """Return the coefficients of cos(n x) and of sin(n x), and the value where it may vanish.

    q^(n^2) is tiny and exp(n pi |shift|/K) is huge, up to overflow; so their exponents are added
    first. `large` and `small` belong to +|shift| and -|shift|, with |shift| = K' - complement.

    The value at the point of the zero is the sum of the even terms with alternating signs. With its
    terms n and 1 - n paired it is the sum of
    (-1)^n small_n (1 - exp(-(2 n + 1) pi complement/K)), in which nothing cancels.
    """
    rate = -math.pi / K
    even, odd, least = [1.0, 0.0, 0.0, 0.0, 0.0], [0.0] * 5, -math.expm1(rate * complement)
    for n in ORDERS:
        parity = (-1) ** n
        large = math.exp(rate * (Kc * (n * n - n) + complement * n))
        if large < NEGLIGIBLE:
            break
        small = math.exp(rate * (Kc * (n * n + n) - complement * n))
        own = parity if is_A else 1
        even[n], odd[n] = own * (small + large), own * sign * (small - large)
        least -= parity * small * math.expm1(rate * complement * (2 * n + 1))
    return even, odd, least


class ComplementarySeries:
    """Sums in the nome q', after Jacobi's imaginary transformation.

    The transformation turns cos(n x) into cosh(n y) with y = x K/K', which overflows near the
    separatrix. The common factor exp(|y|) and its powers are therefore divided out, and the basis
    is 1, h^n, E^n with E = exp(-|y|) and h = exp(|y| - pi K/K'). All of them are at most 1. At the
    separatrix (K infinite, h = q' = 0) only the first terms remain, the hyperbolic functions.

    Each numerator is the sum over all integers n of (-1)^n q'^(n^2 - n) w^n, up to a phase, with
    w = E exp(i phi) for A and w = h exp(-i phi) for the other two, phi = pi (K' - shift)/K'. Its
    terms n and 1 - n have the common factor 1 - w. It vanishes if the axis passes the pole, and is
    written with expm1; so the digits of a quotient are relative to its own size there.
    """

    def __init__(
        self,
        K: float,
        Kc: float,
        signs: Sequence[float],
        complements: Sequence[float],
        root_of_nome: float,
        winding: int = 0,
    ) -> None:
        self._K, self._Kc, self._root, self._winding = K, Kc, root_of_nome, winding
        pairs = list(zip(signs, complements, strict=True))
        self._angles = [sign * math.pi * (1 - rest / Kc) for sign, rest in pairs]  # pi shift/K'
        phis = [sign * math.pi * rest / Kc for sign, rest in pairs]
        self._versines = [2 * math.sin(phi / 2) ** 2 for phi in phis]
        self._sines = [math.sin(phi) for phi in phis]
        q = math.exp(-math.pi * K / Kc)
        self._cofactors = [_expand_cofactor(q, phi, is_A=k == 0) for k, phi in enumerate(phis)]
        # Theta_4 and theta_2 change places (DLMF 20.7.31 and 20.7.33), theta_3 stays theta_3.
        self._divisor = (
            [1.0, *(q ** (n * n) for n in ORDERS)],
            [q ** (n * n - n) for n in ORDERS],
        )

    def values(self, x: Number, below: Number, above: Number, rest: Number = 0.0) -> list[Pair]:
        """Return real and imaginary parts of the three quotients."""
        sign, decay = find_sign(below), self._decay(below, above, rest)
        h, E = exponential(-above), decay * decay
        divisor = _sum_exponentials(*self._divisor, h, E)
        rests = -exponential_minus_1(-find_size(below)), -exponential_minus_1(-above)
        quotients = []
        for k in range(3):
            size = 1 / divisor if k == 0 else decay / divisor
            phase = (self._angles[k] / (2 * math.pi) + (k == 2) * self._winding) * x
            if k == 0:
                phase = phase - sign * (0.5 * self._angles[0])
            cofactor = self._sum_cofactor(k, sign, h, E)
            numerator = multiply(cofactor, self._factor(k, sign, rests, h, E))
            turn = size * cosine(phase), -size * sine(phase)
            quotients.append(multiply(numerator, turn))
        return quotients

    def _sum_cofactor(self, k: int, sign: Number, h: Number, E: Number) -> Pair:
        """Return the numerator of quotient k without 1 - w."""
        (rising, falling), (rising_i, falling_i) = self._cofactors[k]
        imaginary = sign * _sum_exponentials(rising_i, falling_i, h, E)
        return _sum_exponentials(rising, falling, h, E), imaginary

    def _factor(self, k: int, sign: Number, rests: Pair, h: Number, E: Number) -> Pair:
        """Return 1 - w for quotient k, from 1 - E and 1 - h."""
        if k == 0:
            return self._versines[0] * E + rests[0], -self._sines[0] * (sign * E)
        return self._versines[k] * h + rests[1], self._sines[k] * (sign * h)

    def slope(self, k: int, x: float, below: float, above: float) -> complex:
        """Return the derivative of quotient k with respect to v."""
        sign, decay = math.copysign(1.0, below), float(self._decay(below, above))
        h, E = math.exp(-above), decay * decay
        value = to_complex(self.values(x, below, above)[k])
        rests = -math.expm1(-abs(below)), -math.expm1(-above)
        factor = to_complex(self._factor(k, sign, rests, h, E))
        cofactor = to_complex(self._sum_cofactor(k, sign, h, E))
        real, imaginary = (_sum_slopes(*part, h, E) for part in self._cofactors[k])
        # The derivative of 1 - w in |y| is w for A and -w for the others.
        own = 1 - factor if k == 0 else factor - 1
        rate = complex(real, sign * imaginary) * factor + cofactor * own
        turn = 1j / (2 * math.pi) * self._angles[k]
        phase = turn * x + 1j * (k == 2) * self._winding * x
        if k == 0:
            phase -= 0.5j * sign * self._angles[0]
        divisor = float(_sum_exponentials(*self._divisor, h, E))
        scale = (1.0 if k == 0 else decay) * cmath.exp(-phase) / divisor
        lost = _sum_slopes(*self._divisor, h, E) / divisor + (0.0 if k == 0 else 0.5)
        along = sign * (rate * scale - value * lost)
        return math.pi / self._Kc * along - math.pi / self._K * turn * value

    def _decay(self, below: Number, above: Number, rest: Number = 0.0) -> Number:
        """Return exp(-|y|/2), from the distance of the nearer turning point.

        The rounding of a large |y| would be an error of the small result.
        """
        size = find_size(below)
        scale = choose_smaller(above, size, self._root, 1.0)
        decay = scale * exponential(choose_smaller(above, size, above, -size) / 2)
        return decay + decay * (0.5 * rest)


def _sum_exponentials(
    rising: Sequence[float], falling: Sequence[float], h: Number, E: Number
) -> Number:
    """Return the sum of rising[n] h^n, n = 0 ..., and falling[n - 1] E^n, n = 1 ..."""
    c0, c1, c2, c3, c4 = rising
    d1, d2, d3, d4 = falling
    return c0 + (h * (c1 + h * (c2 + h * (c3 + h * c4))) + E * (d1 + E * (d2 + E * (d3 + E * d4))))


def _sum_slopes(rising: Sequence[float], falling: Sequence[float], h: float, E: float) -> float:
    """Return the derivative of `_sum_exponentials` in |y|, with which h grows and E falls."""
    return sum(n * c * h**n for n, c in enumerate(rising)) - sum(
        n * d * E**n for n, d in enumerate(falling, start=1)
    )


def _expand_cofactor(q: float, phi: float, is_A: bool) -> Cofactor:
    """Return the coefficients of a numerator divided by 1 - w: of 1 and h^n, and of E^n.

    The cofactor is the sum over k of (-1)^k q^(k^2 + k) (1 + w + 1/w + ... + w^k + 1/w^k). With
    h E = q, 1/w is h exp(-i phi)/q for A and E exp(i phi)/q for the others.
    """
    powers, inverses = [], []
    for n in range(5):
        powers.append(sum((-1) ** k * q ** (k * k + k) for k in range(n, 5)))
        inverses.append(sum((-1) ** k * q ** (k * k + k - n) for k in range(n, 5)))
    rising, falling = (inverses, powers) if is_A else (powers, inverses)
    turns = [cmath.exp(1j * phi * n) for n in range(5)]
    up = [
        size * turn.conjugate() for size, turn in zip([powers[0], *rising[1:]], turns, strict=True)
    ]
    down = [size * turn for size, turn in zip(falling[1:], turns[1:], strict=True)]
    return (
        ([c.real for c in up], [c.real for c in down]),
        ([c.imag for c in up], [c.imag for c in down]),
    )
