"""The ghost: the top that was not kicked or clamped, next to the one that was, translucent.

Would the top have risen anyway? The motion just before the last kick or clamp continues, exactly,
at the same stamps. Whatever else happens to the run (parameters, torques, pauses, steps, another
real-time factor) happens to both.
"""

from dataclasses import replace

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real, Stamps, axis_of
from symtop_ros.replay.view.entities import GHOST, GHOST_TRACE, WHITE, Stream, create_body
from symtop_ros.replay.view.quantities import find_step
from symtop_ros.replay.view.surroundings import Trace
from symtop_ros.run.simulation.budget import StepBudget
from symtop_ros.run.simulation.events import KICKS, RESTARTS
from symtop_ros.run.simulation.segment import Segment

RATE = 125.0  # states per s of the clock; more would not be seen
OPACITY = 90  # of 255
LEFT_OUT = (*KICKS, "clamp")  # events that the ghost does without
MOST_STEPS = 3000  # of an integration, for one batch; a log may ask for years


class GhostView:
    """The motion without the last kick or clamp, drawn with its trace."""

    def __init__(self, stream: Stream) -> None:
        # the run without the last kick or clamp; None before the first one and after a restart
        self.segment: Segment | None = None
        self._stream = stream
        self._trace = Trace()
        stream.style_lines(GHOST_TRACE, (*WHITE, 150), 0.004)

    def follow(self, name: str, before: Segment | None, after: Segment) -> None:
        """Take over the change of an event between two segments, and draw it."""
        old = self.segment
        if name in RESTARTS or before is None:
            self.segment = None
        elif name in LEFT_OUT:
            self.segment = before
            self._trace = Trace()
        elif old is not None:
            self.segment = _continue(old, after, before)
        self._redraw(old)

    def remove(self) -> None:
        """Remove the ghost: the run is not known from the current time on."""
        old, self.segment = self.segment, None
        self._redraw(old)

    def _redraw(self, old: Segment | None) -> None:
        """Draw the body of another ghost than before, or remove it."""
        if self.segment is None:
            if old is not None:
                self._clear()
        elif old is None or self.segment.motion.top != old.motion.top:
            self._stream.log_mesh(GHOST, create_body(self.segment.motion.top), OPACITY)
            # The axis is seen where the bodies overlap.
            line = [(0, 0, 0), (0, 0, 1)]
            self._stream.log(
                f"{GHOST}/axis",
                rr.LineStrips3D([line], colors=[(*WHITE, 190)], radii=[0.005]),
            )

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
        """Return some of the stamps, and the quaternions x, y, z, w (n, 4) there.

        A motion under friction or a torque that is too fast or too long is given up.
        """
        segment = self.segment
        if segment is None or not len(stamps):
            return stamps[:0], np.empty((0, 4))
        if not StepBudget().reach(segment.motion, segment.time_at(int(stamps[-1])), MOST_STEPS):
            self.segment = None
            return stamps[:0], np.empty((0, 4))
        chosen = stamps[:: find_step(stamps, RATE)]
        orientation = segment.state_at(chosen).orientation
        return chosen, np.broadcast_to(orientation, (len(chosen), 4))[:, [1, 2, 3, 0]]

    def _clear(self) -> None:
        self._stream.log(GHOST, rr.Clear(recursive=True))
        self._stream.log(GHOST_TRACE, rr.Clear(recursive=False))


def _continue(ghost: Segment, after: Segment, before: Segment) -> Segment:
    """Return the ghost's segment from the start of `after` on, which follows `before`."""
    stamp, old, new = after.stamp, before.motion, after.motion
    added = (new.top, new.friction, new.applied_torque)
    if added != (old.top, old.friction, old.applied_torque):
        return replace(
            ghost.change(stamp, ghost.state_at(stamp), *added),
            factor=after.factor,
            running=after.running,
        )
    elapsed = ghost.elapsed_at(stamp)
    if new.start == old.start:  # the same motion: a step, or a time that the clock lost
        elapsed += after.elapsed - before.elapsed_at(stamp)
    return replace(ghost, factor=after.factor, running=after.running, stamp=stamp, elapsed=elapsed)
