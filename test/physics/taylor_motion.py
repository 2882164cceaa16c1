"""The motion of a top by Taylor series in integers: a reference without any formula of the package.

Euler's equations and q' = q omega/2 in the body frame are expanded in time, to as many digits as
needed; no root, no elliptic function and no angle is used. The solution is symmetric: after a
period of the height u = cos(theta) the state is the same, turned about the vertical and about the
axis of the top. So one period, and the two angles by which it turns, give the state at any time.

A number is an integer, in units of 2^-bits: of the type that mpmath uses, which is GMP's if gmpy2
is installed. It multiplies such integers of some hundred bits three times as fast as Python.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from operator import mul

from mpmath import mp, mpc, mpf
from mpmath.libmp import MPZ

TERMS_PER_DIGIT = 1.2  # of a series; found to take the least time
Numbers = Sequence[float]
Integers = list[int]


class TaylorMotion:
    """A top (Ix, Iz, Mgl) from an orientation (w, x, y, z) and a body angular velocity, all exact.

    The orientation is normalised with all digits. `digits` must cover the answer, the decimal
    logarithm of the time in periods, and what the motion magnifies: near the separatrix, the
    decimal logarithm of the gap.
    """

    def __init__(self, moments: Numbers, orientation: Numbers, omega: Numbers, digits: int) -> None:
        self.digits = digits
        self._bits = int(digits / math.log10(2)) + 20
        self._terms = int(TERMS_PER_DIGIT * digits)
        Ix, Iz, Mgl = map(Fraction, moments)
        fastest = max(abs(Mgl / Ix) ** 0.5, *map(abs, omega))
        self._second = Fraction(2) ** math.ceil(math.log2(fastest or 1.0))  # units of time in 1 s
        self._weight = self._integer(Mgl / Ix / self._second**2)
        self._spin = self._integer(Fraction(omega[2]) / self._second)
        self._cross = self._integer((Ix - Iz) / Ix * Fraction(omega[2]) / self._second)
        q = [Fraction(c) for c in orientation]
        square = sum(c * c for c in q)
        norm = Fraction(math.isqrt(int(square * 2 ** (4 * self._bits))), 2 ** (2 * self._bits))
        rates = [Fraction(rate) / self._second for rate in omega[:2]]
        self._axial = Fraction(omega[2])
        # Begin and series of each step, and the state at the end of the last one.
        self._begins: Integers = [MPZ(0)]
        self._steps: list[list[Integers]] = []
        self._end = [self._integer(value) for value in (*(c / norm for c in q), *rates)]

    def state_at(self, t: float | Fraction):
        """Orientation (w, x, y, z) and body angular velocity at t in s, as mpf."""
        time = Fraction(t) * self._second
        nutations = 0
        if not 0 <= self._integer(time) <= self._begins[-1] + 40 * 2**self._bits:
            period = Fraction(int(self.period), 2**self._bits)
            nutations = math.floor(time / period)
            time -= nutations * period
        with mp.workdps(self.digits):
            A, B, omega = self._turned(self._state(self._integer(time)), nutations)
            rates = omega * mpf(int(self._second.numerator)) / int(self._second.denominator)
            axial = mpf(self._axial.numerator) / self._axial.denominator
            return (A.real, B.real, B.imag, A.imag), (rates.real, rates.imag, axial)

    def reach(self, t: float | Fraction) -> None:
        """Expand up to a time in s >= 0 step by step: for motions without a period."""
        self._state(self._integer(Fraction(t) * self._second))

    @property
    def period_in_seconds(self) -> float:
        """Period of theta in s."""
        return float(Fraction(int(self.period), 2**self._bits) / self._second)

    @property
    def period(self) -> int:
        """Period of theta in the unit of time, and of 2^-bits."""
        if not hasattr(self, "_period"):
            first, _, third = self._turning_times()
            self._period = third - first
        return self._period

    @property
    def largest_rate(self) -> float:
        """Largest |omega_xy| at the beginnings of the steps of a period, in rad/s."""
        steps = self._steps[: bisect_right(self._begins, self.period)]
        ends = [[series[0] for series in step] for step in steps]
        return float(max(math.hypot(end[4], end[5]) for end in ends) / 2**self._bits * self._second)

    def _turned(self, state: Integers, nutations: int):
        """A, B and omega_xy of a state after so many nutations."""
        w, x, y, z, u, v = (mpf(value) / 2**self._bits for value in state)
        A, B, omega = mpc(w, z), mpc(x, y), mpc(u, v)
        if not nutations:
            return A, B, omega
        a, b = self._turns
        turn_a, turn_b = mp.expj(nutations * a), mp.expj(nutations * b)
        return A * turn_a, B * turn_b, omega * turn_b / turn_a

    @property
    def _turns(self):
        """Angles by which A and B turn in a period."""
        for part in range(7):  # at a time at which neither of them vanishes
            begin = self.period * part // 13
            w, x, y, z, *_ = self._state(begin)
            if min(w * w + z * z, x * x + y * y) >> (2 * self._bits - 20):
                break
        v, r, s, u, *_ = self._state(begin + self.period)
        return mp.arg(mpc(v, u) / mpc(w, z)), mp.arg(mpc(r, s) / mpc(x, y))

    def _integer(self, value: Fraction) -> int:
        return (MPZ(value.numerator) << self._bits) // value.denominator

    def _state(self, time: int) -> Integers:
        while self._begins[-1] < time or not self._steps:
            self._step()
        step = max(bisect_right(self._begins, time) - 1, 0)
        step = min(step, len(self._steps) - 1)
        return self._sum(self._steps[step], time - self._begins[step])

    def _step(self) -> None:
        series = self._expand(self._end)
        last = max(abs(each[-1]) for each in series[:6]) or 1
        # log2 of the time at which the last term is as small as the unit
        reach = -last.bit_length() / (len(series[0]) - 1)
        length = MPZ(2.0 ** min(reach + 40, 41)) << max(self._bits - 40, 0)
        self._steps.append(series)
        self._begins.append(self._begins[-1] + length)
        self._end = self._sum(series, length)

    def _expand(self, state: Integers) -> list[Integers]:
        """Taylor coefficients of w, x, y, z, omega_x and omega_y."""
        bits, series = self._bits, [[value] for value in state]
        for n in range(self._terms):
            w, x, y, z, a, b = series
            backward = a[::-1], b[::-1], z[::-1], w[::-1]
            ra, rb, rz, rw = backward

            def times(left: Integers, right: Integers) -> int:
                return sum(map(mul, left, right))

            spin = self._spin
            slopes = (
                -(times(x, ra) + times(y, rb) + z[n] * spin) >> 1,
                (times(w, ra) + y[n] * spin - times(z, rb)) >> 1,
                (times(w, rb) + times(z, ra) - x[n] * spin) >> 1,
                (w[n] * spin + times(x, rb) - times(y, ra)) >> 1,
                self._cross * b[n] + 2 * ((times(y, rz) + times(x, rw)) >> bits) * self._weight,
                -self._cross * a[n] - 2 * ((times(x, rz) - times(y, rw)) >> bits) * self._weight,
            )
            for each, slope in zip(series, slopes, strict=True):
                each.append((slope >> bits) // (n + 1))
        return series

    def _sum(self, series: list[Integers], time: int) -> Integers:
        sums = []
        for each in series:
            total = 0
            for coefficient in reversed(each):
                total = ((total * time) >> self._bits) + coefficient
            sums.append(total)
        return sums

    def _turning_times(self) -> Integers:
        """Three times one after the other at which theta' is 0."""
        times: Integers = []
        before, time, step = 0, MPZ(0), 0
        while len(times) < 3:
            if step == len(self._steps):
                self._step()
            # the height moves little in a step, but u' may change its sign in its first half
            for end in (self._begins[step] + self._begins[step + 1]) // 2, self._begins[step + 1]:
                after = self._slope(end)
                if before and after and (before > 0) != (after > 0):
                    times.append(self._refine(time, end, before, after))
                before, time = after or before, end
            step += 1
        return times

    def _refine(self, low: int, high: int, at_low: int, at_high: int) -> int:
        """Zero of u' between two times, by bisection and the secant in turn."""
        bisect = False
        while high - low > 1:
            bisect = not bisect
            middle = low + at_low * (high - low) // (at_low - at_high)
            middle = (low + high) // 2 if bisect else min(max(middle, low + 1), high - 1)
            value = self._slope(middle)
            if value == 0:
                return middle
            if (value > 0) == (at_low > 0):
                low, at_low = middle, value
            else:
                high, at_high = middle, value
        return low

    def _slope(self, time: int) -> int:
        """du/dt in units of 2^(-2 bits), twice too small."""
        w, x, y, z, a, b = self._state(time)
        gx, gy = (x * z - w * y) >> self._bits, (y * z + w * x) >> self._bits
        return b * gx - a * gy
