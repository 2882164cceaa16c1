"""The report's plots, as SVG and PNG."""

from collections.abc import Iterable
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from symtop_ros.base.figure_style import BLUE, GREY, INK, RED, new_figure, write_figures
from workshop.speed.benchmarks import SPAN, HardCase, Results
from workshop.speed.peers import CLOSED_FORM
from workshop.speed.publish import group
from workshop.speed.reference import EPS, ReferenceMotion
from workshop.speed.sweep import Curve

PACKAGES = {  # colours that differ in grey, and markers that differ without any
    "symtop_ros": (RED, "*"),
    "SciPy": (BLUE, "o"),
    "heyoka": (INK, "D"),
    "CyRK": ("#d07020", "h"),
    "MuJoCo": ("#8a5fb0", "s"),
    "Drake": ("#2f8f6b", "^"),
    "Pinocchio": ("#7a4a21", "P"),
    "EXUDYN": ("#b0a030", "v"),
    "diffrax": ("#e58fb0", "X"),
}
DASHES = ("-", "--", ":", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2)))
SMALLEST = EPS / 4  # at which errors of zero are drawn
ERROR = "largest error of the attitude (rad)"
Looks = dict[str, dict[str, Any]]


def write_plots(results: Results, motion: ReferenceMotion, folder: Path) -> None:
    """Write every plot as SVG and PNG."""
    looks = _choose_looks(dict.fromkeys([*(c.peer for c in results.curves), *results.checks]))
    drawings = {name: partial(draw, results, motion, looks) for name, draw in DRAWINGS.items()}
    write_figures(drawings, folder)


def _choose_looks(names: Iterable[str]) -> Looks:
    """Give each package a colour and a marker, and each of its methods a dash."""
    looks: Looks = {}
    for package, own in group(names, lambda name: name.replace(",", "").split()[0]).items():
        color, marker = PACKAGES[package]
        look = {"color": color, "marker": marker, "ms": 14 if marker == "*" else 4.5, "lw": 1.2}
        for name, dash in zip(own, cycle(DASHES), strict=False):
            looks[name] = {**look, "ls": dash, "label": name}
    return looks


def draw_work_precision(results: Results, motion: ReferenceMotion, looks: Looks) -> Figure:
    """Draw error against seconds per simulated second."""
    figure = new_figure(4.6, width=8.2)
    axes = figure.subplots()
    curves = [curve for curve in results.curves if curve.motion == motion.name]
    _draw_curves(axes, curves, looks)
    limit = motion.limit(SPAN)  # what rounding of the input changes
    axes.axhline(limit, color=GREY, lw=1, ls=(0, (6, 3)))
    axes.annotate("what rounding of the input changes", (0.99, limit), (0, 3),
                  ("axes fraction", "data"), "offset points",
                  ha="right", fontsize=8, color=GREY)  # fmt: skip
    axes.set(ylabel=ERROR, title=f"the article's top, {motion.name}, after {SPAN:g} s")
    figure.legend(loc="outside right upper", fontsize=8)
    return figure


def _draw_curves(axes: Axes, curves: Iterable[Curve], looks: Looks) -> None:
    for curve in curves:
        seconds = [point.seconds / curve.t for point in curve.points]
        errors = [max(point.error, SMALLEST) for point in curve.points]
        axes.loglog(seconds, errors, **looks[curve.peer])
    axes.set_xlabel("seconds per simulated second")


def draw_motions(results: Results, _: ReferenceMotion, looks: Looks) -> Figure:
    """Draw error against seconds for every motion that was measured."""
    motions = group(results.curves, lambda curve: curve.motion)
    figure, grid = _new_grid(len(motions), 2.6, sharex=True)
    for axes, (name, curves) in zip(grid, motions.items(), strict=True):
        _draw_curves(axes, curves, looks)
        axes.set_title(name)
    # Not every package was measured on every motion
    found = {
        label: handle
        for axes in grid
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(
        list(found.values()), list(found), loc="outside lower center", ncols=4, fontsize=8
    )
    return figure


def _new_grid(count: int, height: float, sharex: bool = False) -> tuple[Figure, list[Axes]]:
    """Return a figure with axes in rows of four, each so high in inches."""
    rows = -(-count // 4)
    figure = new_figure(height * rows, width=10)
    grid = figure.subplots(rows, min(4, count), squeeze=False, sharex=sharex, sharey=True).ravel()
    for axes in grid[count:]:
        axes.remove()
    figure.supylabel("error (rad)", fontsize=10)
    return figure, list(grid[:count])


def draw_long_times(results: Results, motion: ReferenceMotion, looks: Looks) -> Figure:
    """Draw the growth of the errors with time."""
    figure = new_figure(4.2, width=8.2)
    axes = figure.subplots()
    for each in results.growth:
        errors = np.maximum(each.errors, SMALLEST)
        axes.loglog(each.times, errors, **looks[each.peer])
    times = [t for t in motion.times if t >= SPAN]
    limits = [motion.limit(t) for t in times]
    axes.loglog(times, limits, color=GREY, lw=1, ls=(0, (6, 3)), label="rounding of the input")
    axes.set(xlabel="simulated time (s)", ylabel="error of the attitude at the end (rad)")
    axes.set_title("each at its best setting for ten seconds")
    figure.legend(loc="outside right upper", fontsize=8)
    return figure


def draw_arrays(results: Results, _: ReferenceMotion, looks: Looks) -> Figure:
    """Draw the cost of a state against the number of states."""
    figure = new_figure(3.4, width=8.2)
    axes = figure.subplots()
    for each in results.states:
        cost = np.array(each.seconds) / np.array(each.numbers) * 1e6
        axes.loglog(each.numbers, cost, **looks[each.peer])
    axes.set(xlabel=f"number of states within {SPAN:g} s", ylabel="us per state, set-up included")
    figure.legend(loc="outside right upper", fontsize=8)
    return figure


def draw_hard_cases(results: Results, _: ReferenceMotion, __: Looks) -> Figure:
    """Draw the errors of each family against the distance from its singular case."""
    families = group(results.hard, lambda case: case.family)
    figure, grid = _new_grid(len(families), 2.1)
    for axes, cases in zip(grid, families.values(), strict=True):
        _draw_family(axes, cases)
    looks = grid[0].get_legend_handles_labels()
    figure.legend(*looks, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def _draw_family(axes: Axes, cases: list[HardCase]) -> None:
    """Draw one family; the singular case itself is at the left end."""
    smallest = min(case.small for case in cases if case.small)
    near = [case.small or smallest / 100 for case in cases]
    red, star = PACKAGES["symtop_ros"]
    errors = [max(case.error, SMALLEST) for case in cases]
    axes.loglog(near, errors, star, color=red, ms=8, label=CLOSED_FORM)
    for name in dict.fromkeys(name for case in cases for name in case.peers):
        color, marker = PACKAGES[name.replace(",", "").split()[0]]
        points = [
            (x, case.peers[name]) for x, case in zip(near, cases, strict=True) if name in case.peers
        ]
        axes.loglog(*np.array(points).T, marker, color=color, ms=4, label=name)
    limits = [case.limit for case in cases]
    axes.loglog(near, limits, color=INK, lw=1, ls="--", label="rounding of the input")
    axes.set_title(cases[0].family, fontsize=8.5)


DRAWINGS = {
    "work_precision": draw_work_precision,
    "motions": draw_motions,
    "long_times": draw_long_times,
    "arrays": draw_arrays,
    "hard_cases": draw_hard_cases,
}
