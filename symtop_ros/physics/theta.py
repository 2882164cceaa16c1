"""The theta quotients as functions of the nutation phase, summed in whichever nome is small.

Both classes write the numerators th_k(v + i shift) and the common denominator th4(v) in nine real
functions of the phase x = pi v/K, so that evaluating a motion is one small matrix product. With
q = exp(-pi K'/K) for m <= 1/2 and q' = exp(-pi K/K') for m > 1/2 no nome exceeds exp(-pi) = 0.043,
and the first term left out is below 1e-16 of the sum. (DLMF 20.2, 20.7.30-33.)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ORDERS = np.arange(1.0, 5.0)
SQUARES, PRONICS = ORDERS**2, ORDERS**2 - ORDERS
DISTANT, NEAR = np.hstack([PRONICS, SQUARES + ORDERS]), np.hstack([ORDERS, -ORDERS])
PARITY = (-1.0) ** np.arange(5)
SMALL = 2.0**-60  # of the largest coefficient: such a term is no part of any sum
EXPONENTS = np.concatenate([[0.0], ORDERS, -ORDERS])
BENEATH = np.array([[True], [False], [False]])  # A has th4 above; B and omega have th3


class Series(Protocol):
    """The quotients, 2 pi-periodic functions of the phase x; x = 0 is the lower turning point."""

    def values(self, x: Real) -> Complex:
        """Quotients (3, n) at phases x (n,) in [-pi, pi]."""

    def at_start(self, x: float) -> tuple[Complex, Complex]:
        """Values and derivatives with respect to x, each (3,), at one phase."""


def series(K: float, Kc: float, sign: list[float], rest: list[float]) -> Series:
    """Return the series in the smaller nome, given the sign of each shift and K' - |shift|."""
    kind = DirectSeries if Kc >= K else ComplementarySeries
    return kind(K, Kc, np.array([sign]).T, np.array([[min(r, Kc) for r in rest]]).T)


class DirectSeries:
    """Sums in the nome q. Basis: 1 and cos(n x) for the even part, sin(n x) for the odd one."""

    def __init__(self, K: float, Kc: float, sign: Real, rest: Real) -> None:
        # q**(n*n) exp(n pi shift/K), the two large exponents combined, and the same with -shift
        weights = np.exp(-math.pi / K * (Kc * DISTANT + rest * NEAR))
        large, small = weights[:, :4], weights[:, 4:]
        even, odd = np.ones((4, 5)), (small - large) * sign
        even[:3, 1:] = small + large
        even[3, 1:] = 2 * np.exp(-math.pi / K * Kc * SQUARES)
        even[::3] *= PARITY  # th4 for A and below
        odd[0] *= PARITY[1:]
        largest = np.abs(even).max(axis=1, keepdims=True)
        needed = np.flatnonzero((np.abs(even) > SMALL * largest).any(axis=0))
        self._orders = max(1, int(needed[-1]))
        self._even, self._odd = even[:, : self._orders + 1], odd[:, : self._orders]

    def values(self, x: Real) -> Complex:
        """Quotients (3, n) at phases x (n,)."""
        powers = _powers(x, self._orders)
        even = _product(self._even, [np.ones_like(x), *(power.real for power in powers)])
        odd = _product(self._odd, [power.imag for power in powers])
        quotients = np.empty((3, x.size), dtype=complex)
        np.divide(even[:3], even[3], out=quotients.real)
        np.divide(odd, even[3], out=quotients.imag)
        return quotients

    def at_start(self, x: float) -> tuple[Complex, Complex]:
        """Values and derivatives with respect to x, each (3,), at one phase."""
        n = np.arange(self._orders + 1.0)
        cosines, sines = np.cos(n * x), np.sin(n * x)
        even, even_slope = self._even @ cosines, self._even @ (-n * sines)
        odd, odd_slope = self._odd @ sines[1:], self._odd @ (n * cosines)[1:]
        values = (even[:3] + 1j * odd) / even[3]
        return values, (even_slope[:3] + 1j * odd_slope - values * even_slope[3]) / even[3]


def _product(matrix: Real, basis: Real | Sequence[Real]) -> Real:
    """Matrix product, summed in one order whatever n is: at(array) is then at(each) bit for bit."""
    rows: Real = matrix[:, :1] * basis[0]
    for column, row in zip(matrix.T[1:, :, np.newaxis], basis[1:], strict=True):
        rows += column * row
    return rows


def _powers(x: Real, orders: int) -> list[Complex]:
    """exp(i n x) for n from 1 on, each (n,)."""
    powers = [np.exp(1j * x)]
    for n in range(2, orders + 1):
        powers.append(powers[n // 2 - 1] * powers[n - n // 2 - 1])
    return powers


class ComplementarySeries:
    """Sums in the nome q', after Jacobi's imaginary transformation.

    Basis: 1, h**n, E**n with E = exp(-|y|), h = exp(|y| - pi K/K') and y = x K/K': none overflows,
    and at the separatrix (K infinite, h = q' = 0) the series end by themselves.
    """

    def __init__(self, K: float, Kc: float, sign: Real, rest: Real) -> None:
        self._stretch = K / Kc
        self._turn = sign * math.pi * (1 - rest / Kc)  # pi shift/K'
        q = math.exp(-math.pi * self._stretch)
        rising, falling = q**PRONICS, q**SQUARES
        whole = ORDERS * self._turn
        half = np.hstack([0.5 * self._turn, whole + 0.5 * self._turn])
        third = _rows(np.zeros_like(self._turn), whole, rising, whole, falling)
        fourth = _rows(half[:, :1], half[:, 1:], falling, half[:, :-1], rising)
        self._matrix = np.empty((7, 9))
        self._matrix[:3] = np.where(BENEATH, fourth.real, third.real)
        self._matrix[3:6] = np.where(BENEATH, fourth.imag, third.imag)
        self._matrix[6] = np.concatenate([[1.0], falling, rising])

    def values(self, x: Real) -> Complex:
        """Quotients (3, n) at phases x (n,) in [-pi, pi]."""
        y = x * self._stretch
        decay = np.abs(y)
        rows = _product(self._matrix, self._exponentials(decay))
        above = rows[:3] + 1j * np.copysign(1.0, y) * rows[3:6]
        above[1:] *= np.exp(-decay / 2)
        return np.asarray(above / rows[6] * np.exp(-1j / (2 * math.pi) * self._turn * x))

    def at_start(self, x: float) -> tuple[Complex, Complex]:
        """Values and derivatives with respect to x, each (3,), at one phase."""
        y, turn = x * self._stretch, 1j / (2 * math.pi) * self._turn[:, 0]
        sign, decay = math.copysign(1.0, y), np.where(BENEATH[:, 0], 0.0, 0.5)
        basis = self._exponentials(np.array([abs(y)]))[:, 0]
        rows, slopes = self._matrix @ basis, self._matrix @ (EXPONENTS * basis)
        factor = np.exp(-abs(y) * decay - turn * x) / rows[6]
        values = (rows[:3] + 1j * sign * rows[3:6]) * factor
        rising = (sign * slopes[:3] + 1j * slopes[3:6]) * factor
        falling = values * sign * (decay + slopes[6] / rows[6])
        return values, self._stretch * (rising - falling) - turn * values

    def _exponentials(self, decay: Real) -> Real:
        basis = np.empty((9, decay.size))
        basis[0] = 1.0
        for first, value in (1, np.exp(decay - math.pi * self._stretch)), (5, np.exp(-decay)):
            square = value * value
            basis[first : first + 4] = value, square, square * value, square * square
        return basis


def _rows(first: Real, up: Real, up_weight: Real, down: Real, down_weight: Real) -> Complex:
    """Even (real) and odd (imaginary) coefficients of exp(n y + i up) and exp(-n y - i down)."""
    return np.hstack(
        [np.exp(1j * first), up_weight * np.exp(1j * up), down_weight * np.exp(-1j * down)]
    )
