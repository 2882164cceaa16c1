"""Arrows of the torques in the precessing frame: gravity's, Coriolis' and the centrifugal one."""

import numpy as np

from symtop_ros.drawing.fictitious import find_scale, place_arrows
from symtop_ros.log.batch import Columns
from symtop_ros.physics import State, Top, precessing_frame_torques
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import GOLD, RED, SKY, WHITE
from symtop_ros.playback.view.quantities import find_step
from symtop_ros.playback.view.stream import Stream
from symtop_ros.simulation.validation import MAX_RATE

RATE = 60.0  # arrows per s of the clock
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
