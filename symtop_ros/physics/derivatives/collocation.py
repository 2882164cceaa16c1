"""Linear equations y' = A(t) y + F(t) p, solved by collocation at Gauss's points.

The coefficients are known at any time, because the motion is: a step depends on no other one, and
many are solved at once. With s points a step has the order 2 s (Hairer, Lubich and Wanner,
Geometric Numerical Integration, section II.1.3).
"""

import math
from collections.abc import Callable

import numpy as np

from symtop_ros.arrays import Real

POINTS = 10
# Steps that are solved at once, each with a system of some tens of equations.
BLOCK = 256
# Returns A (n, d, d) and F (n, d, k) at times (n,) in s.
Coefficients = Callable[[Real], tuple[Real, Real]]


def _list_weights() -> tuple[Real, Real, Real]:
    """Return the points c in [0, 1], a_ij = int_0^c_i l_j and b_j = int_0^1 l_j.

    The polynomials l_j of Lagrange are written in those of Legendre, of which the integrals are
    known: no power of c has to be formed, and no digit is lost.
    """
    x, w = np.polynomial.legendre.leggauss(POINTS)
    P = np.polynomial.legendre.legvander(x, POINTS)
    integrals = np.empty((POINTS, POINTS))  # of P_k from -1 to x_i
    integrals[:, 0] = 1 + x
    for k in range(1, POINTS):
        integrals[:, k] = (P[:, k + 1] - P[:, k - 1]) / (2 * k + 1)
    in_legendre = (np.arange(POINTS) + 0.5)[:, None] * P[:, :POINTS].T * w
    return (1 + x) / 2, integrals @ in_legendre / 2, w / 2


C, A, B = _list_weights()


class LinearFlow:
    """Solutions Y(t) = dy(t)/d(y(0), p), (d, d + k), from t = 0 in both directions."""

    def __init__(self, coefficients: Coefficients, size: int, count: int, step: float) -> None:
        """Take `size` d, `count` k, and the length of a step in s."""
        self._coefficients, self._size, self._step = coefficients, size, step
        self._start = np.eye(size, size + count)
        self._knots: dict[int, list[Real]] = {1: [self._start], -1: [self._start]}

    def at(self, times: Real) -> Real:
        """Return Y at times (n,) in s, (n, d, d + k)."""
        counts = np.trunc(times / self._step)
        begins = np.array([self._reach(int(count)) for count in counts])
        begins = begins.reshape(len(times), *self._start.shape)
        first, rest = counts * self._step, times - counts * self._step
        found = np.empty_like(begins)
        for some in (slice(k, k + BLOCK) for k in range(0, len(times), BLOCK)):
            steps = self._solve(first[some], rest[some])
            found[some] = self._join(steps, begins[some])
        return found

    def _reach(self, count: int) -> Real:
        """Return Y after a number of steps, in the direction of its sign."""
        direction = int(math.copysign(1, count))
        knots = self._knots[direction]
        while len(knots) <= abs(count):
            number = min(BLOCK, abs(count) + 1 - len(knots))
            first = self._step * (
                direction * np.arange(len(knots) - 1.0, len(knots) - 1.0 + number)
            )
            for step in self._solve(first, np.full(number, direction * self._step)):
                knots.append(self._join(step, knots[-1]))
        return knots[abs(count)]

    def _join(self, steps: Real, begins: Real) -> Real:
        """Return Y at the ends of steps from Y at their beginnings."""
        d = self._size
        ends = steps[..., :d] @ begins
        ends[..., d:] += steps[..., d:]
        return np.asarray(ends)

    def _solve(self, first: Real, lengths: Real) -> Real:
        """Return dy(end)/d(y(begin), p) of steps from times (n,) over lengths (n,), both in s."""
        d, n = self._size, len(first)
        inside = first[:, None] + lengths[:, None] * C
        slopes, forces = (
            each.reshape(n, POINTS, d, -1) for each in self._coefficients(inside.ravel())
        )
        slopes, forces = (lengths[:, None, None, None] * each for each in (slopes, forces))
        # y_i = y + sum_j a_ij (A_j y_j + F_j p), for the columns of y and of p together
        system = np.eye(POINTS * d) - np.einsum("ij,njkl->nikjl", A, slopes).reshape(
            n, POINTS * d, POINTS * d
        )
        right = np.empty((n, POINTS, d, d + forces.shape[-1]))
        right[..., :d] = np.eye(d)
        right[..., d:] = np.einsum("ij,njkl->nikl", A, forces)
        inner = np.linalg.solve(system, right.reshape(n, POINTS * d, -1)).reshape(right.shape)
        rates = slopes @ inner
        rates[..., d:] += forces
        return np.asarray(self._start + np.einsum("j,njkl->nkl", B, rates))
