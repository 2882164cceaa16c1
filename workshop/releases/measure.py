"""Measure releases: the oldest, the newest, every fifth, and those between two that differ.

Results are kept in .venv/releases, so that a second run continues.
"""

import contextlib
import io
import json
import math
import shutil
import statistics
import sys
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from symtop_ros.judge.main import main as judge
from symtop_ros.testset.score import read_problems, score_file
from workshop.releases.engines import Engine, list_cases
from workshop.releases.environments import HOME, execute, explain, install, list_releases, order

LEVELS = (0, 1)
EVERY = 5  # releases
JUMP = 3.0  # a factor between scores
FLOOR = 1e-9  # rad; below it a score is rounding
LIMIT = 120  # s for the run of a release
Row = dict[str, Any]  # {"scores": {name: rad}} or {"reason": text}


def measure_engine(engine: Engine) -> dict[str, Row]:
    """Return the results of the releases of an engine that were chosen, in their order."""
    kept = HOME / f"{engine.name}.json"
    rows: dict[str, Row] = json.loads(kept.read_text()) if kept.exists() else {}
    releases = list_releases(engine)
    while (release := choose_next([*releases], rows)) is not None:
        rows[release] = measure_release(engine, release, releases[release])
        print(
            engine.name, release, rows[release].get("reason", "scored"), file=sys.stderr, flush=True
        )
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(rows, indent=1))
    return {each: rows[each] for each in sorted(rows, key=order)}


def choose_next(releases: Sequence[str], rows: Mapping[str, Row]) -> str | None:
    """Return the release to run next, or None: first a sample, then between those that differ."""
    for release in [*releases[:1], *releases[-1:], *releases[::EVERY]]:
        if release not in rows:
            return release
    good = [each for each in releases if "scores" in rows.get(each, {"scores": {}})]
    done = [place for place, each in enumerate(good) if each in rows]
    for first, last in pairwise(done):
        if last - first > 1 and find_jumps(rows[good[first]], rows[good[last]]):
            return good[(first + last) // 2]
    return None


def find_jumps(before: Row, after: Row) -> list[str]:
    """Return the names of the scores that differ by a factor of three, the largest change first."""
    old, new = before["scores"], after["scores"]
    changes = {
        name: abs(math.log(max(new[name], FLOOR) / max(old[name], FLOOR)))
        for name in old
        if name in new
    }
    found = [name for name, change in changes.items() if change >= math.log(JUMP)]
    return sorted(found, key=lambda name: -changes[name])


def measure_release(engine: Engine, release: str, program: Path) -> Row:
    """Return the scores of a release, or the reason why it has none."""
    place = HOME / f"{engine.name}-{release}"
    shutil.rmtree(place, ignore_errors=True)
    work = place / "cases"
    work.mkdir(parents=True)
    try:
        reason = install(engine, release, program, place)
        return {"reason": f"does not install: {reason}"} if reason else run(engine, program, work)
    finally:
        shutil.rmtree(place, ignore_errors=True)


def run(engine: Engine, program: Path, work: Path) -> Row:
    """Run the cases of an engine in a folder of its environment."""
    models = write_models(HOME / "testset")
    cases = list_cases(engine, LEVELS, frozenset(each.name for each in models.iterdir()))
    for case in cases:
        case["model"] = str(models / case["model"])
    (work / "cases.json").write_text(json.dumps(cases))
    script = work / ("run.py" if engine.is_python else "run.mjs")
    script.write_text(engine.program)
    result = execute([str(program), str(script), str(work.parent)], work, LIMIT)
    scores = read_scores(work, cases)
    return {"scores": scores} if scores else {"reason": f"does not run: {explain(result)}"}


def write_models(folder: Path) -> Path:
    """Return the folder of the models of the test set."""
    if not (folder / "models").exists():
        with contextlib.redirect_stdout(io.StringIO()):
            judge(["--testset", "-o", str(folder)])
    return folder / "models"


def read_scores(work: Path, cases: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Return the median and worst error of each level, and the error of each description."""
    errors = _read_errors(work)
    plain = [case for case in cases if "." not in case["name"]]
    described = {case["name"].partition(".")[0] for case in cases if "." in case["name"]}
    scores: dict[str, float] = {}
    for variant, own in errors.items():
        for level in LEVELS:
            found = [own.get(case["name"]) for case in plain if case["level"] == level]
            known = [each for each in found if each is not None]
            if found and len(known) == len(found):
                scores[f"{variant}: level {level}, median"] = statistics.median(known)
                scores[f"{variant}: level {level}, worst"] = max(known)
        for name in sorted(own):
            if name.partition(".")[0] in described:
                scores[f"{variant}: {name}"] = own[name]
    return scores


def _read_errors(work: Path) -> dict[str, dict[str, float]]:
    """Return the largest error of each trajectory, by the variant and the case."""
    problems, errors = read_problems(), dict[str, dict[str, float]]()
    for path in sorted(work.glob("*.csv")):
        variant, _, name = path.stem.partition(".")
        try:
            error = float(score_file(problems, name, path).angles.max())
        except ValueError:  # not a number: no attitude is wrong by more than that
            error = math.pi
        errors.setdefault(variant, {})[name] = error
    return errors
