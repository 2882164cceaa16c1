"""The ghost as a translucent body with a thin trace; see `drawing.ghost`."""

from __future__ import annotations

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real, Stamps
from symtop_ros.drawing import ghost as drawing
from symtop_ros.drawing.mesh import create_body
from symtop_ros.physics import Motion
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.bodies import to_mesh3d
from symtop_ros.playback.view.quantities import axis_of, find_step
from symtop_ros.playback.view.stream import Stream
from symtop_ros.playback.view.surroundings import Trace
from symtop_ros.simulation.segment import Segment

RATE = 125.0  # states per s of the clock; more would not be seen
OPACITY = 90  # of 255


class Ghost(drawing.Ghost):
    """The motion without the last kick, and its trace."""

    def __init__(self) -> None:
        super().__init__()
        self.trace = Trace()

    def follow(self, name: str, before: Segment | None, after: Segment) -> None:
        """Take over what an event changes; a kick begins a new trace."""
        super().follow(name, before, after)
        if name == "kick":
            self.trace = Trace()

    def states_at(self, stamps: Stamps) -> tuple[Stamps, Real]:
        """Return some of the stamps, and the quaternions x, y, z, w (n, 4) there."""
        segment = self.reach(int(stamps[-1])) if len(stamps) else None
        if segment is None:
            return stamps[:0], np.empty((0, 4))
        chosen = stamps[:: find_step(stamps, RATE)]
        orientation = segment.state_at(chosen).orientation
        quaternions = np.broadcast_to(orientation, (len(chosen), 4))[:, [1, 2, 3, 0]]
        return chosen, quaternions

    def strips(self, stamps: Stamps, quaternions: Real, length: float) -> tuple[Stamps, Real]:
        """Return the lines of the trace, visible for some time (s), and their stamps."""
        self.trace.length = length
        return self.trace.strips(stamps, axis_of(quaternions))


def create_ghost(motion: Motion) -> rr.Mesh3D:
    """Return the translucent body of a top."""
    return to_mesh3d(create_body(motion.top), OPACITY)


def log_styles(stream: Stream) -> None:
    """Log the style of the ghost's trace."""
    lines = rr.LineStrips3D.from_fields(colors=[(*entities.WHITE, 150)], radii=[0.004])
    stream.log(entities.GHOST_TRACE, lines, static=True)


def create_axis() -> rr.LineStrips3D:
    """Return the axis of the ghost, so that it is seen where the bodies overlap."""
    return rr.LineStrips3D([[(0, 0, 0), (0, 0, 1)]], colors=[(*entities.WHITE, 190)], radii=[0.005])
