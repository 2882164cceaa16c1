"""Motions of a top to many digits, by Taylor series in integers: what errors are measured from.

It shares no formula with the package: Euler's equations and q' = q omega/2 in the body frame are
expanded in time. No root, no elliptic function, no angle and no other frame is used. Doubles would
not do, because the error of a step in doubles is as large as the errors that are measured.

A number is an integer in units of 2^-bits, of GMP's type if gmpy2 is installed: it multiplies such
integers of some hundred bits three times as fast as Python.
"""

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from fractions import Fraction
from operator import mul
from typing import Any

import numpy as np

from symtop_ros.arrays import Real

try:
    from gmpy2 import mpz
except ModuleNotFoundError:
    mpz = int

Numbers = Sequence[float]
Integers = list[Any]  # of the type of GMP, or of Python
TERMS_PER_DIGIT = 1.2  # of a series; found to take the least time
W, X, Y, Z, OMEGA_X, OMEGA_Y, OMEGA_Z = range(7)
NO_FRICTION, NO_TORQUE = (0.0, 0.0), (0.0, 0.0, 0.0)


class Way:
    """The steps of an integration forward or back in time."""

    def __init__(self, sign: int, state: Integers) -> None:
        self.sign, self.end = sign, state  # the state at the end of the last step
        self.begins: Integers = [mpz(0)]  # of the steps, as times from the start
        self.steps: list[list[Integers]] = []  # series of each


class TaylorMotion:
    """A top (Ix, Iz, Mgl) from an orientation (w, x, y, z) and a body angular velocity, all exact.

    Friction has an axial and a transverse coefficient, the torque is applied in the world frame.
    The orientation is normalised with all digits. `digits` must cover the answer, and what the
    motion magnifies. What has been integrated is kept.
    """

    def __init__(
        self,
        moments: Numbers,
        orientation: Numbers,
        omega: Numbers,
        digits: int = 40,
        friction: Numbers = NO_FRICTION,
        torque: Numbers = NO_TORQUE,
    ) -> None:
        self.digits = digits
        self.bits = int(digits / math.log10(2)) + 20
        self._terms = int(TERMS_PER_DIGIT * digits)
        Ix, Iz, Mgl = map(Fraction, moments)
        decays = Fraction(friction[1]) / Ix, Fraction(friction[0]) / Iz
        pull = (abs(Mgl) + max(map(abs, map(Fraction, torque)))) / Ix
        fastest = max(math.sqrt(pull), *map(abs, omega), *map(float, decays))
        self.second = Fraction(2) ** math.ceil(math.log2(fastest or 1.0))  # units of time in 1 s
        self._cross = self.to_integer((Ix - Iz) / Ix)
        self._weight = self.to_integer(Mgl / Ix / self.second**2)
        self._decays = [self.to_integer(each / self.second) for each in (decays[0], *decays)]
        self._pulls = [
            [self.to_integer(Fraction(part) / inertia / self.second**2) for part in torque]
            for inertia in (Ix, Ix, Iz)
        ]
        self.is_driven = any(friction) or any(torque)
        start = self._normalize(orientation)
        start += [self.to_integer(Fraction(rate) / self.second) for rate in omega]
        self.forward, self._back = Way(1, start), Way(-1, start)

    def fractions_at(self, t: float | Fraction) -> list[Fraction]:
        """Return w, x, y, z and the body angular velocity (rad/s) at t in s."""
        *q, a, b, c = (
            Fraction(int(value), 2**self.bits) for value in self.state(self.to_time(Fraction(t)))
        )
        return [*q, *(rate * self.second for rate in (a, b, c))]

    def doubles_at(self, times: Iterable[float]) -> tuple[Real, Real]:
        """Return orientations (n, 4) at times in s as sums of two doubles, high and low."""
        exact = [self.fractions_at(t)[:4] for t in times]
        high = [[float(each) for each in q] for q in exact]
        low = [
            [float(each - Fraction(double)) for each, double in zip(q, doubles, strict=True)]
            for q, doubles in zip(exact, high, strict=True)
        ]
        return np.array(high), np.array(low)

    def state(self, time: int) -> Integers:
        """Return the seven numbers at a time, as integers; rates are those in the unit of time."""
        way, distance = (self._back if time < 0 else self.forward), abs(time)
        while way.begins[-1] < distance or not way.steps:
            self.advance(way)
        step = min(max(bisect_right(way.begins, distance) - 1, 0), len(way.steps) - 1)
        return self._sum(way.steps[step], way.sign * (distance - way.begins[step]))

    def advance(self, way: Way) -> None:
        """Add a step, as long as the last term stays as small as the unit."""
        series = self._expand(way.end)
        last = max(abs(each[-1]) for each in series) or 1
        reach = -last.bit_length() / self._terms  # log2 of the length
        length = mpz(2.0 ** min(reach + 40, 41)) << max(self.bits - 40, 0)
        way.steps.append(series)
        way.begins.append(way.begins[-1] + length)
        way.end = self._sum(series, way.sign * length)

    def to_time(self, t: Fraction) -> Any:
        """Return a time in s in the unit of time."""
        return self.to_integer(t * self.second)

    def to_integer(self, value: Fraction) -> Any:
        """Return a number in units of 2^-bits."""
        return (mpz(value.numerator) << self.bits) // value.denominator

    def _normalize(self, orientation: Numbers) -> Integers:
        q = [Fraction(c) for c in orientation]
        square = sum(c * c for c in q)
        norm = Fraction(math.isqrt(int(square * 2 ** (4 * self.bits))), 2 ** (2 * self.bits))
        return [self.to_integer(c / norm) for c in q]

    def _expand(self, state: Integers) -> list[Integers]:
        """Return the coefficients of the seven numbers in powers of the time.

        Coefficient n + 1 of a number is coefficient n of its derivative divided by n + 1, and
        coefficient n of a product of two series is a sum over coefficients 0 to n.
        """
        series = [[value] for value in state]
        for n in range(self._terms):
            for each, slope in zip(series, self._slopes(series, n), strict=True):
                each.append(slope // (n + 1))
        return series

    def _slopes(self, series: list[Integers], n: int) -> Integers:
        """Return coefficient n of the derivatives."""
        backward = [each[::-1] for each in series]
        spin = series[OMEGA_Z]

        def times(i: int, j: int) -> Any:
            if j == OMEGA_Z and not self.is_driven:  # constant: all but one product are zero
                return series[i][n] * spin[0] >> self.bits
            return sum(map(mul, series[i], backward[j])) >> self.bits

        a, b, c = OMEGA_X, OMEGA_Y, OMEGA_Z
        cross = self._cross * times(b, c), -self._cross * times(a, c), 0
        torques = self._torques(times, n)
        drags = [decay * series[i][n] for i, decay in zip((a, b, c), self._decays, strict=True)]
        return [
            -(times(X, a) + times(Y, b) + times(Z, c)) >> 1,
            (times(W, a) + times(Y, c) - times(Z, b)) >> 1,
            (times(W, b) + times(Z, a) - times(X, c)) >> 1,
            (times(W, c) + times(X, b) - times(Y, a)) >> 1,
            *((p + q - r) >> self.bits for p, q, r in zip(torques, cross, drags, strict=True)),
        ]

    def _torques(self, times: Any, n: int) -> Integers:
        """Return gravity's and the applied torque, by rows of the rotation matrix."""
        xz, wy, yz, wx = times(X, Z), times(W, Y), times(Y, Z), times(W, X)
        vertical = [2 * (xz - wy), 2 * (yz + wx), 0]
        torques = [self._weight * vertical[1], -self._weight * vertical[0], 0]
        if not any(map(any, self._pulls)):
            return torques
        one = 2**self.bits if n == 0 else 0
        xx, yy, zz, xy, wz = times(X, X), times(Y, Y), times(Z, Z), times(X, Y), times(W, Z)
        vertical[2] = one - 2 * (xx + yy)
        axes = (
            [one - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)],
            [2 * (xy + wz), one - 2 * (xx + zz), 2 * (yz - wx)],
            vertical,
        )
        return [
            torque
            + sum(pull * axis[row] for pull, axis in zip(self._pulls[row], axes, strict=True))
            for row, torque in enumerate(torques)
        ]

    def _sum(self, series: list[Integers], time: Any) -> Integers:
        """Return the sums of power series, by Horner's rule."""
        sums = []
        for each in series:
            total = 0
            for coefficient in reversed(each):
                total = ((total * time) >> self.bits) + coefficient
            sums.append(total)
        return sums
