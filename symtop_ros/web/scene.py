"""The 3D scene of the page. Handles are made once; a frame only sets their attributes."""

import math

import numpy as np
from numpy.typing import NDArray
from viser import LineSegmentsHandle, MeshHandle, ViserServer

from symtop_ros.arrays import Real
from symtop_ros.drawing.fictitious import find_scale, place_arrows, torques_of
from symtop_ros.drawing.mesh import create_body, create_lathe
from symtop_ros.physics import State, Top, specific_force
from symtop_ros.simulation.segment import Segment
from symtop_ros.web.arrows import ZERO, Arrow, Color, Side
from symtop_ros.web.run import TRACE, Run

# Colours that are visible on white and on black, and different for colour-blind people.
BLUE, GREEN, RED = (10, 70, 190), (0, 158, 115), (213, 60, 10)
GOLD, ORANGE, GREY, VIOLET = (230, 150, 0), (236, 140, 0), (140, 148, 162), (150, 60, 190)
SKY, INDIGO, MAGENTA = (30, 150, 240), (105, 15, 255), (210, 60, 165)
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
HIDDEN = np.zeros((1, 2, 3))
GHOST_OPACITY = 0.28
HANDLE_RADIUS = 0.055
SENSOR = "specific force"  # drawn if the top carries a sensor
# Lengths of the arrows in scene units, for the largest vector at the start of the motion.
LENGTHS = {"L": 1.3, "omega": 1.15, "torque": 0.55, SENSOR: 0.8}
COLORS = {"L": BLUE, "omega": GREEN, "torque": RED, SENSOR: VIOLET}
# Labels stand at the ends of their arrows; L and omega are often nearly parallel, so that their
# labels have different sides.
SIDES: dict[str, Side] = {
    "L": "bottom-left",
    "omega": "center-right",
    "torque": "top-center",
    SENSOR: "top-center",
}
FICTITIOUS = "fictitious torques"
FICTITIOUS_COLORS = {"gravity": RED, "Coriolis": SKY, "centrifugal": INDIGO, "sum": MAGENTA}
LAYERS = (
    *LENGTHS,
    *("trace", "turning circles", "line of nodes", "ghost", "sphere", "handle", FICTITIOUS),
)
HIDDEN_LAYERS = (FICTITIOUS,)  # until a page asks for them


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
            shown = layer not in HIDDEN_LAYERS
            self._scene.add_frame(layer_node(layer), show_axes=False, visible=shown)
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
        self._arrows = {
            name: Arrow(self._scene, layer_node(name), COLORS[name], name, SIDES[name])
            for name in LENGTHS
        }
        self._torques = {
            name: Arrow(
                self._scene, f"{layer_node(FICTITIOUS)}/{name}", color, name, "center-center"
            )
            for name, color in FICTITIOUS_COLORS.items()
        }
        self.shows_torques = False  # True if a page has switched on the fictitious torques
        self._torque_scale = 1.0  # N m of one scene unit
        self._pull = Arrow(self._scene, layer_node("handle"), ORANGE)
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
        self._torque_scale = find_scale(motion.top, state)
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
        vectors = _vectors(segment, state)
        for name, arrow in self._arrows.items():
            arrow.draw(vectors.get(name, ZERO) * self._scales[name])
        if self.shows_torques:
            self._draw_torques(segment.motion.top, state)
        phi = state.euler_angles.phi
        self._nodes.wxyz = np.array([math.cos(phi / 2), 0.0, 0.0, math.sin(phi / 2)])
        self._draw_trace(run)
        self.handle.position = axis
        self._pull.draw(ZERO if pull is None else pull - axis, axis)

    def _draw_torques(self, top: Top, state: State) -> None:
        torques, phi = torques_of(top, state), np.asarray(state.euler_angles.phi)
        for name, (origin, vector) in place_arrows(torques, phi, self._torque_scale).items():
            self._torques[name].draw(vector, origin)

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


def layer_node(layer: str) -> str:
    """Return the name of the node that holds all that a layer draws."""
    return f"/{layer.replace(' ', '_')}"


def _choose_points(run: Run, number: int) -> Real:
    """Return the points (CHUNK + 1, 3) of a stretch of the trace; it may not be complete."""
    first = run.traced - TRACE + 1  # number of the oldest point that is left
    wanted = np.arange(number * CHUNK, (number + 1) * CHUNK + 1).clip(max(first, 0), run.traced)
    return np.asarray(run.axes[wanted - first])


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
