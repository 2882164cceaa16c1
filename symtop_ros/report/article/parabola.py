"""The angular acceleration of theta against the precession rate."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.report.article.equations import theta_acceleration
from symtop_ros.report.article.motions import FAST, PRINTED, PSI_DOT, RATES, SLOW, THETA, TOP
from symtop_ros.report.style import BLUE, INK, PALE, RED, new_figure

PHI_DOTS = np.linspace(-8.0, 85.0, 400)  # rad/s


def parabola() -> Figure:
    """Draw theta'' against phi', with the two roots and the six rates."""
    figure = new_figure(3.9)
    axes = figure.subplots()
    axes.axhline(0.0, color=INK, lw=0.9)
    axes.plot(PHI_DOTS, theta_acceleration(TOP, THETA, PHI_DOTS, PSI_DOT), color=BLUE)
    _mark_rates(axes)
    _mark_roots(axes)
    _mark_sides(axes)
    axes.set_xlabel(r"$\dot\phi$ (rad/s)")
    axes.set_ylabel(r"$\ddot\theta$ (rad/s$^2$)")
    axes.margins(x=0)
    axes.legend(loc="upper center")
    return figure


def _mark_rates(axes: Axes) -> None:
    rates = np.array([rate.phi_dot for rate in RATES if rate.follows != "stays"])
    values = theta_acceleration(TOP, THETA, rates, PSI_DOT)
    axes.plot(rates, values, "s", color=INK, ms=5, label="the article's other rates", zorder=3)


def _mark_roots(axes: Axes) -> None:
    axes.plot(
        [SLOW, FAST], [0, 0], "o", color=RED, ms=7, label="regular precession: it stays", zorder=3
    )
    for root, printed, side in ((SLOW, PRINTED[0], -1), (FAST, PRINTED[1], 1)):
        axes.annotate(
            f"{printed} rad/s",
            (root, 0),
            (9 * side, -14),
            textcoords="offset points",
            ha="right" if side < 0 else "left",
        )


def _mark_sides(axes: Axes) -> None:
    axes.axvspan(SLOW, FAST, color=PALE, alpha=0.35, lw=0)
    middle = (SLOW + FAST) / 2
    for place, word in ((middle, "the top rises"), (-1.0, "it falls"), (77.5, "it falls")):
        axes.text(place, -205, word, ha="center", style="italic")
