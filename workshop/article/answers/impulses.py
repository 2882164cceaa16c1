"""Why the top does not simply fall: the impulses of the torques about the line of nodes.

For an observer who precesses with the top Ix theta'' is the sum of gravity's, Coriolis' and the
centrifugal torque. So Ix theta' is the sum of their impulses since a cusp, where theta' is zero.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, new_figure, rows
from symtop_ros.physics import FrameTorques, Motion, precessing_frame_torques
from workshop.article.motions import cusps
from workshop.article.nutation import times_of_extreme_rate

MILLI = 1e3
# In a half nutation the torques are those of a few harmonics: 64 nodes leave rounding.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(64)
LOOKS = {
    "gravity": (GOLD, ":", "gravity: lowers"),
    "coriolis": (BLUE, "--", "Coriolis: raises"),
    "centrifugal": (RED, "-.", "centrifugal: lowers"),
}


def torques_at(motion: Motion, times: Real) -> Real:
    """Return gravity's, Coriolis' and the centrifugal torque (3, n) in N m at times in s."""
    states = motion.at(times)
    rates = states.euler_rates
    theta = states.euler_angles.theta
    return np.array(precessing_frame_torques(motion.top, theta, rates.phi_dot, rates.psi_dot))


def find_impulses(motion: Motion, time: float) -> FrameTorques:
    """Return the impulses of the torques from the start to a time in s, in N m s."""
    times = (NODES + 1) * time / 2
    return FrameTorques(*(torques_at(motion, times) @ WEIGHTS * time / 2))


def plot_impulses(axes: Axes, motion: Motion) -> None:
    """Plot the torques of half a nutation, with their areas filled, and their sum."""
    half = motion.nutation_period / 2
    times = np.linspace(0.0, half, 401)
    torques = torques_at(motion, times)
    found = find_impulses(motion, half)
    axes.axhline(0.0, color=INK, lw=0.9)
    for torque, (name, (color, dash, label)) in zip(torques, LOOKS.items(), strict=True):
        words = f"{label}, {MILLI * getattr(found, name):+.3f}"
        axes.fill_between(MILLI * times, torque, color=color, alpha=0.2, lw=0)
        axes.plot(MILLI * times, torque, color=color, ls=dash, label=words)
    axes.plot(MILLI * times, torques.sum(axis=0), color=INK, label=r"sum, $I_x\ddot\theta$")
    axes.set(xmargin=0, ylabel="torque (N m)")
    axes.legend(loc="lower left", fontsize=8, title=r"torque, and its impulse in $10^{-3}$ N m s")


def draw_impulses() -> Figure:
    """Draw the torques of one fall with their impulses, and theta', which is their sum over Ix."""
    figure = new_figure(5.6)
    motion = cusps()
    upper, lower = rows(figure, 2)
    plot_impulses(upper, motion)
    half = motion.nutation_period / 2
    times = np.linspace(0.0, half, 401)
    lower.plot(MILLI * times, motion.at(times).euler_rates.theta_dot, color=INK)
    lower.set(xmargin=0, xlabel="$t$ (ms)", ylabel=r"$\dot\theta$ (rad/s)")
    fastest, _ = times_of_extreme_rate(motion)
    for axes in (upper, lower):
        axes.axvline(MILLI * fastest, color=GREY, lw=0.9, ls=":")
    upper.set_title(f"dotted: {MILLI * fastest:.1f} ms, where it falls fastest", loc="right")
    return figure
