"""The ghost as a translucent body with a thin trace; see `drawing.ghost`."""

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real, Stamps
from symtop_ros.drawing.ghost import Ghost
from symtop_ros.drawing.mesh import create_body
from symtop_ros.playback.view.entities import GHOST, GHOST_TRACE, WHITE
from symtop_ros.playback.view.quantities import axis_of, find_step
from symtop_ros.playback.view.stream import Stream
from symtop_ros.playback.view.surroundings import Trace
from symtop_ros.simulation.segment import Segment

RATE = 125.0  # states per s of the clock; more would not be seen
OPACITY = 90  # of 255


class GhostView(Ghost):
    """The motion without the last kick, drawn with its trace."""

    def __init__(self, stream: Stream) -> None:
        super().__init__()
        self._stream, self._trace = stream, Trace()
        stream.style_lines(GHOST_TRACE, (*WHITE, 150), 0.004)

    def follow(self, name: str, before: Segment | None, after: Segment) -> None:
        """Take over the change of an event, and draw it; a kick begins a new trace."""
        old = self.segment
        super().follow(name, before, after)
        if name == "kick":
            self._trace = Trace()
        if self.segment is None:
            if old is not None:
                self._clear()
        elif old is None or self.segment.motion.top != old.motion.top:
            self._stream.log_mesh(GHOST, create_body(self.segment.motion.top), OPACITY)
            # The axis is seen where the bodies overlap.
            color = (*WHITE, 190)
            axis = rr.LineStrips3D([[(0, 0, 0), (0, 0, 1)]], colors=[color], radii=[0.005])
            self._stream.log(f"{GHOST}/axis", axis)

    def send(self, stamps: Stamps, length: float) -> None:
        """Send the states at some of the stamps, and the trace, visible for some time (s)."""
        if self.segment is None:
            return
        chosen, quaternions = self.states_at(stamps)
        if self.segment is None:
            self._stream.set_time(int(stamps[0]))
            self._clear()
            return
        self._stream.send_turns(GHOST, chosen, quaternions)
        self._trace.length = length
        times, strips = self._trace.strips(chosen, axis_of(quaternions))
        if len(times):
            self._stream.send_lines(GHOST_TRACE, times, strips)

    def states_at(self, stamps: Stamps) -> tuple[Stamps, Real]:
        """Return some of the stamps, and the quaternions x, y, z, w (n, 4) there."""
        segment = self.reach(int(stamps[-1])) if len(stamps) else None
        if segment is None:
            return stamps[:0], np.empty((0, 4))
        chosen = stamps[:: find_step(stamps, RATE)]
        orientation = segment.state_at(chosen).orientation
        return chosen, np.broadcast_to(orientation, (len(chosen), 4))[:, [1, 2, 3, 0]]

    def _clear(self) -> None:
        self._stream.log(GHOST, rr.Clear(recursive=True))
        self._stream.log(GHOST_TRACE, rr.Clear(recursive=False))
