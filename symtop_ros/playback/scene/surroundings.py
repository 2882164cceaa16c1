"""What the top stands in: the unit sphere, a stand, the line of nodes and the turning circles."""

from __future__ import annotations

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from symtop_ros.playback.scene import paths
from symtop_ros.playback.scene.colors import GREY, ORANGE
from symtop_ros.playback.scene.mesh import lathe

Real = NDArray[np.float64]
STONE = (92, 98, 110)
STONES = (STONE, STONE)
STAND = ((0.0, -0.02), (0.03, -0.03), (0.05, -0.22), (0.17, -0.28), (0.17, -0.32), (0.0, -0.32))[
    ::-1
]
AROUND = np.linspace(0, 2 * np.pi, 97)


def draw(recording: rr.RecordingStream, low: bool) -> None:
    """Log the sphere, and above it a stand, unless the axis goes below the pivot."""
    tilts = np.pi / 12 * np.arange(1, 12 if low else 7)
    depth = np.pi if low else np.pi / 2
    meridians = [_meridian(turn, depth) for turn in np.pi / 6 * np.arange(6)]
    sphere = [_parallel(tilt) for tilt in tilts] + meridians
    recording.log(paths.SPHERE, rr.LineStrips3D(sphere, colors=[GREY], radii=[0.0014]))
    recording.log(paths.STAND, rr.Clear(recursive=False) if low else lathe(STAND, STONES).drawn())


def circles(turning_angles: tuple[float, float]) -> rr.LineStrips3D:
    """Return the circles between which the axis nutates."""
    lines = [_parallel(angle) for angle in turning_angles]
    return rr.LineStrips3D(lines, colors=[ORANGE], radii=[0.004])


def line_of_nodes(phi: Real) -> Real:
    """Return the line from -0.4 to 0.4 along (cos phi, sin phi, 0), for each phi: (n, 2, 3)."""
    end = 0.4 * np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=1)
    return np.stack([-end, end], axis=1)


def _parallel(theta: float) -> Real:
    rim = np.sin(theta) * np.stack([np.cos(AROUND), np.sin(AROUND)], axis=1)
    return np.column_stack([rim, np.full(len(rim), np.cos(theta))])


def _meridian(phi: float, depth: float) -> Real:
    """From one side to the other over the pole, down to a tilt on both."""
    tilts = np.linspace(-depth, depth, 97)
    side = np.sin(tilts)
    return np.column_stack([np.cos(phi) * side, np.sin(phi) * side, np.cos(tilts)])
