"""The theta quotients as functions of the nutation phase, summed in whichever nome is small.

Both classes write the numerators th_k(v + i shift) and the common denominator th4(v) in nine real
functions of the phase x = pi v/K, so that evaluating a motion is one small matrix product. With
q = exp(-pi K'/K) for m <= 1/2 and q' = exp(-pi K/K') for m > 1/2 no nome exceeds exp(-pi) = 0.043,
and the first term left out is below 1e-16 of the sum. (DLMF 20.2, 20.7.30-33.)
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ORDERS = np.arange(1.0, 5.0)
SQUARES, PRONICS = ORDERS**2, ORDERS**2 - ORDERS
DISTANT, NEAR = np.hstack([PRONICS, SQUARES + ORDERS]), np.hstack([ORDERS, -ORDERS])
PARITY = (-1.0) ** np.array([0, 1, 2, 3, 4, 1, 2, 3, 4])
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
    """Sums in the nome q. Basis: 1, cos(n x), sin(n x)."""

    def __init__(self, K: float, Kc: float, sign: Real, rest: Real) -> None:
        # q**(n*n) exp(n pi shift/K), the two large exponents combined, and the same with -shift
        weights = np.exp(-math.pi / K * (Kc * DISTANT + rest * NEAR))
        large, small = weights[:, :4], weights[:, 4:]
        self._matrix = np.zeros((7, 9))
        self._matrix[:3, 0] = self._matrix[6, 0] = 1.0
        self._matrix[:3, 1:5] = small + large
        self._matrix[3:6, 5:] = (small - large) * sign
        self._matrix[6, 1:5] = 2 * np.exp(-math.pi / K * Kc * SQUARES)
        self._matrix[[0, 3, 6]] *= PARITY  # th4 for A and below

    def values(self, x: Real) -> Complex:
        """Quotients (3, n) at phases x (n,)."""
        rows = _product(self._matrix, _harmonics(x))
        return np.asarray((rows[:3] + 1j * rows[3:6]) / rows[6])

    def at_start(self, x: float) -> tuple[Complex, Complex]:
        """Values and derivatives with respect to x, each (3,), at one phase."""
        nx = x * ORDERS
        cosines, sines = np.cos(nx), np.sin(nx)
        basis = np.array([[1.0, *cosines, *sines], [0.0, *-ORDERS * sines, *ORDERS * cosines]])
        rows, slopes = basis @ self._matrix.T
        values = (rows[:3] + 1j * rows[3:6]) / rows[6]
        return values, (slopes[:3] + 1j * slopes[3:6] - values * slopes[6]) / rows[6]


def _product(matrix: Real, basis: Real) -> Real:
    """Matrix product, summed in one order whatever n is: at(array) is then at(each) bit for bit."""
    rows: Real = matrix[:, :1] * basis[0]
    for column, row in zip(matrix.T[1:, :, np.newaxis], basis[1:], strict=True):
        rows += column * row
    return rows


def _harmonics(x: Real) -> Real:
    basis = np.empty((9, x.size))
    basis[0] = 1.0
    z = np.exp(1j * x)
    square = z * z
    for order, power in enumerate((z, square, square * z, square * square), start=1):
        basis[order], basis[order + 4] = power.real, power.imag
    return basis


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
