"""Phases that grow with time, reduced to one turn without loss.

A frequency given to 32 digits times a double is known to 32 digits; whole turns are then taken off
exactly. What is left is good to rounding for any time, where rate * t in floating point would have
lost eps times the whole phase.
"""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.precise import PRECISE, TWO_PI, split

Real = NDArray[np.float64]

LARGEST = 1e280  # turns; long before, no digit of a phase is left and any state is as good
SPLITTER = 134217729.0  # 2**27 + 1 (Dekker, Numer. Math. 18 (1971) 224)


class Phases:
    """Several phases growing at constant rates.

    Parameters
    ----------
    rates : sequence of Decimal
        In rad/s.
    """

    def __init__(self, *rates: Decimal) -> None:
        pairs = [split(PRECISE.divide(rate, TWO_PI)) for rate in rates]
        self._high, self._low = np.array(pairs).T[:, :, np.newaxis]
        self._parts = _halves(self._high)
        self._last = LARGEST / max(1.0, float(np.abs(self._high).max()))

    def at(self, t: Real) -> Real:
        """Phases (k, n) in [-pi, pi] at times t (n,), in rad."""
        t = np.minimum(np.maximum(t, -self._last), self._last)
        product = self._high * t
        (a, b), (c, d) = self._parts, _halves(t)
        error = ((a * c - product) + a * d + b * c) + b * d
        fraction = (product - np.rint(product)) + (error + self._low * t)
        return np.asarray((2 * math.pi) * (fraction - np.rint(fraction)))


def _halves(x: Real) -> tuple[Real, Real]:
    """Split doubles into two of 26 bits each, which multiply without rounding."""
    small = x * 2.0**-30  # so that the splitter does not overflow
    big = SPLITTER * small
    high = (big - (big - small)) * 2.0**30
    return high, x - high
