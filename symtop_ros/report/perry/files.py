"""A map as a picture, as a table in Parquet, and in Rerun."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import rerun as rr
import rerun.blueprint as rrb
from matplotlib import colormaps
from matplotlib.figure import Figure

from symtop_ros.report.perry.maps import FACTOR, PerryMap

RELIEF = 250  # points along a side of a relief, at most
SHADES = 0.3  # rad at which the colours end


def draw(perry_map: PerryMap, target: Path | BinaryIO) -> None:
    """Draw what hurrying does to the highest and to the lowest point, as PNG, or as a path says."""
    figure = Figure(figsize=(11, 5), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    found = perry_map.found
    _panel(left, perry_map, found.rise, "highest point")
    image = _panel(right, perry_map, -found.fall, "lowest point")
    left.set_ylabel("precession rate phi' before (rad/s)")
    figure.colorbar(image, ax=[left, right], label="raised by (rad)", extend="both")
    figure.suptitle(f"The precession hurried by {FACTOR:g}, {perry_map.title}")
    left.legend(loc="lower left", fontsize="small")
    figure.savefig(target, dpi=150)


def _panel(axes: Any, perry_map: PerryMap, raised: Any, name: str) -> Any:
    across, phi_dot = perry_map.across, perry_map.phi_dot
    extent = (across[0], across[-1], phi_dot[0], phi_dot[-1])
    image = axes.imshow(
        raised, origin="lower", extent=extent, aspect="auto", cmap="RdBu", vmin=-SHADES, vmax=SHADES
    )
    fails = np.where(perry_map.found.rule_holds, np.nan, 1.0)
    axes.contourf(across, phi_dot, fails, levels=[0.5, 1.5], colors="none", hatches=["..."])
    axes.fill_between([], [], facecolor="none", hatch="...", label="Perry's rule fails")
    axes.contour(across, phi_dot, perry_map.torque, levels=[0.0], colors="k", linewidths=1.5)
    axes.plot([], [], "k", linewidth=1.5, label="regular precession")
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel=perry_map.label, title=name)
    return image


def write_table(perry_map: PerryMap, path: Path) -> None:
    """Write one row for each point, in Parquet."""
    phi_dot, across = np.meshgrid(perry_map.phi_dot, perry_map.across, indexing="ij")
    found = perry_map.found
    columns = {
        "phi_dot": phi_dot,
        "theta" if perry_map.name == "tilt" else "psi_dot": across,
        "highest_before": found.before[0],
        "highest_after": found.after[0],
        "lowest_before": found.before[1],
        "lowest_after": found.after[1],
        "rule_holds": found.rule_holds,
    }
    table = pa.table({name: values.ravel() for name, values in columns.items()})
    pq.write_table(table, path, compression="zstd")


def write_recording(maps: list[PerryMap], path: Path) -> None:
    """Write the maps as a Rerun recording: the change of the highest point as a relief."""
    with rr.RecordingStream("symtop_ros_perry") as recording:
        recording.save(path, default_blueprint=_blueprint(maps))
        for each in maps:
            picture = io.BytesIO()
            draw(each, picture)
            image = rr.EncodedImage(contents=picture.getvalue(), media_type="image/png")
            recording.log(f"{each.name}/map", image, static=True)
            recording.log(f"{each.name}/relief", _relief(each), static=True)


def _blueprint(maps: list[PerryMap]) -> rrb.Blueprint:
    """The pictures on the left, the reliefs on the right."""
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
    """A square of side 2, its height the rise of the highest point in rad."""
    step = -(-len(perry_map.phi_dot) // RELIEF)
    rise = np.clip(perry_map.found.rise[::step, ::step], -1, 1)
    y, x = (np.linspace(-1, 1, size) for size in rise.shape)
    grid = np.stack([*np.meshgrid(x, y), rise], axis=-1).reshape(-1, 3)
    colors = colormaps["RdBu"]((rise.ravel() / SHADES + 1) / 2)
    corner = np.arange(rise.size).reshape(rise.shape)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]
    triangles = np.concatenate(
        [np.stack(each, axis=-1).reshape(-1, 3) for each in ((a, b, c), (b, d, c))]
    )
    return rr.Mesh3D(vertex_positions=grid, triangle_indices=triangles, vertex_colors=colors)
