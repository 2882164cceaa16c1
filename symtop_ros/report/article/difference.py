"""The slope of a motion by a central difference of the eighth order, and how far to trust it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)  # of f(t + k h) - f(t - k h), over h
STEP = 5e-4  # s; the article's top turns by a tenth of a radian in it


class Slope(NamedTuple):
    """Derivatives (n, ...), and the largest change in them when the step is doubled."""

    values: Real
    error: float


def slope(function: Callable[[Real], Real], times: Real, step: float = STEP) -> Slope:
    """Differentiate a function of times (n,) with values (n, ...)."""
    fine, coarse = _difference(function, times, step), _difference(function, times, 2 * step)
    return Slope(fine, float(np.abs(coarse - fine).max()))


def _difference(function: Callable[[Real], Real], times: Real, step: float) -> Real:
    total = np.zeros_like(function(times))
    for k, weight in enumerate(WEIGHTS, start=1):
        total += weight * (function(times + k * step) - function(times - k * step))
    return total / step
