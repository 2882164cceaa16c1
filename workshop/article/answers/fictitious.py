"""Claims on fictitious forces: what an observer who turns with the precession, or the top, adds.

A body of point masses stands for the top: each of its four rings of four masses has its place and
its velocity, and the forces on them know nothing of moments of inertia.
"""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, new_figure
from symtop_ros.physics import Motion, Top, precessing_frame_torques, theta_acceleration
from workshop.article.claims import Measured, claim, differ
from workshop.article.motions import FAST, PSI_DOT, SLOW, THETA, TOP, start

PHI_DOTS = (SLOW, 9.0, FAST, 73.0)  # rad/s; both roots, and a rate beyond each
CORNERS = np.arange(4) * math.pi / 2  # rad
SUMMED = 4e-15  # of the largest torque; sums of 16 products of four factors. Measured: 1e-15
SHOWN = np.linspace(0.0, 85.0, 200)  # rad/s
SWEEP = np.linspace(0.0, 2 * math.pi, 200)  # rad


@claim()
def three_torques_raise_or_lower(top: Top) -> Measured:
    """Check that the three torques are Ix theta'' of the closed form, with the signs of Perry's."""
    rates = np.array(PHI_DOTS)
    torques = precessing_frame_torques(top, THETA, rates, PSI_DOT)
    expected = top.Ix * theta_acceleration(top, THETA, rates, PSI_DOT)
    off = float(np.abs(torques.total - expected).max() / np.abs(torques.coriolis).max())
    balanced = np.abs(torques.total[[0, 2]]).max() / np.abs(torques.coriolis).max()
    signs = torques.total[1] < 0 < torques.total[3]
    listed = "; ".join(
        f"{rate:.3f} rad/s: {a:+.5f} {b:+.5f} {c:+.5f} = {a + b + c:+.5f} N m"
        for rate, a, b, c in zip(rates, *torques, strict=True)
    )
    return Measured(off < SUMMED and balanced < SUMMED and signs, listed=listed)


@claim()
def masses_feel_the_same(top: Top) -> Measured:
    """Check the Coriolis and the centrifugal torque as sums over mass elements."""
    masses, places = point_masses(top)
    largest = 0.0
    for phi_dot in PHI_DOTS:
        state = start(phi_dot)
        frame = state.to_body(np.array([0.0, 0.0, phi_dot]))  # omega of the precessing frame
        node = state.to_body(np.array([1.0, 0.0, 0.0]))  # of nodes: phi = 0
        moving = np.cross([0.0, 0.0, PSI_DOT], places)  # velocities in that frame
        forces = (-2 * np.cross(frame, moving), -np.cross(frame, np.cross(frame, places)))
        summed = [float(masses @ (np.cross(places, force) @ node)) for force in forces]
        torques = precessing_frame_torques(top, THETA, phi_dot, PSI_DOT)
        expected = float(torques.coriolis), float(torques.centrifugal)
        scale = max(map(abs, expected))
        largest = max(largest, *(abs(a - b) / scale for a, b in zip(summed, expected, strict=True)))
    return Measured(largest < SUMMED, count=len(masses), rates=len(PHI_DOTS), largest=largest)


@claim()
def body_frame_has_one(top: Top) -> Measured:
    """Check that in the body frame nothing moves, and the centrifugal torque is -omega x L."""
    masses, places = point_masses(top)
    state = Motion(top, start(9.0)).at(0.02)
    omega = state.angular_velocity
    summed = masses @ np.cross(places, -np.cross(omega, np.cross(omega, places)))
    expected = -np.cross(omega, top.body_angular_momentum(state))
    off = differ(summed, expected)
    return Measured(off < SUMMED, size=np.linalg.norm(expected), count=len(masses), off=off)


def point_masses(top: Top) -> tuple[Real, Real]:
    """Return masses (n,) in kg and places (n, 3) in m with the moments of inertia of a top.

    Rings of four masses at a height z have Iz = m a^2 and Ix = m (a^2/2 + z^2); two rings above and
    two below the pivot, of different sizes, together have those of the top.
    """
    rings = [(radius, sign) for radius in (0.02, 0.05) for sign in (1.0, -1.0)]
    spread = top.Ix / top.Iz - 0.5  # of z^2 to a^2
    masses, places = [], []
    for radius, sign in rings:
        height = sign * radius * math.sqrt(spread)
        for corner in CORNERS:
            masses.append(top.Iz / len(rings) / len(CORNERS) / radius**2)
            places.append((radius * math.cos(corner), radius * math.sin(corner), height))
    return np.array(masses), np.array(places)


def draw_fictitious_torques() -> Figure:
    """Draw the three torques and their sum against the precession rate."""
    figure = new_figure(3.9)
    axes = figure.subplots()
    plot_torques(axes)
    axes.plot([SLOW, FAST], [0.0, 0.0], "o", color=INK, ms=7, zorder=3)
    axes.set_title(f"dots: the roots, {SLOW:.2f} and {FAST:.1f} rad/s", loc="right")
    axes.legend(loc="upper left")
    return figure


def plot_torques(axes: Axes) -> None:
    """Plot the three torques and their sum against the precession rate."""
    torques = precessing_frame_torques(TOP, THETA, SHOWN, PSI_DOT)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.plot(SHOWN, torques.gravity, color=GREY, ls=":", label="gravity: lowers")
    label = r"Coriolis: raises, as $\dot\phi$"
    axes.plot(SHOWN, torques.coriolis, color=BLUE, ls="--", label=label)
    label = r"centrifugal: lowers, as $\dot\phi^2$"
    axes.plot(SHOWN, torques.centrifugal, color=RED, ls="-.", label=label)
    axes.plot(SHOWN, torques.total, color=INK, label=r"sum, $I_x \ddot\theta$")
    axes.set(xlabel=r"$\dot\phi$ (rad/s)", ylabel="torque about the line of nodes (N m)", xmargin=0)


def draw_four_masses() -> Figure:
    """Draw four masses, after Barker: the Coriolis forces on a ring that spins and precesses.

    The ring is seen from the end of the axle, the line of nodes to the right. In the precessing
    frame a mass moves along the ring; the part of Omega across the axis, upwards here, makes a
    force along the axis in proportion to its velocity along the line of nodes.
    """
    figure = new_figure(4.2)
    axes = figure.subplots()
    axes.plot(np.cos(SWEEP), np.sin(SWEEP), color=GREY, lw=1.5)
    axes.axhline(0.0, color=INK, lw=0.9, ls=":")
    axes.text(2.25, 0.07, "line of nodes $N$", ha="right")
    draw_arrow(axes, (0, 0), (0, 0.62), INK)
    axes.text(0.06, 0.4, r"$\dot\phi \sin\theta$, up")
    for x, y in zip(np.cos(CORNERS), np.sin(CORNERS), strict=True):
        draw_arrow(axes, (x, y), (x - 0.5 * y, y + 0.5 * x), BLUE)
        axes.plot(x, y, "o", color=INK, ms=9)
        if abs(y) > abs(x):  # it moves along the line of nodes
            mark = r"$\otimes$ to the pivot" if y > 0 else r"$\odot$ away from the pivot"
            axes.text(x + 0.12, y + 0.12 * np.sign(y), mark, color=RED, va="center")
    for y, reach, color, name in ((-0.2, 0.6, GOLD, "gravity's"), (-0.5, -0.6, RED, "Coriolis'")):
        draw_arrow(axes, (0, y), (reach, y), color)
        side = "right" if reach > 0 else "left"
        axes.text(-0.1 * reach, y, f"{name} torque", va="center", ha=side)
    view = "Seen from the end of\nthe axle: the pivot is\nbehind the ring."
    axes.text(-2.25, 1.35, view, va="top")
    words = "blue: velocity\nred: Coriolis force;\nits torque raises the axis,\ngravity's lowers it"
    axes.text(-2.25, -1.35, words, va="bottom")
    axes.set(xlim=(-2.3, 2.3), ylim=(-1.4, 1.4), aspect="equal")
    axes.axis("off")
    return figure


def draw_arrow(
    axes: Axes, tail: tuple[float, float], tip: tuple[float, float], color: str, width: float = 1.6
) -> None:
    """Draw an arrow from one place to another."""
    look = {"arrowstyle": "-|>", "color": color, "shrinkA": 0, "shrinkB": 0, "lw": width}
    axes.annotate("", tip, tail, arrowprops=look)
