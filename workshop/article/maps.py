"""Perry's map: where hurrying the precession raises the top, over whole ranges of tops.

Two maps of the article's top, precession rate against spin rate and against tilt, as pictures, as
Parquet tables, and as one Rerun recording.
"""

import io
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import rerun as rr
import rerun.blueprint as rrb
from matplotlib import colormaps
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.physics import HurryEffect, compare_hurried, theta_torque
from workshop.article.answers.starts import PHI_DOTS, PSI_DOTS, draw_regions
from workshop.article.motions import PSI_DOT, THETA, TOP
from workshop.article.rates import FACTOR

POINTS = 1000  # along each side
THETAS = (0.02, np.pi - 0.02)  # rad; on the vertical itself phi' is undefined
RELIEF_POINTS = 250  # along a side of a relief, at most
# What becomes of the height. The tilt of the kick is a turning point before and after it, as
# theta' = 0: so the motion cannot become higher at one end and lower at the other.
OUTCOMES = {"higher": "#4f8fca", "lower": "#d9634c", "as before": "#ffffff"}
HIGHER, LOWER, SAME = range(len(OUTCOMES))
SAME_ANGLE = 1e-7  # rad: turning angles that differ by less are equal (kernel/rule/verdict.hpp)
COLOR_LIMIT = 0.3  # rad at which the colours end


@dataclass(frozen=True, eq=False)
class PerryMap:
    """One map: a grid of n precession rates and m spin rates or tilts."""

    name: str  # "spin" or "tilt", in the names of its files
    title: str  # the quantity that is held
    label: str  # of the horizontal axis
    across: Real  # values along the horizontal axis: psi' in rad/s, or theta in rad
    phi_dot: Real  # precession rates before the kick, along the vertical axis, in rad/s
    effect: HurryEffect  # effect of the kick, (n, m)
    # Ix theta''/sin(theta) before the kick in N m: zero on the curves of regular precession
    torque: Real


# The quantity that is held, the label of the horizontal axis, and its ends
MAPS = {
    "spin": (f"theta = {THETA:g} rad", "spin rate psi' (rad/s)", PSI_DOTS),
    "tilt": (f"psi' = {PSI_DOT:g} rad/s", "tilt theta (rad)", THETAS),
}


def make_map(name: str) -> PerryMap:
    """Return a map: psi' and phi' at the article's tilt, or theta and phi' at its spin."""
    title, label, ends = MAPS[name]
    across, phi_dot = np.linspace(*ends, POINTS), np.linspace(*PHI_DOTS, POINTS)
    theta, psi_dot = (across, PSI_DOT) if name == "tilt" else (THETA, across)
    grid = theta, phi_dot[:, np.newaxis], psi_dot
    effect = compare_hurried(TOP, *grid, FACTOR)
    torque = theta_torque(TOP, *grid)
    return PerryMap(name, title, label, across, phi_dot, effect, torque)


def write_maps(folder: Path) -> None:
    """Write both maps into a folder."""
    maps = [_write_map(name, folder) for name in MAPS]
    write_recording(maps, folder / "perry.rrd")
    print(f"in Rerun: rerun {folder / 'perry.rrd'}")


def _write_map(name: str, folder: Path) -> PerryMap:
    began = time.perf_counter()
    perry_map = make_map(name)
    seconds = time.perf_counter() - began
    stem = folder / f"perry_{name}"
    for suffix in ("png", "svg"):
        draw_map(perry_map, stem.with_suffix(f".{suffix}"))
    write_table(perry_map, stem.with_suffix(".parquet"))
    effect = perry_map.effect
    misled = effect.rule_holds & (find_outcome(effect) == LOWER)
    print(
        f"{perry_map.title}: {POINTS} x {POINTS} points in {seconds:.2f} s; the rule holds on "
        f"{effect.rule_holds.mean():.1%} of them (theta'' at the kick), though on "
        f"{misled.mean():.1%} the top is lower in the end: {stem}.png, .svg, .parquet",
        flush=True,
    )
    return perry_map


def draw_map(perry_map: PerryMap, target: Path | BinaryIO) -> None:
    """Draw the changes of the turning points and the outcome; PNG, or the format of a suffix."""
    figure = Figure(figsize=(15, 5), layout="constrained")
    left, right, end = figure.subplots(1, 3, sharey=True)
    effect = perry_map.effect
    _draw_panel(left, perry_map, effect.rise, "highest point")
    image = _draw_panel(right, perry_map, -effect.fall, "lowest point")
    left.set_ylabel("precession rate phi' before (rad/s)")
    _draw_outcome(end, perry_map)
    figure.colorbar(image, ax=[left, right], label="raised by (rad)", extend="both")
    figure.suptitle(f"The precession hurried by a factor of {FACTOR:g}, {perry_map.title}")
    left.legend(loc="lower left", fontsize="small")
    figure.savefig(target, dpi=100)


def _extent(perry_map: PerryMap) -> tuple[float, float, float, float]:
    across, phi_dot = perry_map.across, perry_map.phi_dot
    return (float(across[0]), float(across[-1]), float(phi_dot[0]), float(phi_dot[-1]))


def _draw_panel(axes: Any, perry_map: PerryMap, raised: Real, title: str) -> Any:
    across, phi_dot = perry_map.across, perry_map.phi_dot
    extent = _extent(perry_map)
    limits = {"vmin": -COLOR_LIMIT, "vmax": COLOR_LIMIT}
    image = axes.imshow(raised, origin="lower", extent=extent, aspect="auto", cmap="RdBu", **limits)
    fails = np.where(perry_map.effect.rule_holds, np.nan, 1.0)
    axes.contourf(across, phi_dot, fails, levels=[0.5, 1.5], colors="none", hatches=["..."])
    axes.fill_between(
        [], [], facecolor="none", hatch="...", label="rule fails at the kick: theta'' is not lower"
    )
    axes.contour(across, phi_dot, perry_map.torque, levels=[0.0], colors="k", linewidths=1.5)
    axes.plot([], [], "k", linewidth=1.5, label="regular precession")
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel=perry_map.label, title=title)
    return image


def _draw_outcome(axes: Any, perry_map: PerryMap) -> None:
    """Draw what becomes of the height in the end, whatever theta'' is at the kick."""
    effect = perry_map.effect
    extent = _extent(perry_map)
    draw_regions(axes, find_outcome(effect), OUTCOMES, extent, edgecolor="k", lw=0.3)
    misled = effect.rule_holds & (find_outcome(effect) == LOWER)
    title = f"in the end (rule holds, yet lower: {misled.mean():.1%})"
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel=perry_map.label)
    axes.set_title(title, fontsize="medium")
    axes.legend(loc="lower left", fontsize="small")


def find_outcome(effect: HurryEffect) -> Any:
    """Return the place of each point among the `OUTCOMES`."""
    lifts = np.stack([effect.rise, -effect.fall])
    up = (lifts > SAME_ANGLE).any(axis=0)
    down = (lifts < -SAME_ANGLE).any(axis=0)
    return np.where(up, HIGHER, np.where(down, LOWER, SAME))


def write_table(perry_map: PerryMap, file: Path) -> None:
    """Write a Parquet table with one row per point; angles in rad, rates in rad/s."""
    phi_dot, across = np.meshgrid(perry_map.phi_dot, perry_map.across, indexing="ij")
    effect = perry_map.effect
    columns = {
        "phi_dot": phi_dot,
        "theta" if perry_map.name == "tilt" else "psi_dot": across,
        "highest_before": effect.before[0],
        "highest_after": effect.after[0],
        "lowest_before": effect.before[1],
        "lowest_after": effect.after[1],
        "rule_holds": effect.rule_holds,
        "outcome": np.array(list(OUTCOMES))[find_outcome(effect)],
    }
    table = pa.table({name: values.ravel() for name, values in columns.items()})
    pq.write_table(table, file, compression="zstd")


def write_recording(maps: list[PerryMap], file: Path) -> None:
    """Write the maps as a Rerun recording: pictures, and the change of the highest point in 3D."""
    with rr.RecordingStream("symtop_ros_perry") as recording:
        recording.save(file, default_blueprint=_blueprint(maps))
        for each in maps:
            picture = io.BytesIO()
            draw_map(each, picture)
            image = rr.EncodedImage(contents=picture.getvalue(), media_type="image/png")
            recording.log(f"{each.name}/map", image, static=True)
            recording.log(f"{each.name}/relief", _relief(each), static=True)


def _blueprint(maps: list[PerryMap]) -> rrb.Blueprint:
    """Return the layout: the pictures on the left, the reliefs on the right."""
    rows = [
        rrb.Horizontal(
            rrb.Spatial2DView(origin=f"{each.name}/map", name=each.title),
            rrb.Spatial3DView(origin=f"{each.name}/relief", name="rise of the highest point"),
            column_shares=[3, 2],
        )
        for each in maps
    ]
    return rrb.Blueprint(rrb.Vertical(*rows), collapse_panels=True)


def _relief(perry_map: PerryMap) -> Any:
    """Return a square surface of side 2 whose height is the rise of the highest point in rad."""
    step = -(-len(perry_map.phi_dot) // RELIEF_POINTS)
    rise = np.clip(perry_map.effect.rise[::step, ::step], -1, 1)
    y, x = (np.linspace(-1, 1, size) for size in rise.shape)
    grid = np.stack([*np.meshgrid(x, y), rise], axis=-1).reshape(-1, 3)
    colors = colormaps["RdBu"]((rise.ravel() / COLOR_LIMIT + 1) / 2)
    corner = np.arange(rise.size).reshape(rise.shape)
    # Each cell of the grid, with the corners a b above c d, is two triangles.
    a = corner[:-1, :-1]
    b = corner[:-1, 1:]
    c = corner[1:, :-1]
    d = corner[1:, 1:]
    triangles = np.concatenate(
        [np.stack(each, axis=-1).reshape(-1, 3) for each in ((a, b, c), (b, d, c))]
    )
    return rr.Mesh3D(vertex_positions=grid, triangle_indices=triangles, vertex_colors=colors)
