"""Fig. 1: the top, the axes of both frames, the line of nodes, Euler's angles and their rates."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.arrays import Real
from symtop_ros.judge.figures import BLUE, GOLD, GREY, INK, PALE, RED, new_figure
from symtop_ros.physics import State
from symtop_ros.playback.view.entities import draw_parallel

PHI, THETA, PSI = 1.0, 0.6, 0.9  # rad; such that nothing hides another
ELEVATION, AZIMUTH = np.radians(22.0), np.radians(20.0)  # of the line of sight
RIGHT = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
TOWARDS = np.array(
    [np.cos(ELEVATION) * np.cos(AZIMUTH), np.cos(ELEVATION) * np.sin(AZIMUTH), np.sin(ELEVATION)]
)
PROJECTION = np.stack([RIGHT, np.cross(TOWARDS, RIGHT)], axis=1)  # to the plane of the picture
RADII = {"phi": 0.62, "theta": 0.85, "psi": 0.5}  # of the arcs
RATE = 0.3  # length of the arrows of the rates
ROTOR = ((0.34, 0.52), (0.34, 0.60))  # radius and height of both rims
BEYOND = 1.09


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
    look = {"arrowstyle": "-|>", "color": color, "shrinkA": 0, "shrinkB": 0, "lw": 1.4}
    axes.annotate("", tip @ PROJECTION, tail @ PROJECTION, arrowprops=look)


def _write(axes: Axes, place: Real, text: str, color: str) -> None:
    x, y = place @ PROJECTION
    axes.text(x, y, text, color=color, ha="center", va="center", fontsize=12)
