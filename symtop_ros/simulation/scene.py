"""A run of a scene that starts at the stamp 0, without a node."""

from symtop_ros.physics import Motion
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.segment import NO_RIG, Segment
from symtop_ros.simulation.sensor import Rig
from symtop_ros.simulation.settings import Settings


def start_motion(settings: Settings) -> Motion:
    """Return the motion of a scene from its initial conditions."""
    start = initial_state(settings.top, settings.initial, {})
    return Motion(settings.top, start, settings.friction, settings.steady_torque)


def start_event(motion: Motion, rig: Rig = NO_RIG) -> Event:
    """Return the event with which a run of a motion starts, from which it can be computed."""
    segment = Segment.begin(motion, 0, 1.0, rig)
    return Event.of(0, "start", "", {}, motion.start, segment)
