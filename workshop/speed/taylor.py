"""Motions to more than 20 digits, by Taylor series of the equations of motion.

It is what errors are measured from. It shares no formula with the closed form: it knows Euler's
equations and q' = q omega/2 only. Doubles would not do, because the error of a step in doubles is
as large as the errors that are measured. Python's decimal module has as many digits as are needed,
and takes some seconds for ten seconds of the article's top.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from decimal import Context, Decimal, localcontext
from operator import mul
from typing import NamedTuple

import numpy as np

from symtop_ros.arrays import Real
from workshop.speed.peers.peer import Task, initial_values

PowerSeries = list[Decimal]  # coefficients of powers of the time since the start of a step

DIGITS = 32
# Order and step of a Taylor integration with a relative error of 10^-26 in each step: the order is
# 1 - ln(error)/2, and the step is 1/e^2 of the radius of convergence (A. Jorba and M. Zou, A
# software package for the numerical integration of ODEs, Experimental Mathematics 14 (2005) 99).
ORDER = 31
SHARE_OF_RADIUS = Decimal(-2).exp()
HALF = Decimal("0.5")


class TaylorStep(NamedTuple):
    """A time in s, and the series of w, x, y, z in the time since then."""

    t: Decimal
    series: tuple[PowerSeries, ...]


class TaylorMotion:
    """The motion of a task, integrated as far as it has been asked for."""

    def __init__(self, task: Task) -> None:
        self._context = Context(prec=DIGITS)
        with localcontext(self._context):
            self._moments = tuple(Decimal(each) for each in task.top.moments)
            self._friction = Decimal(task.friction.axial), Decimal(task.friction.transverse)
            *q, wx, wy, wz = (Decimal(each) for each in initial_values(task))
            size = sum(map(mul, q, q), Decimal(0)).sqrt()
            self._state = [*(each / size for each in q), wx, wy, wz]
        self._t = Decimal(0)
        self._steps: list[TaylorStep] = []
        self._known: dict[float, tuple[list[float], list[float]]] = {}

    def at(self, times: Sequence[float] | Real) -> tuple[Real, Real]:
        """Return the orientations at times in s, >= 0, as sums of two doubles."""
        doubles = [float(t) for t in times]
        with localcontext(self._context):
            for t in doubles:
                if t not in self._known:
                    self._known[t] = self._evaluate(Decimal(t))
        found = np.array([self._known[t] for t in doubles])
        return found[:, 0], found[:, 1]

    def _evaluate(self, t: Decimal) -> tuple[list[float], list[float]]:
        while self._t <= t:
            self._advance()
        start, series = self._steps[bisect_right(self._steps, t, key=lambda step: step.t) - 1]
        exact = [_sum_series(each, t - start) for each in series]
        high = [float(each) for each in exact]
        return high, [float(e - Decimal(h)) for e, h in zip(exact, high, strict=True)]

    def _advance(self) -> None:
        """Add a step, as long as the convergence of its series allows."""
        series = self._expand()
        radius = min(_estimate_radius(series, n) for n in (ORDER - 1, ORDER))
        step = SHARE_OF_RADIUS * radius
        self._steps.append(TaylorStep(self._t, tuple(series[:4])))
        self._state = [_sum_series(each, step) for each in series]
        self._t += step

    def _expand(self) -> list[PowerSeries]:
        """Return the series of the seven variables about the present state.

        Coefficient n + 1 of a variable is coefficient n of its rate divided by n + 1, and
        coefficient n of a product of two series is a sum over coefficients 0 to n.
        """
        series = [[each] for each in self._state]
        for n in range(ORDER):
            for each, rate in zip(series, self._rates(series), strict=True):
                each.append(rate / (n + 1))
        return series

    def _rates(self, series: list[PowerSeries]) -> Iterator[Decimal]:
        """Return the last known coefficients of the rates: q' = q omega/2 and Euler's equations."""
        (Ix, Iz, Mgl), (axial, transverse) = self._moments, self._friction
        w, x, y, z, wx, wy, wz = series
        gx = 2 * (_multiply(x, z) - _multiply(w, y))
        gy = 2 * (_multiply(y, z) + _multiply(w, x))
        torque_x = (Ix - Iz) * _multiply(wy, wz) + Mgl * gy - transverse * wx[-1]
        torque_y = (Iz - Ix) * _multiply(wz, wx) - Mgl * gx - transverse * wy[-1]
        return iter(
            (
                -HALF * (_multiply(x, wx) + _multiply(y, wy) + _multiply(z, wz)),
                HALF * (_multiply(w, wx) + _multiply(y, wz) - _multiply(z, wy)),
                HALF * (_multiply(w, wy) - _multiply(x, wz) + _multiply(z, wx)),
                HALF * (_multiply(w, wz) + _multiply(x, wy) - _multiply(y, wx)),
                torque_x / Ix,
                torque_y / Ix,
                -axial * wz[-1] / Iz,
            )
        )


def _multiply(a: PowerSeries, b: PowerSeries) -> Decimal:
    """Return the last coefficient of the product of two series of the same length."""
    return sum(map(mul, a, reversed(b)), Decimal(0))


def _sum_series(series: PowerSeries, t: Decimal) -> Decimal:
    """Return the sum of a power series, by Horner's rule."""
    total = Decimal(0)
    for coefficient in reversed(series):
        total = total * t + coefficient
    return total


def _estimate_radius(series: list[PowerSeries], n: int) -> Decimal:
    """Return the radius of convergence in s, from coefficient n of all variables (root test).

    Orientation and angular velocity have different sizes, so each is divided by its own.
    """
    ratios = (
        max(abs(each[n]) for each in part) / max(abs(each[0]) for each in part)
        for part in (series[:4], series[4:])
        if any(each[0] for each in part)
    )
    largest = max(ratios, default=Decimal(0))
    return (-largest.ln() / n).exp() if largest else Decimal(1)
