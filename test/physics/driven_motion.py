"""The top under friction and an applied torque to many digits: a Taylor series in integers.

Straight from Euler's equations and q' = q omega/2 in the body frame: neither the frame nor the
variables of the package's engine. A number is an integer in units of 2^-bits, as in
`taylor_motion`; products of series are Cauchy products.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from operator import mul

from mpmath import mp
from mpmath.libmp import MPZ

DIGITS = 40
BITS = int(DIGITS / math.log10(2)) + 20
TERMS = 64  # enough for 40 digits if the fastest rate turns by 4 rad in the unit of time

Numbers = Sequence[float]
Integers = list[int]
EXACT = mp.clone()
EXACT.dps = DIGITS + 10


class DrivenTop:
    """A top, its friction and the torque applied to it; numbers are taken as exact."""

    def __init__(self, moments: Numbers, friction: Numbers, torque: Numbers) -> None:
        self.Ix, self.Iz, self.Mgl = map(Fraction, moments)
        self.axial, self.transverse = map(Fraction, friction)
        self.torque = [Fraction(part) for part in torque]

    def state_at(self, orientation: Numbers, angular_velocity: Numbers, t: float):
        """Orientation (w, x, y, z) and body angular velocity at t in s, to at least 30 digits."""
        (state,) = self.states_at(orientation, angular_velocity, [t])
        return state

    def states_at(self, orientation: Numbers, angular_velocity: Numbers, times: Numbers):
        """States at times in s of one sign, each further from 0 than the one before."""
        self._set_unit(angular_velocity)
        norm = EXACT.sqrt(sum(EXACT.mpf(c) ** 2 for c in orientation))
        state = [MPZ(int(EXACT.mpf(c) / norm * 2**BITS)) for c in orientation]
        state += [_integer(Fraction(rate) * self._unit) for rate in angular_velocity]
        states, now = [], MPZ(0)
        for t in times:
            end = _integer(Fraction(t) / self._unit)
            while now != end:
                series = self._expand(state)
                h = min(abs(end - now), _reach(series)) * (1 if end > now else -1)
                state, now = [_sum(each, h) for each in series], now + h
            unit = EXACT.mpf(self._unit.numerator) / self._unit.denominator
            numbers = [EXACT.mpf(value) / 2**BITS for value in state]
            states.append((tuple(numbers[:4]), tuple(rate / unit for rate in numbers[4:])))
        return states

    def _set_unit(self, angular_velocity: Numbers) -> None:
        """Choose the unit of time, a power of two in s, and scale the constants by it."""
        pull = abs(self.Mgl) + max(map(abs, self.torque))
        decays = self.transverse / self.Ix, self.axial / self.Iz
        fastest = max(math.sqrt(pull / self.Ix), *map(abs, angular_velocity), *map(float, decays))
        self._unit = unit = Fraction(2) ** (2 - math.ceil(math.log2(fastest or 1.0)))
        self._cross = _integer((self.Ix - self.Iz) / self.Ix)
        self._decays = [_integer(unit * decay) for decay in (decays[0], decays[0], decays[1])]
        self._weight = _integer(self.Mgl / self.Ix * unit**2)
        self._pulls = [
            [_integer(part / inertia * unit**2) for part in self.torque]
            for inertia in (self.Ix, self.Ix, self.Iz)
        ]

    def _expand(self, state: Integers) -> list[Integers]:
        """Taylor coefficients of the seven numbers."""
        series = [[value] for value in state]
        for n in range(TERMS):
            for each, slope in zip(series, self._slopes(series, n), strict=True):
                each.append(slope // (n + 1))
        return series

    def _slopes(self, series: list[Integers], n: int) -> Integers:
        """Coefficient n of the derivatives."""
        backward = [each[::-1] for each in series]

        def times(i: int, j: int) -> int:
            return sum(map(mul, series[i], backward[j])) >> BITS

        w, x, y, z, a, b, c = range(7)
        torques = self._torques(times, n)
        friction = [decay * series[i][n] for i, decay in zip((a, b, c), self._decays, strict=True)]
        cross = self._cross * times(b, c), -self._cross * times(c, a), 0
        return [
            -(times(x, a) + times(y, b) + times(z, c)) >> 1,
            (times(w, a) + times(y, c) - times(z, b)) >> 1,
            (times(w, b) + times(z, a) - times(x, c)) >> 1,
            (times(w, c) + times(x, b) - times(y, a)) >> 1,
            *((p + q - r) >> BITS for p, q, r in zip(torques, cross, friction, strict=True)),
        ]

    def _torques(self, times, n: int) -> Integers:
        """Gravity's and the applied torque: rows of the rotation matrix times what acts."""
        w, x, y, z = range(4)
        xz, wy, yz, wx = times(x, z), times(w, y), times(y, z), times(w, x)
        vertical = [2 * (xz - wy), 2 * (yz + wx), 0]
        torques = [self._weight * vertical[1], -self._weight * vertical[0], 0]
        if not any(self.torque):
            return torques
        one = 2**BITS if n == 0 else 0
        xx, yy, zz, xy, wz = times(x, x), times(y, y), times(z, z), times(x, y), times(w, z)
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


def _integer(value: Fraction) -> int:
    return (MPZ(value.numerator) << BITS) // value.denominator


def _reach(series: list[Integers]) -> int:
    """Return the time at which the last terms are as small as the unit, at most 1."""
    last = max(abs(each[-1]) for each in series) or 1
    return MPZ(2.0 ** (40 - last.bit_length() / TERMS)) << (BITS - 40)


def _sum(series: Integers, time: int) -> int:
    """Horner's sum of a series."""
    total = 0
    for coefficient in reversed(series):
        total = ((total * time) >> BITS) + coefficient
    return total
