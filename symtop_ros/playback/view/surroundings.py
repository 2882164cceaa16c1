"""The surroundings of the top: unit sphere, stand, line of nodes, turning circles and trace.

The trace of the axis on the sphere is one short line per sample, visible for some time.
"""

import math

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real, Stamps
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import GREY, ORANGE, STONE
from symtop_ros.playback.view.mesh import Mesh, create_lathe, draw_meridian, draw_parallel
from symtop_ros.playback.view.quantities import nodes_of
from symtop_ros.playback.view.stream import Stream

MAX_LINES = 3000  # visible at one time
MAX_GAP = 5  # sample periods; longer gaps are not bridged by a line
STAND = ((0.0, -0.02), (0.03, -0.03), (0.05, -0.22), (0.17, -0.28), (0.17, -0.32), (0.0, -0.32))[
    ::-1
]


def log_surroundings(stream: Stream, below_pivot: bool) -> None:
    """Log the upper half of the sphere and a stand; the whole sphere if the axis goes below."""
    tilts = np.pi / 12 * np.arange(1, 12 if below_pivot else 7)
    depth = np.pi if below_pivot else np.pi / 2
    meridians = [draw_meridian(turn, depth) for turn in np.pi / 6 * np.arange(6)]
    sphere = [*map(draw_parallel, tilts), *meridians]
    stream.log(entities.SPHERE, rr.LineStrips3D(sphere, colors=[GREY], radii=[0.0014]))
    if below_pivot:
        stream.log(entities.STAND, rr.Clear(recursive=False))
    else:
        stream.log_mesh(entities.STAND, create_stand())


def create_stand() -> Mesh:
    """Return the stand below the pivot."""
    return create_lathe(STAND, (STONE, STONE))


def turning_circles(
    turning_angles: tuple[float, float], color: tuple[int, int, int] = ORANGE
) -> rr.LineStrips3D:
    """Return the circles between which the axis nutates."""
    return rr.LineStrips3D([*map(draw_parallel, turning_angles)], colors=[color], radii=[0.004])


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
        step = self._step(stamps)
        stamps, points = stamps[::step], points[::step]
        self._stamps, self._points = stamps[-1:], points[-1:]
        lasted = np.diff(stamps)
        near = (lasted > 0) & (lasted <= MAX_GAP * np.median(lasted)) if len(lasted) else lasted > 0
        return stamps[1:][near], np.stack([points[:-1], points[1:]], axis=1)[near]

    def _step(self, stamps: Stamps) -> int:
        """Return how many samples a line spans, so that at most `MAX_LINES` are visible."""
        if len(stamps) < 2:
            return 1
        period = float(np.median(np.diff(stamps))) * 1e-9
        return max(1, math.ceil(self.length / max(period, 1e-9) / MAX_LINES))
