"""The 3D scene of the page. Handles are made once; a frame only sets their attributes."""

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from viser import (
    ArrowsHandle,
    LabelHandle,
    LineSegmentsHandle,
    MeshHandle,
    ViserServer,
)

from symtop_ros.arrays import Real
from symtop_ros.drawing.mesh import create_body, create_lathe
from symtop_ros.physics import State, Top, specific_force
from symtop_ros.simulation.segment import Segment
from symtop_ros.web.run import TRACE, Run

Color = tuple[int, int, int]
# Colours that are visible on white and on black, and different for colour-blind people.
BLUE, GREEN, RED = (10, 70, 190), (0, 158, 115), (213, 60, 10)
GOLD, ORANGE, GREY, VIOLET = (230, 150, 0), (236, 140, 0), (140, 148, 162), (150, 60, 190)
STONE = (112, 118, 130)
STAND = ((0.0, -0.32), (0.17, -0.32), (0.17, -0.28), (0.05, -0.22), (0.03, -0.03), (0.0, -0.02))
CHUNK = 16  # lines of the trace in one node: a frame sends the newest node only
CHUNKS = TRACE // CHUNK + 1
# The camera for a top above its pivot, for one that also goes below, and for one whose angular
# momentum points down: seen from above, its rotor would hide the arrows.
ABOVE, AROUND_PIVOT, BELOW = 0, 1, 2
EYES = ((1.9, -2.2, 1.35), (2.75, -3.2, 1.3), (2.75, -3.2, -1.3))
TARGETS = ((0.0, 0.0, 0.45), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
HORIZON = 1.65  # rad; the axis goes below the pivot: no stand, and the whole sphere
AROUND = np.linspace(0, 2 * np.pi, 97)
HIDDEN, ZERO = np.zeros((1, 2, 3)), np.zeros(3)
SHORTEST = 0.02  # scene units; shorter arrows have no direction that can be seen
GHOST_OPACITY = 0.28
HANDLE_RADIUS = 0.055
SENSOR = "specific force"  # drawn if the top carries a sensor
# Lengths of the arrows in scene units, for the largest vector at the start of the motion.
LENGTHS = {"L": 1.3, "omega": 1.15, "torque": 0.55, SENSOR: 0.8}
COLORS = {"L": BLUE, "omega": GREEN, "torque": RED, SENSOR: VIOLET}
# Labels stand at the ends of their arrows; L and omega are often nearly parallel, so that their
# labels have different sides.
SIDES: dict[str, Literal["bottom-left", "center-right", "top-center"]] = {
    "L": "bottom-left",
    "omega": "center-right",
    "torque": "top-center",
    SENSOR: "top-center",
}
LABEL_GAP = 0.06
LAYERS = (
    *LENGTHS,
    *("trace", "turning circles", "line of nodes", "ghost", "sphere", "handle"),
)


class Scene:
    """The top, its arrows and lines, and the ghost."""

    def __init__(self, server: ViserServer) -> None:
        self._scene = server.scene
        self.view = ABOVE  # index of `EYES` and `TARGETS`
        server.initial_camera.position, server.initial_camera.look_at = EYES[0], TARGETS[0]
        server.initial_camera.fov = math.radians(42)
        self._scene.configure_default_lights(cast_shadow=False)
        self._top: Top | None = None
        self._bodies: list[MeshHandle] = []
        for layer in LAYERS:  # which pages switch on and off, each for itself
            self._scene.add_frame(layer_node(layer), show_axes=False)
        self._body = self._scene.add_frame("/top", show_axes=False)
        self._ghost = self._scene.add_frame(f"{layer_node('ghost')}/top", show_axes=False)
        self._ghost.visible = False
        stand = create_lathe(STAND, (STONE, STONE))
        self._stand = self._add_mesh("/stand", stand.positions, stand.triangles, STONE)
        self._sphere = self._add_lines("sphere", _sphere(whole=False), GREY, 0.003)
        self._circles = self._add_lines("turning circles", HIDDEN, ORANGE, 0.008)
        nodes = np.array([[[-0.4, 0, 0], [0.4, 0, 0]]])
        self._nodes = self._add_lines("line of nodes", nodes, VIOLET)
        self._trace = [
            self._add_lines("trace", np.zeros((CHUNK, 2, 3)), GOLD, 0.011, k) for k in range(CHUNKS)
        ]
        self._head = self._add_lines("trace", HIDDEN, GOLD, 0.011, CHUNKS)
        self._traced = 0  # points of the trace that were drawn
        self._arrows = {name: self._add_arrow(name) for name in LENGTHS}
        self._labels = {name: self._add_label(name) for name in LENGTHS}
        self._pull = self._add_arrow("handle")
        # the ball on the axle that users drag
        self.handle = self._scene.add_icosphere(
            f"{layer_node('handle')}/ball", radius=HANDLE_RADIUS, color=ORANGE, cast_shadow=False
        )
        self._scales = dict.fromkeys(LENGTHS, 1.0)

    def begin_motion(self, segment: Segment, state: State) -> None:
        """Draw what holds for a whole motion: body, circles, and the scales of the arrows."""
        motion = segment.motion
        if motion.top != self._top:
            self._top = motion.top
            self._build_body(motion.top)
        self._choose_view(segment, state)
        circles = np.concatenate([_parallel(angle) for angle in motion.turning_angles])
        self._circles.points = circles.astype(np.float32)
        for name, vector in _vectors(segment, state).items():
            largest = abs(motion.top.Mgl) if name == "torque" else float(np.linalg.norm(vector))
            self._scales[name] = LENGTHS[name] / largest if largest else 0.0

    def _choose_view(self, segment: Segment, state: State) -> None:
        """Choose the camera that shows the whole motion; below the pivot there is no stand."""
        motion = segment.motion
        below = motion.top.Mgl < 0 or motion.turning_angles[1] > HORIZON
        view = ABOVE
        if below:
            momentum = motion.top.angular_momentum(state)
            view = BELOW if motion.top.Mgl < 0 and momentum[2] < 0 else AROUND_PIVOT
        if (view == ABOVE) != (self.view == ABOVE):
            self._sphere.points = _sphere(whole=below).astype(np.float32)
        self.view, self._stand.visible = view, not below

    def draw(self, run: Run, pull: Real | None) -> None:
        """Draw the last sample of a run."""
        state, segment = run.state, run.segment
        if state is None or segment is None:
            return
        axis = state.to_world([0.0, 0.0, 1.0])
        self._body.wxyz = state.orientation
        self._draw_ghost(run)
        self._draw_arrows(_vectors(segment, state))
        phi = state.euler_angles.phi
        self._nodes.wxyz = np.array([math.cos(phi / 2), 0.0, 0.0, math.sin(phi / 2)])
        self._draw_trace(run)
        self.handle.position = axis
        self._pull.visible = pull is not None
        if pull is not None and (length := float(np.linalg.norm(pull - axis))) > SHORTEST:
            self._pull.position = axis
            _point(self._pull, pull - axis, length)

    def _draw_trace(self, run: Run) -> None:
        """Send the newest points. Nodes follow each other in a ring, the oldest is overwritten."""
        self._head.points = run.axes[None, -2:].astype(np.float32)
        if run.traced == self._traced:
            return
        if run.traced < self._traced:  # the run began anew
            self._traced = 0
            for node in self._trace:
                node.points = HIDDEN.astype(np.float32)
        newest = (run.traced - 1) // CHUNK
        oldest = max(self._traced // CHUNK, newest - CHUNKS + 1)
        for number in range(oldest, newest + 1):
            self._trace[number % CHUNKS].points = _segments(_choose_points(run, number)).astype(
                np.float32
            )
        self._traced = run.traced

    def _draw_ghost(self, run: Run) -> None:
        ghost = run.ghost.reach(run.stamp)
        self._ghost.visible = ghost is not None
        if ghost is not None:
            self._ghost.wxyz = ghost.state_at(run.stamp).orientation

    def _draw_arrows(self, vectors: Mapping[str, Real]) -> None:
        for name in LENGTHS:
            end = vectors.get(name, ZERO) * self._scales[name]
            length = float(np.linalg.norm(end))
            visible = length > SHORTEST
            self._arrows[name].visible = self._labels[name].visible = visible
            if visible:
                _point(self._arrows[name], end, length)
                self._labels[name].position = end * (1 + LABEL_GAP / length)

    def _build_body(self, top: Top) -> None:
        for handle in self._bodies:
            handle.remove()
        mesh = create_body(top)
        triangles = mesh.colors[mesh.triangles[:, 0]]
        self._bodies = []
        for k, color in enumerate(np.unique(mesh.colors, axis=0)):
            faces = mesh.triangles[(triangles == color).all(axis=1)]
            for parent, opacity in (("/top", None), (self._ghost.name, GHOST_OPACITY)):
                self._bodies.append(
                    self._add_mesh(
                        f"{parent}/part{k}", mesh.positions, faces, tuple(color.tolist()), opacity
                    )
                )

    def _add_mesh(
        self,
        name: str,
        positions: NDArray[np.float32],
        faces: NDArray[np.uint32],
        color: Color,
        opacity: float | None = None,
    ) -> MeshHandle:
        return self._scene.add_mesh_simple(
            name,
            positions,
            faces,
            color=color,
            opacity=opacity,
            side="double",
            cast_shadow=False,
            receive_shadow=False,
        )

    def _add_lines(
        self, layer: str, points: Real, color: Color, thickness: float = 0.009, number: int = 0
    ) -> LineSegmentsHandle:
        name = f"{layer_node(layer)}/lines{number}"
        return self._scene.add_line_segments(name, points, color, thickness=thickness)

    def _add_arrow(self, layer: str) -> ArrowsHandle:
        return self._scene.add_arrows(
            f"{layer_node(layer)}/arrow",
            np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]),
            COLORS.get(layer, ORANGE),
            shaft_radius=0.013,
            head_radius=0.035,
            head_length=0.1,
            visible=False,
        )

    def _add_label(self, name: str) -> LabelHandle:
        # In the world and not in the frame of the arrow: viser places a label by the pose that its
        # parent had in the frame before.
        return self._scene.add_label(f"{layer_node(name)}/name", name, anchor=SIDES[name])


def layer_node(layer: str) -> str:
    """Return the name of the node that holds all that a layer draws."""
    return f"/{layer.replace(' ', '_')}"


def _choose_points(run: Run, number: int) -> Real:
    """Return the points (CHUNK + 1, 3) of a stretch of the trace; it may not be complete."""
    first = run.traced - TRACE + 1  # number of the oldest point that is left
    wanted = np.arange(number * CHUNK, (number + 1) * CHUNK + 1).clip(max(first, 0), run.traced)
    return np.asarray(run.axes[wanted - first])


def _point(arrow: ArrowsHandle, vector: Real, length: float) -> None:
    """Turn an arrow along z into a vector (3,).

    The pose of a node is drawn in the next frame. A change of its points takes the browser longer,
    and the arrow would trail behind the top: they have the length only, which hardly changes.
    """
    x, y, z = vector / length
    half = math.acos(min(max(float(z), -1.0), 1.0)) / 2
    across = math.hypot(x, y) or 1.0
    size = math.sin(half) / across
    arrow.wxyz = np.array([math.cos(half), -size * y, size * x, 0.0])
    arrow.points = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, round(length, 2)]]])


def _vectors(segment: Segment, state: State) -> dict[str, Real]:
    """Return the vectors that are drawn as arrows, in the world frame."""
    motion, rig = segment.motion, segment.rig
    vectors = {
        "L": motion.top.angular_momentum(state),
        "omega": state.to_world(state.angular_velocity),
        "torque": motion.total_torque(state),
    }
    if rig.imu:  # without its noise, which could not be seen
        force = specific_force(motion, state, rig.imu.position, rig.gravity)
        vectors[SENSOR] = state.to_world(force)
    return vectors


def _segments(points: Real) -> Real:
    return np.stack([points[:-1], points[1:]], axis=1)


def _parallel(theta: float) -> Real:
    """Return the circle of the sphere at a tilt, (n, 2, 3)."""
    rim = np.sin(theta) * np.stack([np.cos(AROUND), np.sin(AROUND)], axis=1)
    return _segments(np.column_stack([rim, np.full(len(rim), np.cos(theta))]))


def _sphere(whole: bool) -> Real:
    """Return parallels and meridians of the unit sphere, or of its upper half: (n, 2, 3)."""
    depth = np.pi if whole else np.pi / 2
    tilts = np.linspace(-depth, depth, 97)
    lines = [_parallel(tilt) for tilt in np.pi / 12 * np.arange(2, 12 if whole else 7, 2)]
    for phi in np.pi / 6 * np.arange(6):
        side = np.sin(tilts)
        lines.append(
            _segments(np.column_stack([np.cos(phi) * side, np.sin(phi) * side, np.cos(tilts)]))
        )
    return np.concatenate(lines)
