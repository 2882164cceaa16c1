"""Exact motions as the test set and the tests compare with them, and what roundings do to them."""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any

from mpmath import mp, mpc

from symtop_ros.physics.reference.series import Inputs
from workshop.digits import ClosedForm, ExactState, Series

DIGITS = 80


class ReturningSeries(Series):
    """A motion under gravity alone, of which one period serves for all times.

    The period in s is that of the height of the axis. `digits` also cover the decimal logarithm of
    the number of periods.
    """

    def __init__(self, inputs: Inputs, digits: int, period: Any) -> None:
        super().__init__(inputs, digits)
        with mp.workprec(self.bits):
            self._period = Fraction(int(period * 2**self.bits), 2**self.bits)

    def at(self, t: float | Fraction) -> ExactState:
        """Return the state at t in s."""
        periods = math.floor(Fraction(t) / self._period)
        found = super().at(Fraction(t) - periods * self._period)
        if not periods:
            return found
        (w, x, y, z), (wx, wy, wz) = found
        with mp.workprec(self.bits + 10):
            a, b = (mp.expj(periods * angle) for angle in self._turns)
            A = mpc(w, z) * a
            B = mpc(x, y) * b
            omega = mpc(wx, wy) * b / a
            return ExactState((A.real, B.real, B.imag, A.imag), (omega.real, omega.imag, wz))

    @cached_property
    def _turns(self) -> tuple[Any, Any]:
        """Angles by which A and B turn in a period, if the height returns."""
        for part in range(7):  # at a time at which neither of them vanishes
            begin = self._period * part / 13
            w, x, y, z, *_ = before = self.find(begin)
            if min(w * w + z * z, x * x + y * y) >> (2 * self.bits - 20):
                break
        v, r, s, u, *_ = after = self.find(begin + self._period)
        for old, new in zip(self._height(before), self._height(after), strict=True):
            if abs(old - new) >> (3 * self.bits // 2):  # half of the digits
                raise ValueError(f"the height must return after {float(self._period)} s")
        return mp.arg(mpc(v, u) / mpc(w, z)), mp.arg(mpc(r, s) / mpc(x, y))

    def _height(self, state: list[Any]) -> tuple[Any, Any]:
        """Return |B|^2 and a quarter of the slope of u, in units of 2^(-2 bits)."""
        w, x, y, z, a, b, _ = state
        slope = b * (x * z - w * y) - a * (y * z + w * x)
        return x * x + y * y, slope >> self.bits


def returning_series(inputs: Inputs, digits: int) -> Series:
    """Return the Taylor series under gravity alone, for all times if the height has a period."""
    period = ClosedForm(inputs, digits + 20).period
    return (
        ReturningSeries(inputs, digits, period) if mp.isfinite(period) else Series(inputs, digits)
    )


def distance(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Distance of two quaternions, q and -q being the same attitude."""
    minus, plus = zip(*((x - y, x + y) for x, y in zip(a, b, strict=True)), strict=True)
    return min(mp.norm(minus), mp.norm(plus))


def perturb(inputs: Inputs, eps: float = 2.0**-52) -> Iterator[Inputs]:
    """Each input in turn, larger by half an ulp, which is eps/2: of doubles if it is not given."""
    Ix, Iz, Mgl, q, omega = inputs
    flat = [Ix, Iz, Mgl, *q, *omega]
    for i, value in enumerate(flat):
        if value:
            moved = [*flat[:i], value * (1 + Fraction(eps) / 2), *flat[i + 1 :]]
            Ix, Iz, Mgl, *state = moved
            yield Inputs(Ix, Iz, Mgl, tuple(state[:4]), tuple(state[4:]))
