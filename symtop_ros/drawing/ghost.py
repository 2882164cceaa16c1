"""The ghost: the top that was not kicked, next to the one that was.

Would the top have risen anyway? The motion just before the last kick continues, exactly, at the
same stamps. Whatever else happens to the run (parameters, torques, pauses, steps, another real-time
factor) happens to both.
"""

from dataclasses import replace

from symtop_ros.physics import Motion
from symtop_ros.simulation.budget import StepBudget
from symtop_ros.simulation.events import RESTARTS
from symtop_ros.simulation.segment import START, Segment

MOST_STEPS = 3000  # of an integration, for one batch; a log may ask for years


class Ghost:
    """The motion without the last kick."""

    def __init__(self) -> None:
        # the run without the last kick; None before the first kick and after a restart
        self.segment: Segment | None = None

    def follow(self, name: str, before: Segment | None, after: Segment) -> None:
        """Take over the change of an event, between the segments before and after it."""
        if name in RESTARTS or before is None:
            self.segment = None
        elif name == "kick":
            self.segment = before
        elif self.segment is not None:
            self.segment = _continue(self.segment, after, before)

    def reach(self, stamp: int) -> Segment | None:
        """Return the segment if its state at a stamp (ns) can be computed in time.

        A motion under friction or a torque that is too fast or too long is given up.
        """
        segment = self.segment
        if segment and not StepBudget().reach(segment.motion, segment.time_at(stamp), MOST_STEPS):
            self.segment = None
        return self.segment


def _continue(ghost: Segment, after: Segment, before: Segment) -> Segment:
    """Return the ghost's segment from the start of `after` on, which follows `before`."""
    stamp, old, new = after.stamp, before.motion, after.motion
    added = (new.top, new.friction, new.applied_torque)
    timing = replace(ghost, factor=after.factor, running=after.running, stamp=stamp)
    if added != (old.top, old.friction, old.applied_torque):
        motion = Motion(new.top, ghost.state_at(stamp), new.friction, new.applied_torque)
        return replace(timing, motion=motion, elapsed=START)
    elapsed = ghost.elapsed_at(stamp)
    if new.start == old.start:  # the same motion: a step, or a time that the clock lost
        elapsed += after.elapsed - before.elapsed_at(stamp)
    return replace(timing, elapsed=elapsed)
