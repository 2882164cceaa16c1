"""Scores of the integrators in the test set: each at its best setting within a limit of time."""

from __future__ import annotations

import json
import statistics
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from symtop_ros.physics import State, Top
from symtop_ros.report.document import format_table
from symtop_ros.report.peers import CLOSED_FORM, installed
from symtop_ros.report.peers.peer import Peer, Solution, Task
from symtop_ros.report.publish import replace_section, write_figures
from symtop_ros.testset.score import FILE, Problem, read_problems

PLACES = (4, 9, 14, 19)  # quarters of the duration: most peers start anew for each time
LIMIT = 0.2  # s for a run to the end of a problem
# One form of each program; those left out compile for seconds, or are much like these.
PROGRAMS = (
    "symtop_ros, closed form",
    "heyoka, quaternion",
    "SciPy DOP853, Euler angles",
    "MuJoCo RK4",
    "Drake RK5, quaternion",
    "Pinocchio, RK4 in Python",
    "EXUDYN RK67",
)
PROBE = 1.0  # s of the motion
GROWTH = 4.0  # a finer setting is expected to take so many times as long
LEVELS = (1, 2, 3, 4, 5)
SECTION = "testset"


@dataclass(frozen=True)
class Entry:
    """The best run of an integrator on a problem."""

    peer: str  # their names
    problem: str  # their names
    level: int  # of the problem
    setting: float  # tolerance, or step in s
    angle: float  # largest error of the attitude at four times in rad
    limits: float  # the same in units of what half an ulp of the inputs does
    seconds: float  # time to reach the end once


def score_testset(folder: Path, docs: Path | None = None, limit: float = LIMIT) -> int:
    """Write testset.md and testset.json; return the exit status."""
    peers, _ = installed()
    chosen = [peer for peer in peers if peer.name in PROGRAMS]
    work = [(peer, problem) for peer in chosen for problem in read_problems().values()]
    entries: list[Entry] = []
    with tqdm(work, unit="", leave=False, disable=None) as progress:
        for peer, problem in progress:
            progress.set_description(f"{peer.name}: {problem.facts['name']:24.24}")
            entries += measure(peer, problem, limit)
    folder.mkdir(parents=True, exist_ok=True)
    facts = {"limit": limit, "entries": [asdict(entry) for entry in entries]}
    (folder / "testset.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / "testset.md").write_text(format_scores(facts) + "\n", encoding="utf-8")
    if docs:
        publish_scores(facts, docs)
    print(f"{folder / 'testset.md'} and testset.json")
    return 0


def measure(peer: Peer, problem: Problem, limit: float) -> list[Entry]:
    """Return the best run of a peer within the limit of time, as a list; empty if none is."""
    facts = problem.facts
    start = State(facts["orientation"], facts["angular_velocity"])
    task = Task(Top(facts["Ix"], facts["Iz"], facts["Mgl"]), start)
    best: list[Entry] = []
    for setting in peer.settings:
        # Each peer fails in its own way if a motion is too long or too fast for a setting, so that
        # no narrower exception is possible; its other settings count.
        try:
            solution = peer.prepare(task, setting)
            if peer.name != CLOSED_FORM and _expect(solution, problem.times[-1]) > limit:
                break
            began = time.perf_counter()
            last = solution.reach(problem.times[-1])
            seconds = time.perf_counter() - began
            if seconds > limit:
                break
            states = [solution.reach(problem.times[k]) for k in PLACES[:-1]]
            angles, in_limits = problem.measure([*states, last], PLACES)
        except Exception:
            continue
        angle = float(np.nan_to_num(angles, nan=np.inf).max())
        if angle < min([each.angle for each in best], default=np.inf):
            names = peer.name, facts["name"], facts["level"]
            best = [Entry(*names, setting, angle, float(in_limits.max()), seconds)]
        if GROWTH * seconds > limit:
            break
    return best


def _expect(solution: Solution, end: float) -> float:
    """Return the seconds that a run to the end is expected to take, from one of its begin.

    A day of motion would take some programs an hour.
    """
    span = min(end, PROBE)
    began = time.perf_counter()
    solution.reach(span)
    return (time.perf_counter() - began) * end / span


def format_scores(facts: dict[str, Any]) -> str:
    """Return the table of a measurement: for each level the median and the worst problem."""
    entries = [Entry(**each) for each in facts["entries"]]
    rows = []
    for peer in dict.fromkeys(entry.peer for entry in entries):
        own = [entry for entry in entries if entry.peer == peer]
        cells = [_summarize([e.angle for e in own if e.level == level]) for level in LEVELS]
        rows.append([peer, *cells, f"{len(own)} of 60"])
    head = ["median, worst (rad)", *(f"level {level}" for level in LEVELS), "in time"]
    return format_table(head, rows)


def _summarize(angles: list[float]) -> str:
    if not angles:
        return "-"
    return f"{statistics.median(angles):.0e}, {max(angles):.0e}"


def publish_scores(facts: dict[str, Any], docs: Path) -> None:
    """Write the table into the documentation and into the README of the test set."""
    table = format_scores(facts)
    write_figures({"testset": facts}, {SECTION: table}, docs)
    path = FILE.parent / "README.md"
    text = replace_section(path.read_text(encoding="utf-8"), SECTION, table)
    path.write_text(text, encoding="utf-8")
