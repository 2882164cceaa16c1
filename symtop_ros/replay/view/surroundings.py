"""Drawings around the top: sphere, stand, nodes, turning circles, trace, cones and angles.

The trace of the axis on the sphere is one short line per sample, visible for some time.

The cones are those of a free top: the cone of omega in the body rolls on the cone of omega in
space. The end of omega draws the polhode in the body and the herpolhode in space (Poinsot). Both
are circles for a symmetric top, so that they are drawn once for a motion.

Euler's angles are drawn as in the article's figure 1: two frames, the line of nodes, three arcs.
phi turns from x' to the line of nodes N in the horizontal plane, theta from z' to z in the vertical
plane of the axis, and psi from N to x in the plane across the axis.
"""

import math

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.physics import Motion, State
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.quantities import find_step, nodes_of
from symtop_ros.run.log.batch import Columns

MAX_LINES = 3000  # visible at one time
MAX_GAP = 5  # sample periods; longer gaps are not bridged by a line
STAND = ((0.0, -0.02), (0.03, -0.03), (0.05, -0.22), (0.17, -0.28), (0.17, -0.32), (0.0, -0.32))[
    ::-1
]
OPACITY = 70  # of 255
AROUND = np.linspace(0.0, 2 * np.pi, 97)
NARROWEST = 1e-3  # radius of a cone that can be seen, in scene units
RATE = 60.0  # positions per s of the clock
POINTS = 33  # of an arc
# In scene units. The arcs have different radii, so that letters do not meet; that of theta is
# outside of the sphere, where the rotor does not hide it. The z axis is longer than L and omega,
# which are nearly parallel to it in a fast top, so that its letter stands beyond theirs.
WORLD_AXES = 1.3
BODY_AXES = (0.8, 0.8, 1.55)
RADII = {"phi": 0.5, "theta": 1.08, "psi": 0.66}
NODES_LENGTH = 0.95
LETTERS = {"phi": "\u03c6", "theta": "\u03b8", "psi": "\u03c8"}
# Colours of the arcs: those of their curves in the plots.
COLORS = {"phi": entities.ORANGE, "theta": entities.GOLD, "psi": entities.GREEN}
BEYOND = 1.08  # a letter's distance from the origin, in radii of its arc


def log_surroundings(stream: entities.Stream, below_pivot: bool) -> None:
    """Log the upper half of the sphere and a stand; the whole sphere if the axis goes below."""
    depth = np.pi if below_pivot else np.pi / 2
    parallels = map(entities.draw_parallel, np.pi / 12 * np.arange(1, 12 if below_pivot else 7))
    meridians = (entities.draw_meridian(turn, depth) for turn in np.pi / 6 * np.arange(6))
    sphere = rr.LineStrips3D([*parallels, *meridians], colors=[entities.GREY], radii=[0.0014])
    stream.log(entities.SPHERE, sphere)
    if below_pivot:
        stream.log(entities.STAND, rr.Clear(recursive=False))
    else:
        stream.log_mesh(entities.STAND, create_stand())


def create_stand() -> entities.Mesh:
    """Return the stand below the pivot."""
    return entities.create_lathe(STAND, (entities.STONE, entities.STONE))


def turning_circles(
    turning_angles: tuple[float, float], color: tuple[int, int, int] = entities.ORANGE
) -> rr.LineStrips3D:
    """Return the circles between which the axis nutates."""
    return rr.LineStrips3D(
        [*map(entities.draw_parallel, turning_angles)], colors=[color], radii=[0.004]
    )


def line_of_nodes(phi: Real) -> Real:
    """Return the line from -0.4 to 0.4 along (cos phi, sin phi, 0), for each phi: (n, 2, 3)."""
    end = 0.4 * nodes_of(phi)
    return np.stack([-end, end], axis=1)


class Trace:
    """Joins the points of one batch to those of the next one."""

    def __init__(self) -> None:
        self.length = 0.0  # visible time in s
        self._stamps: Stamps = np.empty(0, np.int64)
        self._points: Real = np.empty((0, 3))

    def strips(self, stamps: Stamps, points: Real) -> tuple[Stamps, Real]:
        """Return the stamps at which new lines end, and the lines (n, 2, 3)."""
        stamps = np.concatenate([self._stamps, stamps])
        points = np.concatenate([self._points, points])
        # A line spans so many samples that at most `MAX_LINES` are visible.
        period = float(np.median(np.diff(stamps))) * 1e-9 if len(stamps) > 1 else math.inf
        step = max(1, math.ceil(self.length / max(period, 1e-9) / MAX_LINES))
        stamps, points = stamps[::step], points[::step]
        self._stamps, self._points = stamps[-1:], points[-1:]
        lasted = np.diff(stamps)
        near = (lasted > 0) & (lasted <= MAX_GAP * np.median(lasted)) if len(lasted) else lasted > 0
        return stamps[1:][near], np.stack([points[:-1], points[1:]], axis=1)[near]


def has_cones(motion: Motion) -> bool:
    """Return True if no torque acts at all, so that L is constant and omega stays on two cones."""
    return motion.top.Mgl == 0 and not (motion.is_driven or motion.clamped)


def log_cones(stream: entities.Stream, motion: Motion, state: State, scale: float) -> None:
    """Draw both cones of a free motion from the current time on."""
    wx, wy, wz = (state.angular_velocity / scale).tolist()
    _log_cone(
        stream, entities.POLHODE, math.hypot(wx, wy), wz, (entities.GREEN, entities.PALE_GREEN)
    )
    L = motion.top.angular_momentum(state)
    size = float(np.linalg.norm(L))
    if size == 0.0:
        return
    direction = L / size
    omega = state.to_world(state.angular_velocity) / scale
    along = float(omega @ direction)
    across = float(np.linalg.norm(omega - along * direction))
    _log_cone(stream, entities.HERPOLHODE, across, along, (entities.BLUE, entities.PALE_BLUE))
    stream.log(
        entities.HERPOLHODE,
        rr.Transform3D(quaternion=rr.Quaternion(xyzw=_turn_up_to(direction))),
    )


def _log_cone(
    stream: entities.Stream,
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
    stream.log_mesh(f"{entity}/cone", entities.create_lathe(profile, (colors[1],) * 2), OPACITY)
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


def log_frames(stream: entities.Stream) -> None:
    """Log the static parts: both frames, and the styles of the arcs."""
    for entity, lengths, color, mark in (
        (f"{entities.ANGLES}/world", (WORLD_AXES,) * 3, entities.WHITE, "'"),
        (f"{entities.BODY}/axes", BODY_AXES, entities.VIOLET, ""),
    ):
        ends = np.diag(lengths)
        stream.log(entity, rr.Arrows3D(vectors=ends, colors=[color], radii=[0.005]), static=True)
        stream.log_labels(f"{entity}/names", [f"{k}{mark}" for k in "xyz"], color, 1.06 * ends)
    for name, color in COLORS.items():
        stream.style_lines(f"{entities.ANGLES}/{name}", color, 0.008)
        stream.log_labels(f"{entities.ANGLES}/{name}/letter", [LETTERS[name]], color)
    stream.style_arrows(f"{entities.ANGLES}/nodes", entities.ORANGE, 0.006, "N")


def send_angles(stream: entities.Stream, euler: Columns) -> None:
    """Send the arcs, their letters and the line of nodes, at some of the stamps."""
    step = find_step(euler.stamps, RATE)
    stamps, angles = euler.stamps[::step], euler.numbers[::step]
    phi, theta, psi = angles[:, 0] % (2 * np.pi), angles[:, 1], angles[:, 2] % (2 * np.pi)
    for name, arcs in draw_arcs(phi, theta, psi).items():
        entity = f"{entities.ANGLES}/{name}"
        stream.send_lines(entity, stamps, arcs)
        letters = BEYOND * arcs[:, POINTS // 2]
        stream.send(f"{entity}/letter", stamps, rr.Points3D.columns(positions=letters))
    vectors = NODES_LENGTH * nodes_of(phi)
    stream.send_arrows(f"{entities.ANGLES}/nodes", stamps, vectors, 1.06 * vectors)


def draw_arcs(phi: Real, theta: Real, psi: Real) -> dict[str, Real]:
    """Return the arcs (n, 33, 3) of angles (n,) in rad, by the name of the angle."""
    part = np.linspace(0.0, 1.0, POINTS)[:, None]
    nodes = nodes_of(phi)
    ahead = np.stack([np.sin(phi), -np.cos(phi), np.zeros_like(phi)], axis=-1)  # where z leans to
    up = np.array([[0.0, 0.0, 1.0]])
    sine, cosine = np.sin(theta)[:, None], np.cos(theta)[:, None]
    across = sine * up - cosine * ahead  # z x N
    # of each angle its size, the axis at which it begins, and that after a quarter of a turn
    turns = {
        "phi": (phi, np.array([[1.0, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])),
        "theta": (theta, up, ahead),
        "psi": (psi, nodes, across),
    }
    arcs = {}
    for name, (angle, start, quarter) in turns.items():
        cosine, sine = (turn(angle[:, None, None] * part) for turn in (np.cos, np.sin))
        arcs[name] = RADII[name] * (cosine * start[:, None] + sine * quarter[:, None])
    return arcs
