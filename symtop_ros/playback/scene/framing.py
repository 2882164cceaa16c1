"""How much of a motion is seen at once: in space, of its trace, and in the plots."""

from __future__ import annotations

import math
from dataclasses import dataclass

from symtop_ros.run.segment import Segment

NUTATIONS = 12  # of the trace, where a turn of the precession has more of them
PLOTTED = 30  # nutations on each side of the cursor
LOWEST = 1.65  # rad; a little below the horizon


@dataclass(frozen=True, slots=True)
class Framing:
    """What fits one motion; the default is for a log that does not say which it is.

    Attributes
    ----------
    trail : float
        How long the trace of the axis stays, s of the clock.
    window : float
        What the plots show on each side of the cursor, s of the clock.
    low : bool
        Whether the axis goes below the pivot: then there is no stand, and all of the sphere.
    """

    trail: float = 2.0
    window: float = 10.0
    low: bool = True

    @classmethod
    def of(cls, segment: Segment) -> Framing:
        """Return the framing of a motion."""
        path = segment.path
        rate, nutation = path.mean_precession_rate, path.nutation_period
        turn = 2 * math.pi / abs(rate) if rate else math.inf
        return cls(
            trail=_within(0.2, min(turn, NUTATIONS * nutation) / segment.factor, 30.0),
            window=_within(2.0, PLOTTED * nutation / segment.factor, 60.0),
            low=path.top.Mgl < 0 or path.turning_angles[1] > LOWEST,
        )


def _within(low: float, value: float, high: float) -> float:
    """A number between two bounds; the lower one for what is no number."""
    return min(max(low, value), high)
