"""Arrows of the inertial torque: which part of the torque changes L, seen from which frame.

In the body frame torque = dL/dt + omega x L. In the frame of the line of nodes, which follows the
precession alone, torque = dL/dt + phi' z' x L, and in regular precession dL/dt is zero there. The
arrows lie below and above the pivot, so that those along one line do not hide each other: omega x L
begins below the tip of dL/dt and ends below the tip of the torque.
"""

from typing import NamedTuple

import numpy as np

from symtop_ros.arrays import Real, Stamps
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import BLUE, GOLD, GREEN
from symtop_ros.playback.view.quantities import ColumnsByTopic, find_step, join, nodes_of
from symtop_ros.playback.view.stream import Stream

RATE = 60.0  # arrows per s of the clock
LENGTH = 0.9  # of the longest arrow in scene units
EQUATIONS = {
    "in the body frame": "torque = dL/dt + \u03c9 x L",
    "in the frame of the nodes": "torque = dL/dt + \u03c6' z' x L",
}


class TorqueArrow(NamedTuple):
    """An arrow below or above the pivot."""

    label: str
    color: tuple[int, int, int]
    depth: float  # below the pivot, in scene units; negative above it
    # of the label: along the line of nodes, and up. It is fixed, so that labels stay apart
    # when the arrows are short, as at cusps
    place: tuple[float, float]


ARROWS = {
    "body": TorqueArrow("dL/dt (body)", GREEN, 0.10, (1.15, 0.0)),
    "turning": TorqueArrow("\u03c9 x L (body)", BLUE, 0.20, (0.2, -0.22)),
    "precession": TorqueArrow("\u03c6' z' x L (nodes)", GOLD, -0.10, (-0.9, 0.12)),
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
        total, turning = torque[:, 3:], np.cross(velocity[:, 3:], L)
        across = np.stack([-L[:, 1], L[:, 0], np.zeros(len(L))], axis=1)  # z' x L
        precession = euler[:, 3:4] * across
        return stamps, cls(total, total - turning, turning, precession, nodes_of(euler[:, 0]))

    def along_nodes(self) -> Real:
        """Return the components of torque, dL/dt (body) and omega x L along the nodes, (n, 3)."""
        total, turning = (
            (vectors * self.nodes).sum(axis=1) for vectors in (self.total, self.turning)
        )
        return np.stack([total, total - turning, turning], axis=1)

    def find_scale(self) -> float:
        """Return the torque in N m of one scene unit, so that the longest arrow has `LENGTH`."""
        parts = self[:-1]
        longest = max(float(np.linalg.norm(part, axis=1).max(initial=0.0)) for part in parts)
        return float(f"{longest / LENGTH:.2g}") or 1.0


def log_styles(stream: Stream) -> None:
    """Log colours and labels of the arrows."""
    for name, arrow in ARROWS.items():
        stream.style_arrows(f"{entities.INERTIAL}/{name}", arrow.color, 0.010, arrow.label)


def send_arrows(stream: Stream, stamps: Stamps, torques: Torques, scale: float) -> None:
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
        origins = tails - [0.0, 0.0, ARROWS[name].depth]
        along, up = ARROWS[name].place
        places = along * torques.nodes[::step] + [0.0, 0.0, up]
        stream.send_arrows(f"{entities.INERTIAL}/{name}", stamps[::step], vectors, places, origins)
