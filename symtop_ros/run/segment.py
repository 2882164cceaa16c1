"""A stretch of a run between two changes: which motion, and which of its times belongs to a stamp.

Stamps are integer nanoseconds of the node's clock. Everything a segment holds is written into an
event when it begins, so that any state of a run can be computed again, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from symtop_ros.physics import Friction, Motion, State, Top, motion


@dataclass(frozen=True, slots=True)
class Segment:
    """One stretch of a run.

    Attributes
    ----------
    path : Motion
        The motion, from its own start.
    stamp : int
        When the segment begins, ns.
    elapsed : float
        Time of the motion at that stamp, s.
    factor : float
        Seconds of motion per second of the clock.
    running : bool
        Whether the motion goes on with the clock, or rests (paused).
    """

    path: Motion
    stamp: int
    elapsed: float
    factor: float
    running: bool

    @classmethod
    def begin(cls, path: Motion, stamp: int, factor: float) -> Segment:
        """Return the first stretch of a motion that starts now."""
        return cls(path, stamp, 0.0, factor, running=True)

    def time_at(self, stamp: Any) -> Any:
        """Time of the motion in s at a stamp in ns, or at an array of them."""
        if not self.running:
            return self.elapsed
        return self.elapsed + self.factor * ((stamp - self.stamp) * 1e-9)

    def state_at(self, stamp: Any) -> State:
        """State of the top at a stamp in ns, or at an array of them; at rest it is one for all."""
        return self.path.at(self.time_at(stamp))

    def restarted(self, start: State, stamp: int) -> Segment:
        """Go on from another state."""
        path = self.path
        return self.onto(motion(path.top, start, path.friction, path.applied_torque), stamp)

    def changed(
        self,
        stamp: int,
        top: Top | None = None,
        friction: Friction | None = None,
        torque: Sequence[float] | None = None,
    ) -> Segment:
        """Go on from the state of now with another top, friction or applied torque."""
        path = self.path
        top = path.top if top is None else top
        friction = path.friction if friction is None else friction
        torque = path.applied_torque if torque is None else torque
        return self.onto(motion(top, self.state_at(stamp), friction, torque), stamp)

    def onto(self, path: Motion, stamp: int) -> Segment:
        """Go on with another motion, from its start."""
        return replace(self, path=path, stamp=stamp, elapsed=0.0)

    def paused(self, stamp: int) -> Segment:
        """Rest at the state of now."""
        return replace(self, stamp=stamp, elapsed=self.time_at(stamp), running=False)

    def resumed(self, stamp: int) -> Segment:
        """Go on from where the motion rests."""
        return replace(self, stamp=stamp, running=True)

    def stepped(self, duration: float, stamp: int) -> Segment:
        """Rest `duration` seconds of motion later."""
        return replace(self, stamp=stamp, elapsed=self.time_at(stamp) + duration)

    def moved(self, stamp: int, to: int) -> Segment:
        """Go on at another stamp from where the motion is: the clock has jumped."""
        return replace(self, stamp=to, elapsed=self.time_at(stamp))

    def with_factor(self, factor: float, stamp: int) -> Segment:
        """Go on at another speed."""
        return replace(self, stamp=stamp, elapsed=self.time_at(stamp), factor=factor)

    def slowed(self, reached: float, factor: float, stamp: int) -> Segment:
        """Go on at another speed from where the engine has got to, if that is less far."""
        return replace(self, stamp=stamp, elapsed=min(reached, self.time_at(stamp)), factor=factor)
