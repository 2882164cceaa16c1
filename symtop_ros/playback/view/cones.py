"""Cones of a free top: the cone of omega in the body rolls on the cone of omega in space.

The end of omega draws the polhode in the body and the herpolhode in space (Poinsot). Both are
circles for a symmetric top, so that they are drawn once for a motion.
"""

import math

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import BLUE, GREEN, PALE_BLUE, PALE_GREEN
from symtop_ros.playback.view.mesh import create_lathe
from symtop_ros.playback.view.stream import Stream

OPACITY = 70  # of 255
AROUND = np.linspace(0.0, 2 * np.pi, 97)
NARROWEST = 1e-3  # radius of a cone that can be seen, in scene units


def has_cones(motion: Motion) -> bool:
    """Return True if no torque acts at all, so that L is constant and omega stays on two cones."""
    return motion.top.Mgl == 0 and not motion.is_driven


def log_cones(stream: Stream, motion: Motion, state: State, scale: float) -> None:
    """Draw both cones of a free motion from the current time on."""
    wx, wy, wz = (state.angular_velocity / scale).tolist()
    _log_cone(stream, entities.POLHODE, math.hypot(wx, wy), wz, (GREEN, PALE_GREEN))
    L = motion.top.angular_momentum(state)
    size = float(np.linalg.norm(L))
    if size == 0.0:
        return
    direction, omega = L / size, state.to_world(state.angular_velocity) / scale
    along = float(omega @ direction)
    across = float(np.linalg.norm(omega - along * direction))
    _log_cone(stream, entities.HERPOLHODE, across, along, (BLUE, PALE_BLUE))
    turned = rr.Transform3D(quaternion=rr.Quaternion(xyzw=_turn_up_to(direction)))
    stream.log(entities.HERPOLHODE, turned)


def clear_cones(stream: Stream) -> None:
    """Remove both cones from the current time on."""
    for entity in (entities.POLHODE, entities.HERPOLHODE):
        stream.log(entity, rr.Clear(recursive=True))


def _log_cone(
    stream: Stream,
    entity: str,
    radius: float,
    height: float,
    colors: tuple[tuple[int, int, int], tuple[int, int, int]],
) -> None:
    """Log a translucent cone about the z axis of its entity, and its rim."""
    if radius < NARROWEST:
        stream.log(f"{entity}/cone", rr.Clear(recursive=False))
        stream.log(f"{entity}/rim", rr.Clear(recursive=False))
        return
    profile = sorted([(0.0, 0.0), (radius, height)], key=lambda point: point[1])
    stream.log_mesh(f"{entity}/cone", create_lathe(profile, (colors[1],) * 2), OPACITY)
    rim = np.stack(
        [radius * np.cos(AROUND), radius * np.sin(AROUND), np.full_like(AROUND, height)], axis=1
    )
    stream.log(f"{entity}/rim", rr.LineStrips3D([rim], colors=[colors[0]], radii=[0.006]))


def _turn_up_to(direction: Real) -> Real:
    """Return the quaternion x, y, z, w that turns z' into a unit vector."""
    x, y, z = direction.tolist()
    if z < -1 + 1e-12:
        return np.array([1.0, 0.0, 0.0, 0.0])
    q = np.array([-y, x, 0.0, 1.0 + z])
    return np.asarray(q / np.linalg.norm(q))
