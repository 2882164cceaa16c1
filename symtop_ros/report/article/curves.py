"""What changes with time: angles, rates and angular momentum."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from symtop_ros.physics import Motion, motion
from symtop_ros.report.article.motions import RATES, THETA, TOP, Rate, cusps, regular, start
from symtop_ros.report.article.on_nutation import horizontal_square
from symtop_ros.report.article.spheres import turn
from symtop_ros.report.style import BLUE, GREY, INK, RED, columns, new_figure, rows

Real = NDArray[np.float64]
TIMES = np.linspace(0.0, 0.5, 2001)  # s; three nutations of cusps
LOOKS = {"falls": (RED, "--"), "stays": (INK, "-"), "rises": (BLUE, "-.")}


def cusps_against_time() -> Figure:
    """Draw theta, theta', phi' and psi' of cusps."""
    figure, path = new_figure(6.6), cusps()
    states = path.at(TIMES)
    rates = states.euler_rates
    curves = {
        r"$\theta$ (rad)": states.euler_angles.theta,
        r"$\dot\theta$ (rad/s)": rates.theta,
        r"$\dot\phi$ (rad/s)": rates.phi,
        r"$\dot\psi$ (rad/s)": rates.psi,
    }
    for axes, (label, values) in zip(rows(figure, 4), curves.items(), strict=True):
        axes.plot(TIMES, values, color=BLUE)
        axes.set_ylabel(label)
        axes.margins(x=0)
        _mark_cusps(axes, path)
    figure.axes[0].set_title("dotted: at the cusps", loc="right")
    return figure


def _mark_cusps(axes: Axes, path: Motion) -> None:
    for time in np.arange(0.0, TIMES[-1], path.nutation_period):
        axes.axvline(time, color=GREY, lw=0.9, ls=":")


def six_rates() -> Figure:
    """Draw theta for the six precession rates, three about each root."""
    figure = new_figure(3.3)
    for axes, rates in zip(columns(figure, 2, sharey=True), (RATES[:3], RATES[3:]), strict=True):
        for rate in rates:
            color, dash = LOOKS[rate.follows]
            theta = motion(TOP, start(rate.phi_dot)).at(TIMES).euler_angles.theta
            axes.plot(TIMES, theta, color=color, ls=dash, label=_words(rate))
        axes.set_xlabel("$t$ (s)")
        axes.margins(x=0)
        axes.legend(loc="upper left", title=r"$\dot\phi(0)$")
    figure.axes[0].set_ylabel(r"$\theta$ (rad)")
    figure.axes[0].set_ylim(THETA - 0.08, THETA + 0.2)
    return figure


def _words(rate: Rate) -> str:
    return f"{rate.phi_dot:#.3g} rad/s: {rate.follows}"


def momentum() -> Figure:
    """Draw the components of L of regular precession and of cusps."""
    figure = new_figure(4.6)
    times = np.linspace(0.0, 1.5, 3001)
    titles = {"regular precession": regular(), "cusps": cusps()}
    for axes, (title, path) in zip(rows(figure, 2), titles.items(), strict=True):
        values = 1e3 * path.top.angular_momentum(path.at(times))
        for part, color, dash in zip(range(3), (BLUE, RED, INK), ("-", "--", "-"), strict=True):
            axes.plot(times, values[:, part], color=color, ls=dash, label=f"$L_{{{'xyz'[part]}'}}$")
        axes.set_ylabel("$L$ ($10^{-3}$ N m s)")
        axes.set_title(title, loc="left")
        axes.margins(x=0)
    figure.axes[0].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3)
    return figure


def horizontal_momentum() -> Figure:
    """Draw the end of L from above, over one turn of the precession."""
    figure = new_figure(3.4)
    titles = {"regular precession": regular(), "cusps": cusps()}
    both = columns(figure, 2, sharex=True, sharey=True)
    for axes, (title, path) in zip(both, titles.items(), strict=True):
        L = 1e3 * path.top.angular_momentum(path.at(np.linspace(0.0, turn(path), 3001)))
        axes.plot(L[:, 0], L[:, 1], color=BLUE)
        axes.plot(*L[0, :2], "o", color=RED)
        axes.annotate("start", (L[0, 0], L[0, 1]), (0, 8), textcoords="offset points", ha="center")
        axes.plot(0, 0, "+", color=INK)
        axes.set_aspect("equal")
        axes.set_xticks(range(-6, 7, 2))
        axes.set_yticks(range(-6, 7, 2))
        axes.set_xlabel("$L_{x'}$ ($10^{-3}$ N m s)")
        axes.set_title(title, loc="left")
    both[0].set_ylabel("$L_{y'}$ ($10^{-3}$ N m s)")
    return figure


def horizontal_momentum_squared() -> Figure:
    """Draw L^2 - L_z'^2 beside theta, of regular precession and of cusps."""
    figure = new_figure(4.6)
    upper, lower = rows(figure, 2)
    titles = {"cusps": (cusps(), BLUE, "-"), "regular precession": (regular(), RED, "--")}
    for title, (path, color, dash) in titles.items():
        lower.plot(TIMES, path.at(TIMES).euler_angles.theta, color=color, ls=dash)
        square = 1e6 * horizontal_square(path, TIMES)
        upper.plot(TIMES, square, color=color, ls=dash, label=title)
    upper.set_ylabel("$L^2 - {L_{z'}}^2$ ($10^{-6}$ N$^2$ m$^2$ s$^2$)")
    lower.set_ylabel(r"$\theta$ (rad)")
    upper.margins(x=0)
    upper.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    return figure
