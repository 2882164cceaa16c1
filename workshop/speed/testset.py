"""Scores of the integrators in the test set: each at its best setting within a limit of time."""

import math
import statistics
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from timeit import timeit
from typing import Any

import numpy as np

from symtop_ros.truth.testset.score import FILE, read_problems
from workshop.speed.conditions import describe_conditions
from workshop.speed.peers import CLOSED_FORM, find_peers
from workshop.speed.peers.peer import Peer
from workshop.speed.publish import format_table, group, replace_section, track, write_results
from workshop.speed.reference import ReferenceMotion, read_testset
from workshop.speed.sweep import Measurement, sweep

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
PACKAGES = ("heyoka", "scipy", "mujoco", "drake", "pin", "exudyn")
PROBE = 1.0  # s of the motion
LEVELS = (0, 1, 2, 3, 4, 5)
NAME = "testset"  # of the files, and of the section in the documentation


@dataclass(frozen=True)
class Entry:
    """The best run of an integrator on a problem."""

    peer: str
    problem: str
    level: int  # of the problem
    setting: float  # tolerance, or step in s
    angle: float  # largest error of the attitude at four times in rad
    limits: float  # the same in units of what half an ulp of the inputs changes
    seconds: float  # time to reach the end once


def score_testset(folder: Path, docs: Path | None = None) -> None:
    """Write testset.md and testset.json."""
    peers, _ = find_peers()
    motions = read_testset()
    chosen = [peer for peer in peers if peer.name in PROGRAMS]
    work = [(peer, motion) for peer in chosen for motion in motions]
    entries = [
        asdict(entry)
        for peer, motion in track(work, lambda each: f"{each[0].name}: {each[1].name}")
        for entry in find_best_run(peer, motion)
    ]
    facts = {"conditions": describe_conditions(*PACKAGES), "limit": LIMIT, "entries": entries}
    table = format_scores(facts)
    write_results(NAME, facts, table, folder, docs)
    if docs:
        readme = FILE.parent / "README.md"
        text = replace_section(readme.read_text(encoding="utf-8"), NAME, table)
        readme.write_text(text, encoding="utf-8")
    print(f"{folder / 'testset.md'} and testset.json")


def find_best_run(peer: Peer, motion: ReferenceMotion) -> list[Entry]:
    """Return the best run of a peer within the limit of time, in a list; empty without one."""
    end = motion.times[-1]
    places = [motion.times[k] for k in PLACES]
    in_limits: dict[float, float] = {}  # by the setting

    def run(setting: float) -> Measurement | None:
        # Each peer fails in its own way if a motion is too long or too fast for a setting, so that
        # no narrower exception is possible; its other settings count.
        try:
            solution = peer.prepare(motion.task, setting)
            # A day of motion would take some programs an hour: a part of it comes first.
            part = end if peer.name == CLOSED_FORM else min(end, PROBE)
            seconds = timeit(partial(solution.reach, part), number=1) * end / part
            if seconds > LIMIT:
                return Measurement(setting, math.inf, math.inf, 0, seconds, 0.0)
            seconds = timeit(partial(solution.reach, end), number=1)
            errors = [motion.error(t, solution.reach(t)) for t in places]
        except Exception:
            return None
        errors = np.nan_to_num(errors, nan=np.inf).tolist()
        in_limits[setting] = max(e / motion.limit(t) for t, e in zip(places, errors, strict=True))
        return Measurement(setting, max(errors), statistics.mean(errors), 4, seconds, 0.0)

    points, _ = sweep(peer.settings, run, LIMIT)
    good = [each for each in points if each.seconds <= LIMIT and each.error < math.inf]
    best = min(good, key=lambda each: each.error, default=None)
    if best is None:
        return []
    limits = in_limits[best.setting]
    names = (peer.name, motion.name, motion.level)
    return [Entry(*names, best.setting, best.error, limits, best.seconds)]


def format_scores(facts: dict[str, Any]) -> str:
    """Return the table of a measurement: for each level the median and the worst problem."""
    entries = [Entry(**each) for each in facts["entries"]]
    rows = []
    count = len(read_problems())
    for peer, own in group(entries, lambda entry: entry.peer).items():
        cells = [_summarize([e.angle for e in own if e.level == level]) for level in LEVELS]
        rows.append([peer, *cells, f"{len(own)} of {count}"])
    head = ["median, worst (rad)", *(f"level {level}" for level in LEVELS), "in time"]
    return f"{format_table(head, rows)}\n\n{facts['conditions']}."


def _summarize(angles: list[float]) -> str:
    if not angles:
        return "-"
    return f"{statistics.median(angles):.0e}, {max(angles):.0e}"
