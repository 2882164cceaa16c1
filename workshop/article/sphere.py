"""A 3D view of the curve that the end of the axis draws on the unit sphere."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from symtop_ros.arrays import Real
from symtop_ros.judge.figures import BLUE, GOLD, GREY, INK, RED, new_figure
from symtop_ros.physics import Motion
from symtop_ros.playback.view.entities import draw_meridian, draw_parallel
from workshop.article.motions import precession_period

Axes3D = Any  # matplotlib has no types for its 3D axes
ELEVATION, AZIMUTH = 34.0, -52.0  # degrees, of the line of sight
UP, AROUND_UP = np.radians(ELEVATION), np.radians(AZIMUTH)
EYE = np.array([np.cos(UP) * np.cos(AROUND_UP), np.cos(UP) * np.sin(AROUND_UP), np.sin(UP)])
COUNT = 181  # points of a circle
POINTS = 3000
ROUNDING = 1e-9  # rad; turning angles closer than this count as equal
GRID, FAR = "#b4bac3", "#e4e7ea"
SLACK = 0.03  # so that lines of the near side reach the outline
REACH = 1.12  # half the side of the drawn cube, in radii of the sphere
TORQUE_LENGTH = 0.55  # of the torque's arrow, in radii


def draw_sphere(motion: Motion) -> Figure:
    """Draw the axis over one turn of its precession, with L and gravity's torque at the start."""
    figure = new_figure(4.5, 5.4)
    figure.set_layout_engine("none")
    axes: Axes3D = figure.add_axes((-0.12, -0.3, 1.24, 1.488), projection="3d")
    axes.view_init(ELEVATION, AZIMUTH)
    axes.set_proj_type("ortho")
    axes.set_axis_off()
    axes.computed_zorder = False
    _draw_globe(axes)
    _draw_axis(axes, motion)
    _draw_vectors(axes, motion)
    side, upwards = (-REACH, REACH), (-REACH + 0.5, REACH + 0.5)
    axes.set(xlim=side, ylim=side, zlim=upwards, box_aspect=(1, 1, 1))
    axes.legend(loc="upper left", bbox_to_anchor=(0.11, 0.872), handlelength=1.8)
    return figure


def _draw_globe(axes: Axes3D) -> None:
    """Draw circles every 15 degrees of tilt, meridians every 30, the outline, and the axes."""
    for tilt in np.radians(np.arange(15, 91, 15)):
        _grid(axes, draw_parallel(tilt, COUNT))
    for phi in np.radians(np.arange(0, 180, 30)):
        _grid(axes, draw_meridian(phi, np.pi / 2, 91))
    _line(axes, _outline(), color=GREY, lw=0.9)
    for name, end in (("x", (1.25, 0, 0)), ("y", (0, 1.42, 0)), ("z", (0, 0, 1.3))):
        _line(axes, np.array([(0, 0, 0), end]), color=GREY, lw=0.9)
        axes.text(*(1.06 * np.array(end)), f"${name}'$", ha="center", va="center")


def _grid(axes: Axes3D, points: Real) -> None:
    """Draw a line on the sphere, fainter on the far side."""
    near = (points @ EYE > -SLACK)[:, None]
    _line(axes, np.where(near, points, np.nan), color=GRID, lw=0.8)
    _line(axes, np.where(near, np.nan, points), color=FAR, lw=0.7)


def _draw_axis(axes: Axes3D, motion: Motion) -> None:
    low, high = motion.turning_angles
    if high - low > ROUNDING:
        circles = [draw_parallel(angle, COUNT) for angle in (low, high)]
        _line(axes, circles[0], color=RED, lw=1.1, ls="--", label="turning angles")
        _line(axes, circles[1], color=RED, lw=1.1, ls="--")
    times = np.linspace(0.0, precession_period(motion), POINTS)
    ends = motion.at(times).to_world([0.0, 0.0, 1.0])
    _line(axes, ends, color=INK, lw=2.0, label="end of the top's axis, one turn")


def _draw_vectors(axes: Axes3D, motion: Motion) -> None:
    """Draw the axis, L and the torque from the pivot; only the directions of L and torque count."""
    state = motion.start
    momentum, torque = motion.top.angular_momentum(state), motion.top.gravity_torque(state)
    axis = state.to_world([0.0, 0.0, 1.0])
    _line(axes, np.stack([np.zeros(3), axis]), color=INK, lw=1.2)
    for vector, length, color, label in (
        (momentum, 1.2, BLUE, "$L$ at the start (direction)"),
        (torque, TORQUE_LENGTH, GOLD, "gravity's torque (direction)"),
    ):
        tip = length * vector / np.linalg.norm(vector)
        look = {"color": color, "lw": 2.4, "arrow_length_ratio": 0.12, "zorder": 4}
        axes.quiver(0, 0, 0, *tip, label=label, **look)


def _line(axes: Axes3D, points: Real, **style: Any) -> None:
    axes.plot(*points.T, **style)


def _outline() -> Real:
    """Return the outline of the sphere above the horizon, as seen from `EYE`."""
    side = np.cross([0.0, 0.0, 1.0], EYE)
    side /= np.linalg.norm(side)
    half = np.linspace(0.0, np.pi, COUNT)[:, None]
    return np.asarray(np.cos(half) * side + np.sin(half) * np.cross(EYE, side))
