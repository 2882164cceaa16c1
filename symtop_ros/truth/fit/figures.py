"""The plot of a fit: the record, the motion that was found, and the residuals; needs Matplotlib."""

from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from symtop_ros.base.figure_style import (
    BLUE,
    GOLD,
    GREY,
    INK,
    PALE,
    RED,
    RESOLUTION,
    SETTINGS,
    new_figure,
    rows,
)
from symtop_ros.truth.fit.report import Report

POINTS = 2000  # of a record that are drawn
COLOURS = (BLUE, RED, GOLD, INK, GREY, PALE)
UNITS = {
    "rates": "rad/s",
    "across": "rad/s",
    "inertial": "rad/s, m/s^2",
    "pixels": "pixels",
    "axis": "",
    "attitude": "",
}


def write_figure(report: Report, path: Path) -> None:
    """Write the plot as a file of the form that its name asks for."""
    with rc_context(SETTINGS):
        figure = draw_report(report)
        figure.savefig(path, dpi=RESOLUTION)


def draw_report(report: Report) -> Figure:
    """Return the record with the curve of the motion, and the residuals below."""
    model, record = report.fit.model, report.fit.model.record
    step = max(1, len(record) // POINTS)
    t = (record.times - record.times[0])[::step]
    shown, kept = model.show(report.fit.x[np.newaxis])[0], report.fit.noise.kept[::step]
    figure = new_figure(4.8)
    above, below = rows(figure, 2)
    unit = UNITS.get(record.kind.name, "rad")
    # residuals of a sensor with two units are drawn in deviations
    sizes = report.fit.noise.sigma if record.kind.name == "inertial" else np.ones(1)
    residuals = -report.fit.residuals / sizes  # what was seen less what the motion shows
    for column, name in enumerate(record.kind.columns):
        colour, seen = COLOURS[column], record.values[::step, column]
        above.plot(t, seen, ".", color=colour, markersize=2.5, alpha=0.5)
        above.plot(t, shown[::step, column], color=colour, linewidth=0.8, label=name)
    for column, left in enumerate(residuals[::step].T):
        below.plot(t[kept], left[kept], ".", color=COLOURS[column], markersize=2.5)
        below.plot(t[~kept], left[~kept], "x", color=GREY, markersize=3)
    size = 6 * float(residuals[report.fit.noise.kept].std()) + 1e-300
    below_unit = "deviations" if len(sizes) > 1 else unit or "1"
    below.set(ylabel=f"residual ({below_unit})", ylim=(-size, size))
    above.set(ylabel=f"record ({unit or '1'})")
    above.legend(ncols=6, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return figure
