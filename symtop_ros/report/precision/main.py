"""`top_report`: measures speed against error, and writes tables and plots."""

from __future__ import annotations

import json
import platform
import sys
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from tqdm import tqdm

from symtop_ros.report.precision.chapters import Form, Results, steps
from symtop_ros.report.precision.document import Circumstances, document
from symtop_ros.report.precision.peers import installed
from symtop_ros.report.precision.peers.peer import Peer
from symtop_ros.report.precision.plots import write_plots
from symtop_ros.report.precision.reference import Reference

PACKAGES = (
    *("numpy", "scipy", "heyoka", "mujoco", "drake", "pin", "exudyn", "diffrax", "jax"),
    "symtop_ros",
)


def measure(folder: Path, form: Form, command: str) -> int:
    """Write report.md, report.json and the plots; return the exit status.

    Returns
    -------
    int
        0; 1 where a file cannot be written, or an error of ours is larger than is promised.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        peers, missing = installed()
        around = Circumstances(command, _machine(), _versions(), missing)
        results = _measured(form, peers)
        _write(folder, results, around)
    except OSError as error:
        print(f"top_report: {error.filename or folder}: {error.strerror}", file=sys.stderr)
        return 1
    print(f"{folder / 'report.md'}, report.json and plots")
    for failure in results.failures:
        print(f"top_report: not as promised: {failure}", file=sys.stderr)
    return 1 if results.failures else 0


def _measured(form: Form, peers: Sequence[Peer]) -> Results:
    results = Results()
    tasks = list(steps(form, peers, results))
    with tqdm(tasks, unit="", leave=False, disable=None) as progress:  # on a terminal only
        for name, step in progress:
            progress.set_description(f"{name:40.40}")
            step()
    return results


def _write(folder: Path, results: Results, around: Circumstances) -> None:
    problem = Reference.read().article[0]
    text = document(results, problem, around)
    (folder / "report.md").write_text(text, encoding="utf-8")
    facts = {**asdict(around), **asdict(results)}
    (folder / "report.json").write_text(json.dumps(facts, indent=1), encoding="utf-8")
    write_plots(results, problem, folder)


def _machine() -> str:
    """Name of the processor, and the system."""
    names = [platform.processor(), platform.machine()]
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.is_file():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{next(filter(None, names), 'an unnamed processor')}, {platform.system()}"


def _versions() -> dict[str, str]:
    found = {"Python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found
