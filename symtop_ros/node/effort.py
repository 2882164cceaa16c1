"""How much work the engine has with a motion, and how fast a motion it can keep up with."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

from symtop_ros.run.segment import Segment

STEPS = 50  # of the engine between two looks at the clock: about a millisecond
PATIENCE = 0.02  # s of work for one block of samples; what takes longer cannot be kept up with
SHARE = 0.5  # of a core that the engine may take then


class Shortfall(NamedTuple):
    """Where the engine has got to (s of motion), and seconds of motion per second it can do."""

    reached: float
    factor: float


class Effort:
    """Prepares states, and keeps account of the time that takes.

    Attributes
    ----------
    spent : float
        s of work, so far.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.spent = 0.0

    def prepare(self, segment: Segment, first: int, last: int) -> Shortfall | None:
        """Let the engine go on to the last of some stamps (ns); return why, where it cannot."""
        begin, end = segment.time_at(first), segment.time_at(last)
        begun = self._clock()
        while (reached := segment.path.reach(end, STEPS)) != end:
            spent = self._clock() - begun
            if spent > PATIENCE:
                self.spent += spent
                return Shortfall(reached, SHARE * max(reached - begin, 0.0) / spent)
        self.spent += self._clock() - begun
        return None
