"""The style of all figures; needs Matplotlib.

Colours differ in grey too, sizes are those of a printed page.
"""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

INK, BLUE, RED, GOLD = "#20242c", "#1f5f9e", "#cf5a2b", "#e3a72f"  # from dark to light
GREY, PALE = "#8a8f98", "#c9cdd3"
WIDTH = 6.3  # inches: a page with margins
RESOLUTION = 200  # dots per inch
SETTINGS: Any = {
    "font.size": 9.5,
    "axes.labelsize": 10,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.formatter.use_mathtext": False,  # plain text takes a quarter less time
    "axes.formatter.limits": (-3, 4),
    "grid.color": "#e6e8eb",
    "grid.linewidth": 0.7,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "lines.linewidth": 1.7,
    "legend.frameon": False,
    "mathtext.fontset": "dejavusans",
    "figure.constrained_layout.use": True,
    "figure.constrained_layout.wspace": 0.05,
    "figure.constrained_layout.h_pad": 0.06,
    "svg.hashsalt": "symtop_ros",  # the same bytes every time
}


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Return an empty figure of this size in inches, on no screen."""
    return Figure(figsize=(width, height))


def columns(figure: Figure, count: int, **sharing: Any) -> list[Axes]:
    """Return axes side by side."""
    return list(figure.subplots(1, count, squeeze=False, **sharing)[0])


def rows(figure: Figure, count: int) -> list[Axes]:
    """Return axes above each other, with one time axis in s."""
    axes = list(figure.subplots(count, 1, squeeze=False, sharex=True)[:, 0])
    axes[-1].set_xlabel("$t$ (s)")
    figure.align_ylabels(axes)
    return axes


def write_figures(figures: Mapping[str, Callable[[], Figure]], folder: Path) -> None:
    """Draw figures and write each as NAME.svg and NAME.png."""
    with rc_context(SETTINGS):
        for name, draw in figures.items():
            figure = draw()
            # One layout serves both files; it takes longer than all else that is drawn.
            figure.draw_without_rendering()
            figure.set_layout_engine("none")
            figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
            figure.savefig(folder / f"{name}.png", dpi=RESOLUTION)
