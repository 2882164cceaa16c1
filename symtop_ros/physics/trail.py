"""Points on the way of an integration: few enough to keep, dense enough to come back to."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections import deque

from symtop_ros.physics.splitting import Point, Splitting

KEPT = 1024  # points all along the way; with more than that every other one is dropped
RECENT = 64  # points behind the last one: to look back a little costs nothing


class Trail:
    """The grid of an integration in one direction of time.

    The motion alone decides on the grid, not what was asked before: a state is the same to the last
    bit whichever way one comes to it.

    Parameters
    ----------
    splitting : Splitting
    start : Point
        At t = 0.
    direction : {1, -1}
        Of time.
    """

    def __init__(self, splitting: Splitting, start: Point, direction: int) -> None:
        self._splitting, self._direction = splitting, direction
        self._kept, self._spacing = [start], 1  # points, and steps from one of them to the next
        self._here, self._steps = start, 0  # where one is, and steps from the start to there
        self._recent = deque([(start, 0)], RECENT)

    def at(self, t: float) -> Point:
        """Return the point at a time in s."""
        self.reach(t, math.inf)
        here = self._here
        return here if here.t == t else self._splitting.step(here, t)

    def reach(self, t: float, most: float) -> float:
        """Go on towards a time, in so many steps at most; return the time up to which one is."""
        if abs(self._here.t) > abs(t):
            self._go_back(t)
        following = self._following()
        while most > 0 and abs(following) <= abs(t):
            self._step(following)
            following = self._following()
            most -= 1
        return min(t, following, key=abs)

    def _following(self) -> float:
        return self._splitting.next_time(self._here, self._direction)

    def _step(self, t: float) -> None:
        self._here = self._splitting.step(self._here, t)
        self._steps += 1
        self._recent.append((self._here, self._steps))
        if self._steps == len(self._kept) * self._spacing:
            self._kept.append(self._here)
        if len(self._kept) > KEPT:
            self._kept, self._spacing = self._kept[::2], 2 * self._spacing

    def _go_back(self, t: float) -> None:
        while self._recent and abs(self._recent[-1][0].t) > abs(t):
            self._recent.pop()
        if not self._recent:
            place = bisect_right(self._kept, abs(t), key=lambda point: abs(point.t)) - 1
            self._recent.append((self._kept[place], place * self._spacing))
        self._here, self._steps = self._recent[-1]
