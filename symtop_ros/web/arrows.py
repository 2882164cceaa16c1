"""Arrows of the scene, each with its label; a frame only sets their attributes."""

import math
from typing import Literal

import numpy as np
from viser import SceneApi

from symtop_ros.arrays import Real

Color = tuple[int, int, int]
Side = Literal["bottom-left", "center-right", "center-center", "top-center"]
ZERO = np.zeros(3)
SHORTEST = 0.02  # scene units; shorter arrows have no direction that can be seen
LABEL_GAP, MIDDLE_GAP = 0.06, 0.2  # from an arrow to the edge of its label, and to its middle


class Arrow:
    """An arrow below a node of the scene, with a label at its end if it has a side for it."""

    def __init__(
        self, scene: SceneApi, node: str, color: Color, name: str = "", side: Side = "top-center"
    ) -> None:
        self.handle = scene.add_arrows(
            f"{node}/arrow",
            np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]),
            color,
            shaft_radius=0.013,
            head_radius=0.035,
            head_length=0.1,
            visible=False,
        )
        # In the world and not in the frame of the arrow: viser places a label by the pose that its
        # parent had in the frame before.
        self._gap = MIDDLE_GAP if side == "center-center" else LABEL_GAP
        self.label = None
        if name:
            self.label = scene.add_label(f"{node}/name", name, anchor=side, visible=False)
        # What was drawn last: viser takes 30 us for an attribute that has not changed.
        self._visible, self._length, self._origin = False, 0.0, ZERO

    def draw(self, vector: Real, origin: Real = ZERO) -> None:
        """Draw a vector (3,) from an origin (3,); one that is too short is hidden."""
        length = math.hypot(*vector.tolist())
        self._show(length > SHORTEST)
        if not self._visible:
            return
        self._point(vector, length)
        if origin is not self._origin:
            self.handle.position = self._origin = origin
        if self.label:
            self.label.position = origin + vector * (1 + self._gap / length)

    def _show(self, visible: bool) -> None:
        if visible != self._visible:
            self.handle.visible = self._visible = visible
            if self.label:
                self.label.visible = visible

    def _point(self, vector: Real, length: float) -> None:
        """Turn the arrow, which is along z, into a vector (3,).

        The pose of a node is drawn in the next frame. A change of its points takes the browser
        longer, and the arrow would trail behind the top: they have the length only, which hardly
        changes.
        """
        x, y, z = (vector / length).tolist()
        half = math.acos(min(max(z, -1.0), 1.0)) / 2
        across = math.hypot(x, y) or 1.0
        size = math.sin(half) / across
        self.handle.wxyz = (math.cos(half), -size * y, size * x, 0.0)
        if round(length, 2) != self._length:
            self._length = round(length, 2)
            self.handle.points = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, self._length]]])
