"""Figures in space: the top with Euler's angles (Fig. 1), and its axis on the unit sphere."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, PALE, RED, new_figure
from symtop_ros.physics import Motion, State
from symtop_ros.replay.view.entities import draw_meridian, draw_parallel
from workshop.article.answers.fictitious import draw_arrow

Axes3D = Any  # matplotlib has no types for its 3D axes
SIGHT = 34.0, -52.0  # elevation and azimuth of the line of sight in degrees
COUNT = 181  # points of a circle
POINTS = 3000
ROUNDING = 1e-9  # rad; turning angles closer than this count as equal
GRID, FAR = "#b4bac3", "#e4e7ea"
SLACK = 0.03  # so that lines of the near side reach the outline
REACH = 1.12  # half the side of the drawn cube, in radii of the sphere
TORQUE_LENGTH = 0.55  # of the torque's arrow, in radii
PHI, THETA, PSI = 1.0, 0.6, 0.9  # rad; such that nothing hides another
RADII = {"phi": 0.62, "theta": 0.85, "psi": 0.5}  # of the arcs
RATE = 0.3  # length of the arrows of the rates
ROTOR = ((0.34, 0.52), (0.34, 0.60))  # radius and height of both rims
BEYOND = 1.09


def look_from(elevation: float, azimuth: float) -> Real:
    """Return the direction towards an eye, from its angles in degrees."""
    up, around = np.radians(elevation), np.radians(azimuth)
    return np.array([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)])


EYE = look_from(*SIGHT)  # of the sphere
TOWARDS = look_from(22.0, 20.0)  # of the top
RIGHT = np.cross([0.0, 0.0, 1.0], TOWARDS)
RIGHT /= np.linalg.norm(RIGHT)
PROJECTION = np.stack([RIGHT, np.cross(TOWARDS, RIGHT)], axis=1)  # to the plane of the picture


def draw_euler_angles() -> Figure:
    """Draw a top with phi, theta and psi, as the article defines them."""
    figure = new_figure(4.1, 5.4)
    axes = figure.subplots()
    body = State.from_euler(phi=PHI, theta=THETA, psi=PSI)
    # the frame of the line of nodes, between both: it has turned by phi and theta only
    nodes = State.from_euler(phi=PHI, theta=THETA)
    _draw_top(axes, body)
    _draw_axes(axes, np.eye(3), "'", GREY)
    _draw_axes(axes, body.to_world(np.eye(3)), "", INK)
    line = nodes.to_world([1.0, 0.0, 0.0])
    _plot(axes, np.stack([-0.9 * line, 1.05 * line]), color=RED, ls="--", lw=1.2)
    _write(axes, 1.12 * line, "$N$", RED)
    _draw_arcs(axes, nodes)
    axles = {"phi": np.eye(3)[2], "theta": line, "psi": nodes.to_world([0.0, 0.0, 1.0])}
    for name, direction in axles.items():
        start = direction * (1.15 if name != "theta" else 0.62)
        _arrow(axes, start, start + RATE * direction, GOLD)
        _write(axes, start + 0.6 * RATE * direction + [0, 0.12, 0.02], rf"$\dot\{name}$", INK)
    axes.set(aspect="equal", xlim=(-1.25, 1.3), ylim=(-0.5, 1.55))
    axes.set_axis_off()
    return figure


def _draw_top(axes: Axes, body: State) -> None:
    """Draw the rims of the rotor, its side, and the axle from the pivot."""
    x, y, z = body.to_world(np.eye(3))
    rims = [_circle(radius, x, y) + height * z for radius, height in ROTOR]
    for rim in rims:
        axes.fill(*(rim @ PROJECTION).T, facecolor=PALE, edgecolor=GREY, lw=1.0, zorder=1)
    for edge in _find_edges(rims[0]):
        _plot(axes, np.stack([np.zeros(3), edge]), color=GREY, lw=1.0, zorder=1)
    horizon = draw_parallel(np.pi / 2)
    _plot(axes, 0.95 * horizon, color=PALE, lw=0.9, zorder=0)


def _find_edges(rim: Real) -> Real:
    """Return the points of a rim at which lines from the pivot touch it in the picture."""
    flat = rim @ PROJECTION
    middle = flat.mean(axis=0)
    turned = np.arctan2(*flat.T) - np.arctan2(*middle)
    return np.asarray(rim[[np.argmin(turned), np.argmax(turned)]])


def _draw_axes(axes: Axes, ends: Real, mark: str, color: str) -> None:
    for end, letter in zip(ends, "xyz", strict=True):
        reach = 1.12 if letter == "z" else 1.0
        _arrow(axes, np.zeros(3), reach * end, color)
        # The rates are drawn beyond z and z': their letters stand at the side.
        place = reach * end - 0.1 * RIGHT if letter == "z" else BEYOND * reach * end
        _write(axes, place, f"${letter}{mark}$", color)


def _draw_arcs(axes: Axes, nodes: State) -> None:
    """Draw phi from x' to N, theta from z' to z, and psi from N to x."""
    x, y, z = np.eye(3)
    line, across, axis = nodes.to_world(np.eye(3))
    up = (axis - np.cos(THETA) * z) / np.sin(THETA)
    angles = (("phi", PHI, x, y), ("theta", THETA, z, up), ("psi", PSI, line, across))
    for name, angle, first, second in angles:
        arc = _circle(RADII[name], first, second, angle)
        _plot(axes, arc, color=BLUE, lw=1.6)
        _arrow(axes, arc[-2], arc[-1], BLUE)
        _write(axes, BEYOND * arc[len(arc) // 2] * 1.05, rf"$\{name}$", BLUE)


def _circle(radius: float, first: Real, second: Real, angle: float = 2 * np.pi) -> Real:
    """Return points (n, 3) of an arc from one unit vector towards a perpendicular one."""
    turns = np.linspace(0.0, angle, 61)[:, None]
    return np.asarray(radius * (np.cos(turns) * first + np.sin(turns) * second))


def _plot(axes: Axes, points: Real, **style: Any) -> None:
    axes.plot(*(points @ PROJECTION).T, **style)


def _arrow(axes: Axes, tail: Real, tip: Real, color: str) -> None:
    draw_arrow(axes, tail @ PROJECTION, tip @ PROJECTION, color, 1.4)


def _write(axes: Axes, place: Real, text: str, color: str) -> None:
    x, y = place @ PROJECTION
    axes.text(x, y, text, color=color, ha="center", va="center", fontsize=12)


def draw_sphere(motion: Motion) -> Figure:
    """Draw the axis over one turn of its precession, with L and gravity's torque at the start."""
    figure = new_figure(4.5, 5.4)
    figure.set_layout_engine("none")
    axes: Axes3D = figure.add_axes((-0.12, -0.3, 1.24, 1.488), projection="3d")
    axes.view_init(*SIGHT)
    axes.set_proj_type("ortho")
    axes.set_axis_off()
    axes.computed_zorder = False
    _draw_globe(axes)
    _draw_axis(axes, motion)
    _draw_vectors(axes, motion)
    side = (-REACH, REACH)
    upwards = (-REACH + 0.5, REACH + 0.5)
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
    times = np.linspace(0.0, motion.precession_period, POINTS)
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
