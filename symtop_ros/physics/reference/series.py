"""The motion under gravity, friction and a torque, by Taylor series in integers.

It shares no formula with the closed form: Euler's equations and q' = q omega/2 in the body frame
are expanded in time. No root, no elliptic function, no angle and no other frame is used.

What a motion starts from are exact fractions. A number is an integer in units of 2^-bits.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from operator import mul
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

if TYPE_CHECKING:
    from symtop_ros.physics.state import State
    from symtop_ros.physics.top import Top

Integers = list[Any]  # of Python, or of a faster type
SLOWER = 2  # power of two
TERMS_PER_DIGIT = 1.2  # of a series; found to take the least time
W, X, Y, Z, OMEGA_X, OMEGA_Y, OMEGA_Z = range(7)


class Inputs(NamedTuple):
    """A top and its start. A double is a fraction, so nothing is rounded here."""

    Ix: Fraction
    Iz: Fraction
    Mgl: Fraction
    orientation: tuple[Fraction, ...]  # of any norm but zero
    angular_velocity: tuple[Fraction, ...]

    @classmethod
    def of(cls, top: Top, start: State) -> Inputs:
        """Return the numbers that a top and a state were given."""
        q, omega = start.given_orientation, start.angular_velocity
        return cls.exact(*top.moments, q.tolist(), omega.tolist())

    @classmethod
    def exact(cls, Ix: Any, Iz: Any, Mgl: Any, orientation: Any, angular_velocity: Any) -> Inputs:
        """Return doubles, integers or fractions as fractions."""
        q, omega = (tuple(map(Fraction, each)) for each in (orientation, angular_velocity))
        return cls(Fraction(Ix), Fraction(Iz), Fraction(Mgl), q, omega)

    def clamp(self) -> Inputs:
        """Return a free motion with the states of this one while a hand holds phi.

        It is that of a body without momentum along its axis, in its vertical plane [derivation,
        11]. The axis must be tilted.
        """
        (w, x, y, z), (a, b, c) = self.orientation, self.angular_velocity
        node = -(w * x + y * z), x * z - w * y  # along the line of nodes, of any length
        part = (a * node[0] + b * node[1]) / (node[0] ** 2 + node[1] ** 2)
        rates = part * node[0], part * node[1], c
        return self._replace(Iz=Fraction(0), angular_velocity=rates)


class Way:
    """The steps of an integration forward or back in time."""

    def __init__(self, sign: int, state: Integers) -> None:
        self.sign, self.end = sign, state  # the state at the end of the last step
        self.begins: Integers = [0]  # of the steps, as times from the start
        self.steps: list[list[Integers]] = []  # series of each


class Series:
    """A motion that is integrated up to the times of `find`, and kept.

    `digits` must cover the answer, and what the motion magnifies. The friction is (axial,
    transverse), the torque is applied in the world frame.
    """

    integer: ClassVar[Any] = int  # a subclass may have a faster type

    def __init__(
        self,
        inputs: Inputs,
        digits: int = 50,
        friction: Sequence[float] = (0.0, 0.0),
        torque: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        self.digits = digits
        self.bits = int(digits / math.log10(2)) + 20
        self._terms = int(TERMS_PER_DIGIT * digits)
        Ix, Iz, Mgl, orientation, omega = inputs
        along, across = map(Fraction, friction)
        axial, transverse = along / Iz, across / Ix
        pull = (abs(Mgl) + max(map(abs, map(Fraction, torque)))) / Ix
        fastest = max(math.sqrt(pull), *map(float, map(abs, (*omega, axial, transverse))))
        # in units of time, in which a body turns by some rad: in a shorter one the last of the
        # coefficients would vanish, and steps be short
        self.second = Fraction(2) ** (math.ceil(math.log2(fastest or 1.0)) - SLOWER)
        self._cross = self._to_integer((Ix - Iz) / Ix)
        self._weight = self._to_integer(Mgl / Ix / self.second**2)
        decays = transverse, transverse, axial
        self._decays = [self._to_integer(each / self.second) for each in decays]
        self._pulls = [
            [self._to_integer(Fraction(part) / inertia / self.second**2) for part in torque]
            for inertia in (Ix, Ix, Iz)
        ]
        self._is_driven = any(friction) or any(torque)
        rates = [self._to_integer(rate / self.second) for rate in omega]
        start = self._normalize(orientation) + rates
        self._forward = Way(1, start)
        self._back = Way(-1, start)

    def find(self, t: Fraction) -> Integers:
        """Return the seven numbers at a time in s; rates are those in the unit of time."""
        time = self._to_integer(t * self.second)
        way = self.reach(-1 if time < 0 else 1, abs(time))
        step = min(max(bisect_right(way.begins, abs(time)) - 1, 0), len(way.steps) - 1)
        return self._sum(way.steps[step], time - way.sign * way.begins[step])

    def reach(self, sign: int, time: Any) -> Way:
        """Return the steps forward (1) or back in time (-1), up to a time in units of 2^-bits."""
        way = self._forward if sign > 0 else self._back
        while way.begins[-1] < time or not way.steps:
            self._advance(way)
        return way

    def _advance(self, way: Way) -> None:
        """Add a step, as long as the last term stays as small as the unit."""
        series = self._expand(way.end)
        last = max(abs(each[-1]) for each in series) or 1
        reach = -last.bit_length() / self._terms  # log2 of the length
        length = self.integer(2.0 ** (40 + min(reach, 4))) << max(self.bits - 40, 0)
        way.steps.append(series)
        way.begins.append(way.begins[-1] + length)
        way.end = self._sum(series, way.sign * length)

    def _to_integer(self, value: Fraction) -> Any:
        """Return a number in units of 2^-bits."""
        return (self.integer(value.numerator) << self.bits) // value.denominator

    def _normalize(self, q: Sequence[Fraction]) -> Integers:
        square = sum(c * c for c in q)
        norm = Fraction(math.isqrt(int(square * 2 ** (4 * self.bits))), 2 ** (2 * self.bits))
        return [self._to_integer(c / norm) for c in q]

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

        def times(i: int, j: int) -> Any:
            if j == OMEGA_Z and not self._is_driven:  # constant: all but one product are zero
                return series[i][n] * series[OMEGA_Z][0] >> self.bits
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
