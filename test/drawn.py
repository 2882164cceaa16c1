"""Inputs of tests, with the same bits on every machine.

The last bits of the C library's pow, sin and log, of NumPy's functions and of BLAS depend on the
processor. Here sums, products, quotients and square roots are those of IEEE 754, and functions are
computed with 30 digits and rounded once.
"""

import random
from collections.abc import Callable
from typing import Any

import numpy as np
from mpmath import mp

DIGITS = 30


def _rounded(name: str) -> Callable[..., float]:
    function = getattr(mp, name)

    def compute(*arguments: float) -> float:
        with mp.workdps(DIGITS):
            return float(function(*map(mp.mpf, arguments)))

    return compute


sin, cos, sqrt, log, _power = map(_rounded, ("sin", "cos", "sqrt", "log", "power"))
PI = float(mp.pi)


class Numbers(random.Random):
    """Random numbers; those of the base class but for what uses the C library."""

    def power(self, low: float, high: float) -> float:
        """Return a power of ten with an exponent between two numbers."""
        return _power(10, self.uniform(low, high))

    def gauss(self, mu: float = 0.0, sigma: float = 1.0) -> float:
        """Return a normal number, as the base class does: by Box and Muller, two at a time."""
        z, self.gauss_next = self.gauss_next, None
        if z is None:
            angle = 2 * PI * self.random()
            size = sqrt(-2 * log(1.0 - self.random()))
            z, self.gauss_next = cos(angle) * size, sin(angle) * size
        return mu + z * sigma

    def normals(self, *shape: int) -> Any:
        """Return an array of normal numbers."""
        count = int(np.prod(shape))
        return np.array([self.gauss() for _ in range(count)]).reshape(shape)

    def uniforms(self, low: float, high: float, *shape: int) -> Any:
        """Return an array of numbers between two."""
        count = int(np.prod(shape))
        return np.array([self.uniform(low, high) for _ in range(count)]).reshape(shape)

    def quaternions(self, count: int) -> Any:
        """Return quaternions (count, 4) of norm 1, all over the sphere."""
        return normalize(self.normals(count, 4))


def normalize(vectors: Any) -> Any:
    """Return vectors (..., n) of norm 1: no sum is computed by BLAS or in another order."""
    vectors = np.asarray(vectors, dtype=float)
    squares = sum(vectors[..., k] * vectors[..., k] for k in range(vectors.shape[-1]))
    return vectors / np.sqrt(squares)[..., None]
