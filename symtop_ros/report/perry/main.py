"""`top_report --map`: draws Perry's maps and writes them down."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

from symtop_ros.report.perry.files import draw, write_recording, write_table
from symtop_ros.report.perry.maps import PerryMap, over_spin, over_tilt


def chart(folder: Path, points: int) -> int:
    """Write the maps of points x points into a folder; return the exit status."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        maps = [_written(make, folder, points) for make in (over_spin, over_tilt)]
        write_recording(maps, folder / "perry.rrd")
    except OSError as error:
        print(f"top_report: {folder}: {error.strerror or error}", file=sys.stderr)
        return 1
    print(f"in Rerun: rerun {folder / 'perry.rrd'}")
    return 0


def _written(make: Callable[[int], PerryMap], folder: Path, points: int) -> PerryMap:
    began = time.perf_counter()
    found = make(points)
    seconds = time.perf_counter() - began
    name = folder / f"perry_{found.name}"
    for suffix in ("png", "svg"):
        draw(found, name.with_suffix(f".{suffix}"))
    write_table(found, name.with_suffix(".parquet"))
    share = found.found.rule_holds.mean()
    print(f"{found.title}: {points} x {points} points in {seconds:.2f} s; ", end="")
    print(f"the rule holds on {share:.1%} of them: {name}.png, .svg, .parquet", flush=True)
    return found
