"""The measurement of `make -C workshop report`: it runs benchmarks, and writes tables and plots."""

import platform
import sys
from dataclasses import asdict, replace
from pathlib import Path

from symtop_ros import __version__
from workshop.pictures.pack import pack
from workshop.speed.benchmarks import FULL, QUICK, Results, Scope, list_steps
from workshop.speed.conditions import find_date, find_load, find_machine, find_versions
from workshop.speed.document import Environment, format_chapters, format_document, format_summary
from workshop.speed.many import NAME as MANY
from workshop.speed.many import tabulate
from workshop.speed.peers import find_peers
from workshop.speed.plots import DRAWINGS, write_plots
from workshop.speed.publish import publish, track, write_results
from workshop.speed.reference import Reference
from workshop.speed.summary import AHEAD, format_measured, format_others_ahead
from workshop.speed.summary import NAME as MEASURED

PACKAGES = (
    "numpy",
    "scipy",
    "heyoka",
    "CyRK",
    "mujoco",
    "drake",
    "pin",
    "exudyn",
    "diffrax",
    "jax",
)


def measure_speed(folder: Path, docs: Path | None, full: bool, limit: float | None) -> int:
    """Measure in one of both scopes, maybe with another limit of time (s) for a run."""
    scope = FULL if full else QUICK
    command = "make -C workshop report ARGS=--full" if full else "make -C workshop report"
    if limit:
        scope = replace(scope, limit=limit)
        command = f"python -m workshop speed --limit {limit:g}"
    return measure(folder, scope, command, docs)


def measure(folder: Path, scope: Scope, command: str, docs: Path | None = None) -> int:
    """Write report.md, report.json and the plots; return the exit status."""
    peers, missing = find_peers()
    versions = {
        "Python": platform.python_version(),
        "symtop_ros": __version__,
        **find_versions(PACKAGES),
    }
    environment = Environment(command, find_machine(), find_date(), versions, missing, scope.limit)
    results = Results()
    for _, work in track(list(list_steps(scope, peers, results)), lambda step: step[0]):
        work()
        _write_tables(folder, results, environment)  # what is measured can be read at once
    _write(folder, results, replace(environment, load=find_load()), docs)
    print(f"{folder / 'report.md'}, report.json and plots")
    failures = results.list_failures()
    for failure in failures:
        print(f"workshop: above the limit: {failure}", file=sys.stderr)
    return 1 if failures else 0


def _write_tables(folder: Path, results: Results, environment: Environment) -> str:
    text = format_document(results, Reference.read().article[0], environment)
    (folder / "report.md").write_text(text + "\n", encoding="utf-8")
    return text


def _write(folder: Path, results: Results, environment: Environment, docs: Path | None) -> None:
    text = _write_tables(folder, results, environment)
    motion = Reference.read().article[0]
    facts = {"environment": asdict(environment), "results": asdict(results)}
    write_results("report", facts, text, folder)
    write_plots(results, motion, folder)
    if docs:
        chapters = format_chapters(results, motion, environment)
        summary = format_summary(results, motion)
        tables = {"chapters": chapters, "summary": summary, MANY: tabulate(results.many)}
        tables |= {
            MEASURED: format_measured(results, motion),
            AHEAD: format_others_ahead(results),
        }
        publish(tables, docs)
        for name in DRAWINGS:
            (docs / f"{name}.png").write_bytes(pack(folder / f"{name}.png"))
