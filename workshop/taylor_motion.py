"""The motion of a top to many digits at any time: the Taylor series, and its symmetry.

After a period of the height u = cos(theta) the state is the same, turned about the vertical and
about the axis of the top. So one period, and the two angles by which it turns, give the state at
any time. A driven motion has no period, and is integrated all the way.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from fractions import Fraction
from typing import Any

from mpmath import mp, mpc, mpf

from workshop.taylor import TaylorMotion as IntegratedMotion

Integers = list[int]


class TaylorMotion(IntegratedMotion):
    """A motion whose `digits` also cover the decimal logarithm of the time in periods.

    Near the separatrix the motion magnifies by the gap, and its decimal logarithm counts as well.
    """

    def state_at(self, t: float | Fraction) -> tuple[tuple[mpf, ...], tuple[mpf, ...]]:
        """Orientation (w, x, y, z) and body angular velocity at t in s, as mpf."""
        time, nutations = Fraction(t) * self.second, 0
        known = self.forward.begins[-1] + 40 * 2**self.bits
        if not (self.is_driven or 0 <= self.to_integer(time) <= known):
            period = Fraction(int(self.period), 2**self.bits)
            nutations = math.floor(time / period)
            time -= nutations * period
        with mp.workdps(self.digits + 10):
            state = self.state(self.to_integer(time))
            A, B, omega = self._turned(state, nutations)
            unit = mpf(int(self.second.numerator)) / int(self.second.denominator)
            rates, axial = omega * unit, mpf(state[6]) / 2**self.bits * unit
            return (A.real, B.real, B.imag, A.imag), (rates.real, rates.imag, axial)

    def reach(self, t: float | Fraction) -> None:
        """Expand up to a time in s >= 0 step by step: for motions without a period."""
        self.state(self.to_time(Fraction(t)))

    @property
    def period_in_seconds(self) -> float:
        """Period of theta in s."""
        return float(Fraction(int(self.period), 2**self.bits) / self.second)

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
        steps = self.forward.steps[: bisect_right(self.forward.begins, self.period)]
        ends = [[series[0] for series in step] for step in steps]
        return float(max(math.hypot(end[4], end[5]) for end in ends) / 2**self.bits * self.second)

    def _turned(self, state: Integers, nutations: int) -> tuple[mpc, mpc, mpc]:
        """A, B and omega_xy of a state after so many nutations."""
        w, x, y, z, u, v, _ = (mpf(value) / 2**self.bits for value in state)
        A, B, omega = mpc(w, z), mpc(x, y), mpc(u, v)
        if not nutations:
            return A, B, omega
        a, b = self._turns
        turn_a, turn_b = mp.expj(nutations * a), mp.expj(nutations * b)
        return A * turn_a, B * turn_b, omega * turn_b / turn_a

    @property
    def _turns(self) -> tuple[mpf, mpf]:
        """Angles by which A and B turn in a period."""
        for part in range(7):  # at a time at which neither of them vanishes
            begin = self.period * part // 13
            w, x, y, z, *_ = self.state(begin)
            if min(w * w + z * z, x * x + y * y) >> (2 * self.bits - 20):
                break
        v, r, s, u, *_ = self.state(begin + self.period)
        return mp.arg(mpc(v, u) / mpc(w, z)), mp.arg(mpc(r, s) / mpc(x, y))

    def _turning_times(self) -> Integers:
        """Three times one after the other at which theta' is 0."""
        times: Integers = []
        before, time, step = 0, self.to_integer(Fraction(0)), 0
        while len(times) < 3:
            if step == len(self.forward.steps):
                self.advance(self.forward)
            # the height moves little in a step, but u' may change its sign in its first half
            begin, last = self.forward.begins[step : step + 2]
            for end in (begin + last) // 2, last:
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

    def _slope(self, time: int) -> Any:
        """du/dt in units of 2^(-2 bits), twice too small."""
        w, x, y, z, a, b, _ = self.state(time)
        gx, gy = (x * z - w * y) >> self.bits, (y * z + w * x) >> self.bits
        return b * gx - a * gy
