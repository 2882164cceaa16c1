"""The article's figures: angles, rates and angular momentum against time, and the parabola."""

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GREY, INK, PALE, RED, columns, new_figure, rows
from symtop_ros.physics import (
    EffectivePotential,
    Motion,
    regular_precession_rates,
    theta_acceleration,
)
from workshop.article.answers.circle import draw_cusp_story, draw_nutation
from workshop.article.answers.fictitious import draw_fictitious_torques, draw_four_masses
from workshop.article.answers.impulses import draw_impulses
from workshop.article.answers.ledger import draw_energy_ledger
from workshop.article.answers.release import draw_release
from workshop.article.answers.resolution import draw_resolution
from workshop.article.answers.starts import DISC, draw_map_of_kinds
from workshop.article.motions import (
    FAST,
    PRINTED_ROOTS,
    PSI_DOT,
    RATES,
    SLOW,
    THETA,
    TOP,
    cusps,
    first_turn,
    regular,
    start,
)
from workshop.article.nutation import horizontal_square
from workshop.article.pivot import pivot_forces
from workshop.article.torque import split_torque
from workshop.article.views import draw_euler_angles, draw_sphere

TIMES = np.linspace(0.0, 0.5, 2001)  # s; three nutations of cusps
PHI_DOTS = np.linspace(-8.0, 85.0, 400)  # rad/s
COMPARED = {"regular precession": regular(), "cusps": cusps()}
ROUNDING = 1e-9  # relative; a gap below it is rounding
LOOKS = {"falls": (RED, "--"), "stays": (INK, "-"), "rises": (BLUE, "-.")}


def draw_cusps_against_time() -> Figure:
    """Draw theta, theta', phi' and psi' of cusps."""
    figure = new_figure(6.6)
    motion = cusps()
    states = motion.at(TIMES)
    rates = states.euler_rates
    curves = {
        r"$\theta$ (rad)": states.euler_angles.theta,
        r"$\dot\theta$ (rad/s)": rates.theta_dot,
        r"$\dot\phi$ (rad/s)": rates.phi_dot,
        r"$\dot\psi$ (rad/s)": rates.psi_dot,
    }
    for axes, (label, values) in zip(rows(figure, 4), curves.items(), strict=True):
        axes.plot(TIMES, values, color=BLUE)
        axes.set(ylabel=label, xmargin=0)
        for time in np.arange(0.0, TIMES[-1], motion.nutation_period):
            axes.axvline(time, color=GREY, lw=0.9, ls=":")
    figure.axes[0].set_title("dotted: at the cusps", loc="right")
    return figure


def draw_six_rates() -> Figure:
    """Draw theta for the six precession rates, three about each root."""
    figure = new_figure(3.3)
    for axes, rates in zip(columns(figure, 2, sharey=True), (RATES[:3], RATES[3:]), strict=True):
        for rate in rates:
            color, dash = LOOKS[rate.direction]
            theta = Motion(TOP, start(rate.phi_dot)).at(TIMES).euler_angles.theta
            label = f"{rate.phi_dot:#.3g} rad/s: {rate.direction}"
            axes.plot(TIMES, theta, color=color, ls=dash, label=label)
        axes.set(xlabel="$t$ (s)", xmargin=0)
        axes.legend(loc="upper left", title=r"$\dot\phi(0)$")
    figure.axes[0].set(ylabel=r"$\theta$ (rad)", ylim=(THETA - 0.08, THETA + 0.2))
    return figure


def draw_theta_acceleration() -> Figure:
    """Draw theta'' against phi', with the two roots and the six rates."""
    figure = new_figure(3.9)
    axes = figure.subplots()
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.plot(PHI_DOTS, theta_acceleration(TOP, THETA, PHI_DOTS, PSI_DOT), color=BLUE)
    rates = np.array([rate.phi_dot for rate in RATES if rate.direction != "stays"])
    values = theta_acceleration(TOP, THETA, rates, PSI_DOT)
    axes.plot(rates, values, "s", color=INK, ms=5, label="the article's other rates", zorder=3)
    label = "regular precession: it stays"
    axes.plot([SLOW, FAST], [0, 0], "o", color=RED, ms=7, label=label, zorder=3)
    for root, printed, side in zip((SLOW, FAST), PRINTED_ROOTS, ("right", "left"), strict=True):
        offset = (-9 if side == "right" else 9, -14)
        axes.annotate(f"{printed} rad/s", (root, 0), offset, textcoords="offset points", ha=side)
    axes.axvspan(SLOW, FAST, color=PALE, alpha=0.35, lw=0)
    middle = (SLOW + FAST) / 2
    for place, word in ((middle, "the top rises"), (-1.0, "it falls"), (77.5, "it falls")):
        axes.text(place, -205, word, ha="center", style="italic")
    axes.set(xlabel=r"$\dot\phi$ (rad/s)", ylabel=r"$\ddot\theta$ (rad/s$^2$)", xmargin=0)
    axes.legend(loc="upper center")
    return figure


def draw_angular_momentum() -> Figure:
    """Draw the components of L of regular precession and of cusps."""
    figure = new_figure(4.6)
    times = np.linspace(0.0, 1.5, 3001)
    for axes, (title, motion) in zip(rows(figure, 2), COMPARED.items(), strict=True):
        L = 1e3 * motion.top.angular_momentum(motion.at(times))
        for part, color, dash in zip(range(3), (BLUE, RED, INK), ("-", "--", "-"), strict=True):
            axes.plot(times, L[:, part], color=color, ls=dash, label=f"$L_{{{'xyz'[part]}'}}$")
        axes.set(ylabel="$L$ ($10^{-3}$ N m s)", title=title, xmargin=0)
    figure.axes[0].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3)
    return figure


def draw_horizontal_momentum() -> Figure:
    """Draw the end of L from above, for phi from 0 to 2 pi, and the gap that is left."""
    figure = new_figure(3.4)
    both = columns(figure, 2, sharex=True, sharey=True)
    for axes, (title, motion) in zip(both, COMPARED.items(), strict=True):
        times = np.linspace(0.0, first_turn(motion), 3001)
        L = 1e3 * motion.top.angular_momentum(motion.at(times))[:, :2]
        axes.plot(L[:, 0], L[:, 1], color=BLUE)
        axes.plot(L[[0, -1], 0], L[[0, -1], 1], color=RED, lw=2.5)
        axes.plot(*L[0], "o", color=RED)
        axes.plot(*L[-1], "s", color=RED, mfc="white")
        gap = np.linalg.norm(L[-1] - L[0]) / np.linalg.norm(L[0])
        words = f"gap at $\\phi = 2\\pi$: {gap:.1%}" if gap > ROUNDING else "closed"
        # inside of the circle, next to the gap
        axes.annotate(
            words, (L[0] + L[-1]) / 2, ha="center", xytext=(0, 24), textcoords="offset points"
        )
        axes.plot(0, 0, "+", color=INK)
        ticks = range(-6, 7, 2)
        axes.set(aspect="equal", xticks=ticks, yticks=ticks, title=title)
        axes.set_xlabel("$L_{x'}$ ($10^{-3}$ N m s)")
    both[0].set_ylabel("$L_{y'}$ ($10^{-3}$ N m s)")
    return figure


def draw_horizontal_momentum_squared() -> Figure:
    """Draw L^2 - L_z'^2 and theta of regular precession and of cusps."""
    figure = new_figure(4.6)
    upper, lower = rows(figure, 2)
    looks = {"cusps": (BLUE, "-"), "regular precession": (RED, "--")}
    for title, (color, dash) in looks.items():
        motion = COMPARED[title]
        lower.plot(TIMES, motion.at(TIMES).euler_angles.theta, color=color, ls=dash)
        upper.plot(TIMES, 1e6 * horizontal_square(motion, TIMES), color=color, ls=dash, label=title)
    upper.set(ylabel="$L^2 - {L_{z'}}^2$ ($10^{-6}$ N$^2$ m$^2$ s$^2$)", xmargin=0)
    lower.set_ylabel(r"$\theta$ (rad)")
    upper.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2)
    return figure


def draw_inertial_torque() -> Figure:
    """Draw the torque, dL/dt in the body frame and omega x L, along the line of nodes."""
    figure = new_figure(3.4)
    looks = {
        "torque": (INK, "-"),
        "$dL/dt$ in the body frame": (BLUE, "--"),
        r"$\omega \times L$": (RED, "-."),
    }
    times = TIMES[:1401]
    both = columns(figure, 2, sharey=True)
    for axes, (title, motion) in zip(both, COMPARED.items(), strict=True):
        parts = split_torque(motion, times).values()
        for (label, (color, dash)), part in zip(looks.items(), parts, strict=True):
            axes.plot(times, part, color=color, ls=dash, label=label)
        axes.set(title=title, xlabel="$t$ (s)", xmargin=0)
    both[0].set_ylabel("along the line of nodes (N m)")
    figure.legend(*both[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def draw_same_accelerations() -> Figure:
    """Draw two motions that begin with the same accelerations: theta, and both potentials."""
    figure = new_figure(3.5)
    left, right = columns(figure, 2)
    for phi_dot, color, dash in ((0.0, BLUE, "-"), (SLOW + FAST, RED, "--")):
        motion = Motion(TOP, start(phi_dot))
        label = rf"$\dot\phi(0)$ = {phi_dot:.3g} rad/s: {motion.kind}"
        left.plot(TIMES, motion.at(TIMES).euler_angles.theta, color=color, ls=dash, label=label)
        low, high = motion.turning_angles
        plot_depth(right, motion, np.linspace(low - 0.04, high + 0.04, 300), color=color, ls=dash)
    left.set(xlabel="$t$ (s)", ylabel=r"$\theta$ (rad)", xmargin=0)
    right.set(ylim=(-2.4, 2.4))
    right.axhline(0.0, color=INK, lw=0.9)
    figure.legend(*left.get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def plot_depth(axes: Axes, motion: Motion, theta: Real, **look: Any) -> None:
    """Plot the effective potential over E' against theta, with the turning angles."""
    potential = EffectivePotential.from_state(motion.top, motion.start)
    axes.plot(theta, 1e3 * (potential.at(theta) - potential.energy), **look)
    axes.plot(motion.turning_angles, [0, 0], "o", color=look["color"], ms=5)
    axes.set(xlabel=r"$\theta$ (rad)", ylabel=r"$U_\mathrm{eff} - E'$ ($10^{-3}$ J)")


def draw_parabola_downward() -> Figure:
    """Draw theta'' against phi' for a disc, Iz > Ix: it falls between the roots."""
    figure = new_figure(3.2)
    axes = figure.subplots()
    low, high = sorted(regular_precession_rates(DISC, THETA, PSI_DOT))
    rates = np.linspace(low - 150.0, high + 150.0, 400)
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.axvspan(low, high, color=PALE, alpha=0.35, lw=0)
    axes.plot(rates, 1e-3 * theta_acceleration(DISC, THETA, rates, PSI_DOT), color=BLUE)
    axes.plot([low, high], [0, 0], "o", color=RED, ms=7, zorder=3)
    for place, word in ((low - 75, "rises"), ((low + high) / 2, "falls"), (high + 75, "rises")):
        axes.text(place, 7.0, f"it {word}", ha="center", style="italic")
    axes.set(xlabel=r"$\dot\phi$ (rad/s)", ylabel=r"$\ddot\theta$ ($10^3$ rad/s$^2$)", xmargin=0)
    moments = f"$I_x$ = {DISC.Ix:g}, $I_z$ = {DISC.Iz:g} kg m$^2$, $Mgl$ = {DISC.Mgl:g} J"
    given = rf"$\theta$ = {THETA} rad, $\dot\psi$ = {PSI_DOT:g} rad/s"
    axes.set_title(f"a disc: {moments}\n{given}: roots {low:.0f} and {high:.2f} rad/s")
    return figure


def draw_pivot_force() -> Figure:
    """Draw the force of the pivot on cusps, and hurried from the fast root."""
    figure = new_figure(3.4)
    titles = {"cusps": 0.0, "fast root, hurried 1.4 times": 1.4 * FAST}
    for axes, (title, phi_dot) in zip(columns(figure, 2), titles.items(), strict=True):
        motion = Motion(TOP, start(phi_dot))
        times = np.linspace(0.0, 3 * motion.nutation_period, 1200)
        vertical, horizontal = pivot_forces(motion, times)
        axes.plot(times, vertical, color=BLUE, label="vertical")
        axes.plot(times, horizontal, color=RED, ls="--", label="horizontal")
        axes.axhline(vertical.mean(), color=GREY, lw=0.9, ls=":", label="weight")
        axes.set(title=title, xlabel="$t$ (s)", ylim=(0.0, None), xmargin=0)
    figure.axes[0].set_ylabel("force of the pivot (N)")
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


FIGURES: dict[str, Callable[[], Figure]] = {
    "euler_angles": draw_euler_angles,
    "regular_precession": lambda: draw_sphere(regular()),
    "cusps": lambda: draw_sphere(cusps()),
    "cusps_against_time": draw_cusps_against_time,
    "theta_acceleration": draw_theta_acceleration,
    "six_rates": draw_six_rates,
    "angular_momentum": draw_angular_momentum,
    "horizontal_momentum": draw_horizontal_momentum,
    "horizontal_momentum_squared": draw_horizontal_momentum_squared,
    "inertial_torque": draw_inertial_torque,
    "same_accelerations": draw_same_accelerations,
    "parabola_downward": draw_parabola_downward,
    "pivot_force": draw_pivot_force,
    "cusp_story": draw_cusp_story,
    "release": draw_release,
    "nutation": draw_nutation,
    "fictitious_torques": draw_fictitious_torques,
    "four_masses": draw_four_masses,
    "impulses": draw_impulses,
    "energy_ledger": draw_energy_ledger,
    "map_of_kinds": draw_map_of_kinds,
    "resolution": draw_resolution,
}
