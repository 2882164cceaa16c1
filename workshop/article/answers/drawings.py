"""Figures of an axis that is let go, and of the way from cusp to cusp."""

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.judge.figures import BLUE, GOLD, GREY, INK, RED, columns, new_figure, rows
from symtop_ros.physics import Motion
from workshop.article.answers.release import SPINS
from workshop.article.motions import TOP, accelerations, cusps, start
from workshop.article.nutation import times_of_extreme_rate

STEP, STEPS = 0.02, 7  # s, and the number of steps of L + torque dt
BESIDE = 0.8  # 10^-3 N m s between a chain that lies on L and L


def draw_cusp_story() -> Figure:
    """Draw one nutation from cusp to cusp with t1, T/2 and t2, and the signs of accelerations."""
    figure, motion = new_figure(6.4), cusps()
    period = motion.nutation_period
    first, second = times_of_extreme_rate(motion)
    marks = {"0": 0.0, "$t_1$  ": first, "$T/2$": period / 2, "  $t_2$": second, "$T$": period}
    quarters = {"  $T/4$": period / 4, "$3T/4$  ": 3 * period / 4}
    times = np.linspace(0.0, period, 801)
    states = motion.at(times)
    changes = dict(zip(("phi", "theta", "psi"), accelerations(motion.top, states).T, strict=True))
    parts = zip(rows(figure, 3), ("theta", "phi", "psi"), (BLUE, RED, INK), strict=True)
    for axes, name, color in parts:
        axes.plot(times, states.euler_rates._asdict()[name], color=color)
        axes.set(ylabel=rf"$\dot\{name}$ (rad/s)", xmargin=0, ymargin=0.22)
        inner = [0.0, first, second, period] if name == "theta" else [0.0, period / 2, period]
        for low, high in pairwise(inner):
            between = (3 * low + high) / 4  # no mark is there
            sign = ">" if np.interp(between, times, changes[name]) > 0 else "<"
            place, top = (between, 0.97), axes.get_xaxis_transform()
            words = rf"$\ddot\{name} {sign} 0$"
            axes.text(*place, words, transform=top, ha="center", va="top", color=color)
        for time in marks.values():
            axes.axvline(time, color=GREY, lw=0.9, ls=":")
        for time in quarters.values():
            axes.axvline(time, color=GOLD, lw=0.9, ls="--")
    upper, all_marks = figure.axes[0].secondary_xaxis("top"), marks | quarters
    upper.set_xticks(list(all_marks.values()), list(all_marks))
    for label in upper.get_xticklabels():  # t1 is close to T/4, and t2 to 3T/4
        words = label.get_text()
        if words != words.strip():
            label.set_horizontalalignment("left" if words[0] == " " else "right")
    return figure


def draw_release() -> Figure:
    """Draw L + torque dt head to tail, without spin and with it, and theta for six spin rates."""
    figure = new_figure(6.6)
    parts: Any = figure.subfigures(2, 1)
    upper, lower = parts
    for axes, spin in zip(columns(upper, 2), (0.0, 200.0), strict=True):
        _draw_chain(axes, Motion(TOP, start(0.0, spin)))
        words = "turns" if spin else "grows along the nodes"
        axes.set_title(f"{spin:g} rad/s: $L$ {words}")
    axes, times = lower.subplots(), np.linspace(0.0, 0.6, 1201)
    shades = (INK, RED, GOLD, GREY, BLUE, INK)
    for spin, color, dash in zip(SPINS, shades, ("-", "--", "-.", "--", "-", ":"), strict=True):
        theta = Motion(TOP, start(0.0, spin)).at(times).euler_angles.theta
        axes.plot(times, np.degrees(theta), color=color, ls=dash, label=f"{spin:g} rad/s")
    axes.set(xlabel="$t$ (s)", ylabel=r"$\theta$ (degrees)", xmargin=0, yticks=range(0, 181, 45))
    words = "no spin: the axis swings\nthrough straight down,\nand comes up on the\nother side"
    axes.annotate(words, (0.17, 178), (0.22, 176), va="top", arrowprops={"arrowstyle": "-"})
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), title=r"$\dot\psi(0)$")
    return figure


def _draw_chain(axes: Axes, motion: Motion) -> None:
    """Draw the horizontal L and the torque times dt of each step, head to tail, from above."""
    middles = STEP * (np.arange(STEPS) + 0.5)
    change = 1e3 * STEP * motion.top.gravity_torque(motion.at(middles))[:, :2]
    first = 1e3 * motion.top.angular_momentum(motion.start)[:2]
    tails = first + np.vstack([np.zeros(2), np.cumsum(change, axis=0)[:-1]])
    look: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "zorder": 3}
    last = tails[-1] + change[-1]
    axes.quiver(0, 0, *last, color=BLUE, label=f"$L$ after {STEP * STEPS:g} s", **look)
    label = rf"$\tau\,dt$ in steps of {1e3 * STEP:g} ms"
    if np.any(first):
        axes.quiver(0, 0, *first, color=INK, label="$L$ at the start", **look)
    else:  # the chain lies on L
        tails = tails + np.array([0.0, BESIDE])
        label += ", moved up"
    axes.quiver(*tails.T, *change.T, color=GOLD, label=label, **look)
    axes.plot(0, 0, "+", color=INK)
    axes.set(aspect="equal", xlim=(-1, 9), ylim=(-6.2, 4.6), xlabel="$L_{x'}$ ($10^{-3}$ N m s)")
    axes.set_ylabel("$L_{y'}$ ($10^{-3}$ N m s)")
    axes.legend(loc="upper right", fontsize=8)
