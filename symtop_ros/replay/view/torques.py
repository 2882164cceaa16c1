"""Arrows of torques: the inertial torque in two frames, and the torques in the precessing frame.

The arrows show, for two frames, which part of the torque changes L as seen from the frame. In the
body frame torque = dL/dt + omega x L. In the frame of the line of nodes, which follows the
precession alone, torque = dL/dt + phi' z' x L, and in regular precession dL/dt is zero there. The
arrows lie below and above the pivot, so that those along one line do not hide each other: omega x L
begins below the tip of dL/dt and ends below the tip of the torque.

The torques in the precessing frame are along the line of nodes, head to tail: gravity's, Coriolis'
and the centrifugal one. Each of the three begins below the tip of the one before. So the third ends
below the pivot if the precession is steady, and the fourth, their sum, has no length. They lie at
different depths below the pivot, and their sum above it, so that none hides another.
"""

from typing import NamedTuple

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.physics import FrameTorques, State, Top, precessing_frame_torques
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.quantities import ColumnsByTopic, find_step, join, nodes_of
from symtop_ros.run.log.batch import Columns
from symtop_ros.run.simulation.settings import MAX_RATE

RATE = 60.0  # arrows per s of the clock
LENGTH = 0.9  # of the longest arrow in scene units
EQUATIONS = {
    "in the body frame": "torque = dL/dt + \u03c9 x L",
    "in the frame of the nodes": "torque = dL/dt + \u03c6' z' x L",
}
DEPTHS = {"gravity": 0.08, "Coriolis": 0.15, "centrifugal": 0.22, "sum": -0.08}  # below the pivot
# lengths in scene units: of the longest arrow at the start, and of any later arrow
HIGHEST, LONGEST = 1.0, 2.5
GAP, RAISED = 0.3, 0.05  # of labels: beyond the tip, and up; the viewer draws them below a point
COLORS = {
    "gravity": entities.RED,
    "Coriolis": entities.SKY,
    "centrifugal": entities.GOLD,
    "sum": entities.WHITE,
}
EQUATION = "Ix \u03b8'' = gravity + Coriolis + centrifugal"


class TorqueArrow(NamedTuple):
    """An arrow below or above the pivot."""

    label: str
    color: tuple[int, int, int]
    depth: float  # below the pivot, in scene units; negative above it
    # of the label: along the line of nodes, and up. It is fixed, so that labels stay apart
    # when the arrows are short, as at cusps
    place: tuple[float, float]


ARROWS = {
    "body": TorqueArrow("dL/dt (body)", entities.GREEN, 0.10, (1.15, 0.0)),
    "turning": TorqueArrow("\u03c9 x L (body)", entities.BLUE, 0.20, (0.2, -0.22)),
    "precession": TorqueArrow("\u03c6' z' x L (nodes)", entities.GOLD, -0.10, (-0.9, 0.12)),
}


class Torques(NamedTuple):
    """Parts of the torque as vectors in the world frame, (n, 3), in N m."""

    total: Real  # the torque
    body: Real  # dL/dt as the body frame sees it
    turning: Real  # omega x L
    precession: Real  # phi' z' x L
    nodes: Real  # unit vectors along the line of nodes

    @classmethod
    def of(cls, samples: ColumnsByTopic) -> tuple[Stamps, "Torques"] | None:
        """Return stamps and torques; None if a topic or a sample is missing."""
        found = join(samples, "angular_velocity", "angular_momentum", "torque", "euler_angles")
        if found is None:
            return None
        stamps, (velocity, L, torque, euler) = found
        total = torque[:, 3:]
        turning = np.cross(velocity[:, 3:], L)
        precession = euler[:, 3:4] * np.stack([-L[:, 1], L[:, 0], np.zeros(len(L))], axis=1)
        return stamps, cls(total, total - turning, turning, precession, nodes_of(euler[:, 0]))

    def along_nodes(self) -> Real:
        """Return the components of torque, dL/dt (body) and omega x L along the nodes, (n, 3)."""
        total, turning = (
            (vectors * self.nodes).sum(axis=1) for vectors in (self.total, self.turning)
        )
        return np.stack([total, total - turning, turning], axis=1)

    def find_scale(self) -> float:
        """Return the torque in N m of one scene unit, so that the longest arrow has `LENGTH`."""
        longest = max(float(np.linalg.norm(part, axis=1).max(initial=0.0)) for part in self[:-1])
        return float(f"{longest / LENGTH:.2g}") or 1.0


def log_styles(stream: entities.Stream) -> None:
    """Log colours and labels of the arrows."""
    for name, arrow in ARROWS.items():
        stream.style_arrows(f"{entities.INERTIAL}/{name}", arrow.color, 0.010, arrow.label)


def send_arrows(stream: entities.Stream, stamps: Stamps, torques: Torques, scale: float) -> None:
    """Send the arrows at some of the stamps; a scale is the torque in N m of one scene unit."""
    step = find_step(stamps, RATE)
    _, body, turning, precession, _ = (part[::step] / scale for part in torques)
    pivot = np.zeros_like(body)
    placed = {
        "body": (pivot, body),
        "turning": (body, turning),
        "precession": (pivot, precession),
    }
    for name, (tails, vectors) in placed.items():
        along, up = ARROWS[name].place
        stream.send_arrows(
            f"{entities.INERTIAL}/{name}",
            stamps[::step],
            vectors,
            places=along * torques.nodes[::step] + [0.0, 0.0, up],
            origins=tails - [0.0, 0.0, ARROWS[name].depth],
        )


class FictitiousView:
    """The arrows of the torques in the precessing frame."""

    def __init__(self, stream: entities.Stream) -> None:
        self._stream = stream
        self._top: Top | None = None
        self._scale = 1.0  # N m of one scene unit
        for name, color in COLORS.items():
            stream.style_arrows(f"{entities.FICTITIOUS}/{name}", color, 0.010, name)

    def follow(self, top: Top, state: State) -> dict[str, str]:
        """Take over the motion that begins with a state; return what the panel says of it."""
        self._top = top
        self._scale = find_scale(top, state)
        return {"in the precessing frame": f"{EQUATION}, 1 unit {self._scale:g} N m"}

    def remove(self) -> None:
        """Remove the arrows: which top moves from the current time on is not known."""
        self._top = None
        self._stream.log(entities.FICTITIOUS, rr.Clear(recursive=True))

    def send(self, euler: Columns) -> None:
        """Send the arrows at some of the stamps, if the top is known."""
        if self._top is None:
            return
        step = find_step(euler.stamps, RATE)
        stamps, numbers = euler.stamps[::step], euler.numbers[::step]
        # other numbers were not published by a node
        sound = (np.abs(numbers) <= MAX_RATE).all(axis=1)
        stamps = stamps[sound]
        phi, theta, _, phi_dot, _, psi_dot = numbers[sound].T
        torques = precessing_frame_torques(self._top, theta, phi_dot, psi_dot)
        for name, (origins, vectors) in place_arrows(torques, phi, self._scale).items():
            # The label of an arrow without length has no place: it would be read as a torque.
            along = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
            self._stream.send_arrows(
                f"{entities.FICTITIOUS}/{name}",
                stamps,
                vectors,
                places=origins + vectors + GAP * along + [0.0, 0.0, RAISED],
                origins=origins,
            )


def torques_of(top: Top, state: State) -> FrameTorques:
    """Return the torques of a state; zero on the vertical, where phi' is undefined."""
    return precessing_frame_torques(
        top, state.euler_angles.theta, state.euler_rates.phi_dot, state.euler_rates.psi_dot
    )


def find_scale(top: Top, state: State) -> float:
    """Return the torque in N m of one scene unit, for the motion that begins with a state."""
    largest = max(abs(top.Mgl), *(float(np.abs(each)) for each in torques_of(top, state)))
    return float(f"{largest / HIGHEST:.2g}") or 1.0


def place_arrows(torques: FrameTorques, phi: Real, scale: float) -> dict[str, tuple[Real, Real]]:
    """Return origins and vectors, each (..., 3), of each arrow.

    Near the vertical phi' has no bound: where an arrow is too long, all four have no length.
    """
    nodes = nodes_of(phi)
    ends = np.cumsum([np.zeros_like(torques.gravity), *torques], axis=0) / scale
    lengths = np.array([*np.diff(ends, axis=0), ends[-1]])
    is_drawn = np.abs(lengths).max(axis=0) <= LONGEST  # nan is not
    tails = np.array([*ends[:-1], ends[0]])
    placed = {}
    for (name, depth), tail, length in zip(DEPTHS.items(), tails, lengths, strict=True):
        along, vector = (
            np.where(is_drawn, each, 0.0)[..., None] * nodes for each in (tail, length)
        )
        placed[name] = (along - [0.0, 0.0, depth], vector)
    return placed
