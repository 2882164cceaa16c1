"""The article's figures, as SVG and PNG."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

from symtop_ros.report.article import curves
from symtop_ros.report.article.motions import cusps, regular
from symtop_ros.report.article.parabola import parabola
from symtop_ros.report.article.spheres import sphere
from symtop_ros.report.style import RESOLUTION, SETTINGS

FIGURES: dict[str, Callable[[], Figure]] = {
    "regular_precession": lambda: sphere(regular()),
    "cusps": lambda: sphere(cusps()),
    "cusps_against_time": curves.cusps_against_time,
    "theta_acceleration": parabola,
    "six_rates": curves.six_rates,
    "angular_momentum": curves.momentum,
    "horizontal_momentum": curves.horizontal_momentum,
    "horizontal_momentum_squared": curves.horizontal_momentum_squared,
}


def write_figures(folder: Path) -> list[Path]:
    """Write every figure twice; return the files.

    Raises
    ------
    OSError
        Where a file cannot be written.
    """
    with rc_context(SETTINGS):
        return [file for name, draw in FIGURES.items() for file in _write(draw(), folder / name)]


def _write(figure: Figure, stem: Path) -> list[Path]:
    svg, png = stem.with_suffix(".svg"), stem.with_suffix(".png")
    figure.savefig(svg, metadata={"Date": None})
    figure.savefig(png, dpi=RESOLUTION)
    return [svg, png]
