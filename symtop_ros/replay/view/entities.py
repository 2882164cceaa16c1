"""A recording: paths of its entities, their colours, values and shapes, and the body of the top.

The timeline begins with the first sample. The body consists of surfaces of revolution in sectors of
two colours, which make spin visible. Lengths are in scene units: the pivot is the origin, and the
axis ends on the unit sphere.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.physics import Top

# Colours on the dark background
BLUE = (88, 132, 249)
GREEN = (120, 240, 164)
RED = (225, 61, 101)
GOLD = (251, 213, 98)
ORANGE = (192, 103, 34)
VIOLET = (195, 122, 194)
SKY = (120, 190, 250)
GREY = (70, 78, 92)
WHITE = (240, 244, 250)
BACKGROUND = (22, 26, 34)
PALE_GREEN, PALE_BLUE = (60, 140, 95), (60, 105, 170)  # of cones, with their full colours
ASH = (118, 126, 140)  # of what was before
# Of bodies
STEEL = (196, 202, 210)
BRASS = (222, 178, 92)
ENAMEL = (150, 32, 44)
IVORY = (240, 230, 205)
STONE = (92, 98, 110)

TIMELINE = "time"  # s since the first sample
SPACE = "/space"
POINTS = "/space/points"  # measured ones
BODY = "/space/top"
STAND = "/space/stand"
SPHERE = "/space/sphere"
TRACE = "/space/trace"
NODES = "/space/line_of_nodes"
CIRCLES = "/space/turning_circles"
MOMENTUM = "/space/angular_momentum"
VELOCITY = "/space/angular_velocity"
TORQUE = "/space/torque"
SPECIFIC_FORCE = "/space/specific_force"
ANGLES = "/space/angles"
INERTIAL = "/space/inertial_torque"
FICTITIOUS = "/space/fictitious_torque"
POLHODE = "/space/top/polhode"  # in the body frame
HERPOLHODE = "/space/herpolhode"
GHOST = "/space/ghost"
GHOST_TRACE = "/space/ghost_trace"
PANEL = "/motion"
SENTENCE = "/sentence"  # the verdict of the last event
POTENTIAL = "/potential"
CUBIC = "/cubic"
EVENTS = "/events"
THETA = "/plots/theta"
PHI_DOT = "/plots/phi_dot"
PSI_DOT = "/plots/psi_dot"
L = "/plots/L"
L_HORIZONTAL = "/plots/L_horizontal"
DRIFT = "/plots/drift"
ENERGY = "/plots/energy"
NODES_TORQUE = "/plots/torque_along_nodes"
SEEN = f"{THETA}/measured", f"{PHI_DOT}/measured", f"{PSI_DOT}/measured"
# Titles of the plots
PLOTS = {
    THETA: "tilt theta (rad)",
    PHI_DOT: "precession phi' (rad/s)",
    PSI_DOT: "spin psi' (rad/s)",
    L: "angular momentum L (N m s)",
    L_HORIZONTAL: "L\u00b2 - L_z'\u00b2 (N\u00b2 m\u00b2 s\u00b2)",
    ENERGY: "energy, stacked (J)",
    NODES_TORQUE: "torques along the line of nodes (N m)",
    DRIFT: "relative drift of E, L_z, L_z' (eps)",
}
SECTORS = 6  # three pairs of colours: after half a turn the colours are exchanged
STEPS = 10  # facets of a sector
Profile = Sequence[tuple[float, float]]  # radius and height, from the lowest point upwards


def lighten(color: tuple[int, ...]) -> tuple[int, ...]:
    """Return the colour of a label, halfway to white.

    Labels stand on grey in the light theme of the viewer, where the full colours are hard to read.
    """
    return tuple((each + 255) // 2 for each in color[:3])


class Mesh(NamedTuple):
    """Triangles: positions (n, 3), normals (n, 3), colours (n, 3), indices (m, 3)."""

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    colors: NDArray[np.uint8]
    triangles: NDArray[np.uint32]


def draw_parallel(theta: float, count: int = 97) -> Real:
    """Return points (count, 3) on the circle of a tilt on the unit sphere."""
    around = np.linspace(0.0, 2 * np.pi, count)
    rim = np.sin(theta) * np.stack([np.cos(around), np.sin(around)], axis=1)
    return np.column_stack([rim, np.full(count, np.cos(theta))])


def draw_meridian(phi: float, depth: float, count: int = 97) -> Real:
    """Return points (count, 3) on the line over the pole that ends at a tilt on both sides."""
    tilts = np.linspace(-depth, depth, count)
    side = np.sin(tilts)
    return np.column_stack([np.cos(phi) * side, np.sin(phi) * side, np.cos(tilts)])


def create_body(top: Top | None) -> Mesh:
    """Return the body of a top, its rotor at the centre of mass and wider for larger Iz/Ix."""
    sign = 1.0 if top is None else math.copysign(bool(top.Mgl), top.Mgl)
    ratio = 0.25 if top is None else top.Iz / top.Ix
    radius = 0.2 + 0.26 * math.sqrt(ratio)
    height = 0.56 * sign
    low = min(0.0, height - 0.22)
    axle = (
        (0.0, low),
        (0.022, low + 0.03),
        (0.022, 0.93),
        (0.034, 0.95),
        (0.034, 0.985),
        (0.0, 1.0),
    )
    return _join(
        [
            create_lathe(axle, (STEEL, STEEL)),
            create_lathe(_rotor(radius, height), (IVORY, ENAMEL)),
            create_lathe(_rim(radius, height), (BRASS, BRASS)),
        ]
    )


def create_lathe(
    profile: Profile, colors: tuple[tuple[int, int, int], tuple[int, int, int]]
) -> Mesh:
    """Return the surface of a profile turned about the z axis, in sectors of two colours."""
    return _join(
        [_band(*edge, colors[k % 2], k) for edge in pairwise(profile) for k in range(SECTORS)]
    )


def _band(
    below: tuple[float, float], above: tuple[float, float], color: tuple[int, int, int], sector: int
) -> Mesh:
    """Return one edge of the profile over one sector; the normals are those of a cone."""
    angles = 2 * np.pi / SECTORS * (sector + np.linspace(0, 1, STEPS + 1))
    rim = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rows = [np.column_stack([r * rim, np.full(len(rim), z)]) for r, z in (below, above)]
    slope = np.array([above[1] - below[1], below[0] - above[0]])  # outward normal of the profile
    slope /= np.hypot(*slope)
    normals = np.column_stack([slope[0] * rim, np.full(len(rim), slope[1])])
    k = np.arange(STEPS)
    count = STEPS + 1
    triangles = np.concatenate(
        [np.stack([k, k + 1, k + count], 1), np.stack([k + 1, k + 1 + count, k + count], 1)]
    )
    return Mesh(
        np.concatenate(rows).astype(np.float32),
        np.concatenate([normals, normals]).astype(np.float32),
        np.tile(np.array(color, np.uint8), (2 * count, 1)),
        triangles.astype(np.uint32),
    )


def _join(parts: Sequence[Mesh]) -> Mesh:
    offsets = np.cumsum([0, *(len(part.positions) for part in parts[:-1])])
    return Mesh(
        np.concatenate([part.positions for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate([part.colors for part in parts]),
        np.concatenate(
            [part.triangles + np.uint32(k) for part, k in zip(parts, offsets, strict=True)]
        ),
    )


def _rotor(radius: float, height: float) -> Profile:
    """Return the profile of the rotor: a flat pear, widest at the centre of mass."""
    shape = (
        (0.022, -0.2),
        (0.10, -0.17),
        (0.35, -0.11),
        (0.72, -0.06),
        (0.94, -0.035),
        (0.94, 0.035),
        (0.80, 0.05),
        (0.45, 0.075),
        (0.16, 0.105),
        (0.022, 0.14),
    )
    return tuple((max(0.022, r * radius), height + z) for r, z in shape)


def _rim(radius: float, height: float) -> Profile:
    """Return the profile of the round brass edge of the rotor."""
    return [
        (0.94 * radius + 0.06 * radius * math.cos(a), height + 0.035 * math.sin(a))
        for a in np.linspace(-np.pi / 2, np.pi / 2, 9)
    ]


class Stream:
    """A recording with the stamp at which its time is zero."""

    def __init__(self, recording: rr.RecordingStream) -> None:
        self.recording = recording
        self.origin: int | None = None  # that stamp in ns; None before the first sample or event

    def log(self, entity: str, *values: Any, static: bool = False) -> None:
        """Log values at the time that was set."""
        self.recording.log(entity, *values, static=static)

    def set_time(self, stamp: int) -> None:
        """Set the time of an event; events before the first sample are shown at that sample."""
        duration = np.timedelta64(max(0, stamp - (self.origin or 0)), "ns")
        self.recording.set_time(TIMELINE, duration=duration)

    def send(self, entity: str, stamps: Stamps, columns: Any) -> None:
        """Send one value for each stamp."""
        durations = (stamps - (self.origin or 0)).astype("timedelta64[ns]")
        self.recording.send_columns(entity, [rr.TimeColumn(TIMELINE, duration=durations)], columns)

    def send_scalars(self, entity: str, stamps: Stamps, values: Real) -> None:
        """Send values (n, width) to the lines of a plot."""
        columns = rr.Scalars.columns(scalars=values.ravel())
        self.send(entity, stamps, columns.partition([values.shape[1]] * len(values)))

    def send_turns(self, entity: str, stamps: Stamps, quaternions: Real) -> None:
        """Send attitudes x, y, z, w (n, 4) of an entity."""
        self.send(entity, stamps, rr.Transform3D.columns(quaternion=quaternions))

    def send_lines(self, entity: str, stamps: Stamps, strips: Real) -> None:
        """Send lines (n, points, 3), one for each stamp."""
        self.send(entity, stamps, rr.LineStrips3D.columns(strips=list(strips)))

    def send_arrows(
        self, entity: str, stamps: Stamps, vectors: Real, places: Real, origins: Any = None
    ) -> None:
        """Send arrows (n, 3) with the places of their labels; origins are the pivot if None."""
        self.send(entity, stamps, rr.Arrows3D.columns(vectors=vectors, origins=origins))
        self.send(f"{entity}/name", stamps, rr.Points3D.columns(positions=places))

    def style_lines(self, entity: str, color: tuple[int, ...], radius: float) -> None:
        """Set the look of the lines of an entity."""
        self.log(entity, rr.LineStrips3D.from_fields(colors=[color], radii=[radius]), static=True)

    def style_arrows(self, entity: str, color: tuple[int, ...], radius: float, label: str) -> None:
        """Set the look of an arrow, and the text of its label.

        The label is a separate point: the label of an arrow would be drawn at its middle.
        """
        self.log(entity, rr.Arrows3D.from_fields(colors=[color], radii=[radius]), static=True)
        self.log_labels(f"{entity}/name", [label], color)

    def log_labels(
        self, entity: str, labels: list[str], color: tuple[int, ...], positions: Real | None = None
    ) -> None:
        """Log texts at points that are too small to be seen."""
        self.log(
            entity,
            rr.Points3D.from_fields(
                positions=positions,
                radii=[0.001],
                colors=[lighten(color)],
                labels=labels,
                show_labels=True,
            ),
            static=True,
        )

    def log_mesh(
        self, entity: str, mesh: Mesh, opacity: int | None = None, static: bool = False
    ) -> None:
        """Log a body; it is translucent if an opacity (of 255) is given."""
        self.log(
            entity,
            rr.Mesh3D(
                vertex_positions=mesh.positions,
                vertex_normals=mesh.normals,
                vertex_colors=mesh.colors,
                triangle_indices=mesh.triangles,
                albedo_factor=None if opacity is None else [255, 255, 255, opacity],
            ),
            static=static,
        )
