"""The trace of the axis on the unit sphere: a short line for each sample, shown for a while."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from symtop_ros.run.segment import Segment

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]
NUTATIONS = 12  # shown, where a turn of the precession has more of them
LONGEST, SHORTEST = 30.0, 0.2  # s
LINES = 3000  # in the trace at one time, at most
GAP = 5  # periods without a sample: nothing is drawn across


def trail_of(segment: Segment) -> float:
    """How long the trace stays, in s of the clock: a turn of the precession, or some nutations."""
    path = segment.path
    turn = 2 * math.pi / abs(path.mean_precession_rate) if path.mean_precession_rate else math.inf
    times = [time for time in (turn, NUTATIONS * path.nutation_period) if math.isfinite(time)]
    return min(max(min(times, default=LONGEST) / segment.factor, SHORTEST), LONGEST)


class Trace:
    """Joins the points of one batch to those of the next.

    Attributes
    ----------
    length : float or None
        Seconds that are shown; None for all.
    """

    def __init__(self) -> None:
        self.length: float | None = None
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
        if self.length is None or len(stamps) < 2:
            return 1
        period = float(np.median(np.diff(stamps))) * 1e-9
        return max(1, math.ceil(self.length / max(period, 1e-9) / LINES))
