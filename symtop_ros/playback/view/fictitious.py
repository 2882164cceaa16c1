"""Arrows of the torques in the precessing frame: along the line of nodes, head to tail.

They are gravity's, Coriolis' and the centrifugal one. Each of the three begins below the tip of the
one before. So the third ends below the pivot if the precession is steady, and the fourth, their
sum, has no length. They lie at different depths below the pivot, and their sum above it, so that
none hides another.
"""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.log.batch import Columns
from symtop_ros.physics import FrameTorques, State, Top, precessing_frame_torques
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import GOLD, RED, SKY, WHITE
from symtop_ros.playback.view.quantities import find_step
from symtop_ros.playback.view.stream import Stream
from symtop_ros.simulation.validation import MAX_RATE

RATE = 60.0  # arrows per s of the clock
DEPTHS = {"gravity": 0.08, "Coriolis": 0.15, "centrifugal": 0.22, "sum": -0.08}  # below the pivot
LENGTH, LONGEST = 1.0, 2.5  # in scene units: of the largest at the start, and of any
GAP, RAISED = 0.3, 0.05  # of labels: beyond the tip, and up; the viewer draws them below a point
COLORS = {"gravity": RED, "Coriolis": SKY, "centrifugal": GOLD, "sum": WHITE}
EQUATION = "Ix \u03b8'' = gravity + Coriolis + centrifugal"


class FictitiousView:
    """The arrows of a recording."""

    def __init__(self, stream: Stream) -> None:
        self._stream = stream
        self._top: Top | None = None
        self._scale = 1.0  # N m of one scene unit
        for name, color in COLORS.items():
            stream.style_arrows(f"{entities.FICTITIOUS}/{name}", color, 0.010, name)

    def follow(self, top: Top, state: State) -> dict[str, str]:
        """Take over the motion that begins with a state; return what the panel says of it."""
        self._top, self._scale = top, find_scale(top, state)
        return {"in the precessing frame": f"{EQUATION}, 1 unit {self._scale:g} N m"}

    def send(self, euler: Columns) -> None:
        """Send the arrows at some of the stamps; before the first event the top is unknown."""
        if self._top is None:
            return
        step = find_step(euler.stamps, RATE)
        stamps, numbers = euler.stamps[::step], euler.numbers[::step]
        sound = (np.abs(numbers) <= MAX_RATE).all(axis=1)  # others are of no node
        stamps = stamps[sound]
        phi, theta, _, phi_dot, _, psi_dot = numbers[sound].T
        torques = precessing_frame_torques(self._top, theta, phi_dot, psi_dot)
        for name, (origins, vectors) in place_arrows(torques, phi, self._scale).items():
            # The label of an arrow without length has no place: it would be read as a torque.
            along = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
            places = origins + vectors + GAP * along + [0.0, 0.0, RAISED]
            self._stream.send_arrows(
                f"{entities.FICTITIOUS}/{name}", stamps, vectors, places, origins
            )


def torques_of(top: Top, state: State) -> FrameTorques:
    """Return the torques of a state; zero on the vertical, where phi' is undefined."""
    return precessing_frame_torques(
        top, state.euler_angles.theta, state.euler_rates.phi, state.euler_rates.psi
    )


def find_scale(top: Top, state: State) -> float:
    """Return the torque in N m of one scene unit, for the motion that begins with a state."""
    largest = max(abs(top.Mgl), *(float(np.abs(each)) for each in torques_of(top, state)))
    return float(f"{largest / LENGTH:.2g}") or 1.0


def place_arrows(torques: FrameTorques, phi: Real, scale: float) -> dict[str, tuple[Real, Real]]:
    """Return origins and vectors, each (..., 3), of each arrow.

    Near the vertical phi' has no bound: where an arrow is too long, all four have no length.
    """
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
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
