"""Nutation, after Butikov: a point on a circle that moves along.

E. I. Butikov, "Precession and nutation of a gyroscope", European Journal of Physics 27 (2006) 1071:
nutation is the free precession of a top without torque, on top of the precession that the torque
forces. Seen by who turns with the mean precession, the end of the axis goes round on a circle.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, GREY, INK, RED, new_figure, rows
from symtop_ros.physics import Motion
from workshop.article.motions import accelerations, cusps
from workshop.article.nutation import times_of_extreme_rate

SHOWN = (0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)  # of a nutation: places of the circle


class Nutation(NamedTuple):
    """The way of the axis seen by who turns with the mean precession, about its middle, in rad."""

    across: Real  # along the precession
    down: Real
    radius: float
    rate: float  # of the nutation, rad/s
    free_rate: float  # L/Ix, of the free precession with the same p_psi
    drift: float  # of the middle, rad/s along its parallel


def find_nutation(motion: Motion, times: Real) -> Nutation:
    """Return the way of the axis at times of one nutation that begins at a cusp."""
    angles = motion.at(times).euler_angles
    low, high = motion.turning_angles
    middle = (low + high) / 2
    mean = float(motion.mean_precession_rate)
    # At the cusp and half a nutation later the axis is right above and below its middle.
    across = np.sin(middle) * (np.unwrap(angles.phi) - mean * times)
    return Nutation(
        across,
        angles.theta - middle,
        (high - low) / 2,
        2 * np.pi / motion.nutation_period,
        float(motion.top.axial_momentum(motion.start)) / motion.top.Ix,
        float(np.sin(middle)) * mean,
    )


def draw_nutation() -> Figure:
    """Draw the path of the axis with the circle that moves along, and the way on the circle."""
    figure = new_figure(2.7)
    motion = cusps()
    period = motion.nutation_period
    times = np.linspace(0.0, period, 801)
    left, right = figure.subplots(1, 2, width_ratios=[9, 4])
    found = find_nutation(motion, times)
    moved = found.drift * times
    around = np.linspace(0.0, 2 * np.pi, 181)
    circle = found.radius * np.array([np.cos(around), np.sin(around)])
    left.plot(moved + found.across, found.down, color=BLUE)
    left.plot(moved, np.zeros_like(moved), color=GREY, lw=0.9, ls=":")
    for share in SHOWN[1::2]:
        k = round(share * (len(times) - 1))
        left.plot(moved[k] + circle[0], circle[1], color=GREY, lw=0.9)
        left.plot([moved[k], moved[k] + found.across[k]], [0.0, found.down[k]], "o-", color=RED)
    left.set(xlabel=r"along the precession (rad)", ylabel="down (rad)", aspect="equal")
    rates = f"{found.rate:.1f} rad/s; $L/I_x$ = {found.free_rate:.1f} rad/s"
    left.set_title(f"the circle moves along. {rates}", fontsize=9)
    right.plot(*circle, color=GREY, lw=0.9, ls="--")
    once = find_nutation(motion, np.linspace(0.0, period, 401))
    right.plot(once.across, once.down, color=BLUE)
    marks = find_nutation(motion, period * np.array(SHOWN))
    right.plot(marks.across, marks.down, "o", color=INK, ms=4)
    right.set(aspect="equal", xlabel="rad")
    right.set_title("with the circle")
    for axes in (left, right):
        axes.invert_yaxis()
    left.set_ylim(0.11, -0.11)
    return figure


def draw_cusp_story() -> Figure:
    """Draw one nutation from cusp to cusp with t1, T/2 and t2, and the signs of accelerations."""
    figure = new_figure(6.4)
    motion = cusps()
    period = motion.nutation_period
    first, second = times_of_extreme_rate(motion)
    marks = {"0": 0.0, "$t_1$  ": first, "$T/2$": period / 2, "  $t_2$": second, "$T$": period}
    quarters = {"  $T/4$": period / 4, "$3T/4$  ": 3 * period / 4}
    times = np.linspace(0.0, period, 801)
    states = motion.at(times)
    changes = dict(zip(("phi", "theta", "psi"), accelerations(motion.top, states).T, strict=True))
    parts = zip(rows(figure, 3), ("theta", "phi", "psi"), (BLUE, RED, INK), strict=True)
    for axes, name, color in parts:
        axes.plot(times, states.euler_rates._asdict()[f"{name}_dot"], color=color)
        axes.set(ylabel=rf"$\dot\{name}$ (rad/s)", xmargin=0, ymargin=0.22)
        inner = [0.0, first, second, period] if name == "theta" else [0.0, period / 2, period]
        for low, high in pairwise(inner):
            between = (3 * low + high) / 4  # no mark is there
            sign = ">" if np.interp(between, times, changes[name]) > 0 else "<"
            place = (between, 0.97)
            top = axes.get_xaxis_transform()
            words = rf"$\ddot\{name} {sign} 0$"
            axes.text(*place, words, transform=top, ha="center", va="top", color=color)
        for time in marks.values():
            axes.axvline(time, color=GREY, lw=0.9, ls=":")
        for time in quarters.values():
            axes.axvline(time, color=GOLD, lw=0.9, ls="--")
    upper = figure.axes[0].secondary_xaxis("top")
    all_marks = marks | quarters
    upper.set_xticks(list(all_marks.values()), list(all_marks))
    for label in upper.get_xticklabels():  # t1 is close to T/4, and t2 to 3T/4
        words = label.get_text()
        if words != words.strip():
            label.set_horizontalalignment("left" if words[0] == " " else "right")
    return figure
