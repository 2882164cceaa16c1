"""The trace of the axis on the unit sphere: a short line for each sample, shown for a while."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]
LINES = 3000  # in the trace at one time, at most
GAP = 5  # periods without a sample: nothing is drawn across


class Trace:
    """Joins the points of one batch to those of the next.

    Attributes
    ----------
    length : float
        Seconds that are shown at one time.
    """

    def __init__(self) -> None:
        self.length = 0.0
        self._stamps: Stamps = np.empty(0, np.int64)
        self._points: Real = np.empty((0, 3))

    def strips(self, stamps: Stamps, points: Real) -> tuple[Stamps, Real]:
        """Return the stamps at which new lines end, and the lines (n, 2, 3)."""
        stamps = np.concatenate([self._stamps, stamps])
        points = np.concatenate([self._points, points])
        step = self._step(stamps)
        stamps, points = stamps[::step], points[::step]
        self._stamps, self._points = stamps[-1:], points[-1:]
        lasted = np.diff(stamps)
        near = (lasted > 0) & (lasted <= GAP * np.median(lasted)) if len(lasted) else lasted > 0
        return stamps[1:][near], np.stack([points[:-1], points[1:]], axis=1)[near]

    def _step(self, stamps: Stamps) -> int:
        """Take every so many samples, so that what is shown at one time stays fluid."""
        if len(stamps) < 2:
            return 1
        period = float(np.median(np.diff(stamps))) * 1e-9
        return max(1, math.ceil(self.length / max(period, 1e-9) / LINES))
