"""A map of ten million tops on Dask: the tilt of each after a time, by its start.

    pip install distributed
    python examples/map_on_dask.py                          # two workers on this machine
    python examples/map_on_dask.py --scheduler tcp://HOST:8786   # a cluster that is running

Each point of the map is another motion: a top of the article that is let go at an angle, with a
spin. A worker takes a block of rows and returns their tilts; it needs this package and nothing of
the others. The address of a scheduler is all that changes from one machine to many.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster, as_completed
from numpy.typing import NDArray

from symtop_ros.physics import Motions, State, Top

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
TILTS = (0.05, 1.5)  # rad, from the first row to the last
SPINS = (20.0, 400.0)  # rad/s, from the first column to the last
BLOCK = 50_000  # motions of a task: less than a second, and some 50 MB of a worker
Tilts = NDArray[np.float32]


def compute_rows(first: int, last: int, size: int, seconds: float) -> Tilts:
    """Return the tilts (rows, size) in rad after some seconds, of the rows first to last - 1.

    Examples
    --------
    >>> compute_rows(0, 2, 4, 10.0).shape
    (2, 4)
    """
    theta = np.linspace(*TILTS, size)[first:last, np.newaxis]
    spin = np.linspace(*SPINS, size)
    motions = Motions(TOP, State.from_euler(theta=theta, psi_dot=spin))
    return np.asarray(motions.at(seconds).euler_angles.theta, dtype=np.float32)


def compute_map(client: Client, size: int, seconds: float) -> Tilts:
    """Return the tilts (size, size), computed by the workers of a client."""
    tilts = np.empty((size, size), dtype=np.float32)
    rows = max(1, BLOCK // size)
    tasks = {
        client.submit(compute_rows, first, min(first + rows, size), size, seconds): first
        for first in range(0, size, rows)
    }
    for task, block in as_completed(list(tasks), with_results=True):
        tilts[tasks[task] : tasks[task] + len(block)] = block
        task.release()
    return tilts


def main(args: Sequence[str] | None = None) -> int:
    """Compute the map and print how long it took; return 0."""
    options = _parser().parse_args(args)
    size = math.isqrt(options.motions)
    with open_client(options.scheduler, options.workers) as client:
        workers = len(client.scheduler_info(n_workers=-1)["workers"])
        begin = time.perf_counter()
        tilts = compute_map(client, size, options.seconds)
        taken = time.perf_counter() - begin
    print(
        f"{tilts.size} motions in {taken:.1f} s on {workers} workers, "
        f"{taken / tilts.size * 1e6:.2f} us each; "
        f"tilts of {tilts.min():.3f} to {tilts.max():.3f} rad"
    )
    if options.output:
        np.save(options.output, tilts)
    return 0


def open_client(scheduler: str | None, workers: int) -> Client:
    """Return a client of a running cluster, or of one on this machine that ends with it."""
    if scheduler:
        return Client(scheduler)
    # A thread for each process: Python between the calls of the kernel does not run in parallel.
    return Client(LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Tilts of many tops, computed on Dask.")
    parser.add_argument(
        "--motions", type=int, default=10_000_000, help="approximate number, default 1e7"
    )
    parser.add_argument(
        "--seconds", type=float, default=10.0, help="time of the motion in s, default 10"
    )
    parser.add_argument("--workers", type=int, default=2, help="on this machine, default 2")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a running cluster instead")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="the map, as .npy")
    return parser


if __name__ == "__main__":
    sys.exit(main())
