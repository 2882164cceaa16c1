"""The figure of `top_judge`: errors over time; needs Matplotlib."""

import numpy as np
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.base.figure_style import BLUE, GOLD, INK, RED, new_figure, rows
from symtop_ros.truth.judge.compare import Errors

POINTS = 5000  # of a curve


def draw_errors(errors: Errors) -> Figure:
    """Draw the errors of attitude, heading, tilt, and of the angular velocity if there is one."""
    figure = new_figure(3.6 if errors.rate is None else 4.8)
    axes = rows(figure, 1 if errors.rate is None else 2)
    step = max(1, len(errors.total) // POINTS)
    t = errors.seconds[::step]
    for values, color, label in (
        (errors.total, INK, "attitude"),
        (np.abs(errors.heading), BLUE, "heading"),
        (errors.tilt, GOLD, "tilt"),
    ):
        axes[0].plot(t, _positive(values[::step]), color=color, label=label, linewidth=1.0)
    axes[0].set(yscale="log", ylabel="error (rad)")
    axes[0].legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    if errors.rate is not None:
        axes[1].plot(t, _positive(errors.rate[::step]), color=RED, linewidth=1.0)
        axes[1].set(yscale="log", ylabel=r"error of $\omega$ (rad/s)")
    return figure


def _positive(values: Real) -> Real:
    """Return values for a logarithmic axis, on which an error of zero is not drawn."""
    return np.where(values > 0, values, np.nan)
