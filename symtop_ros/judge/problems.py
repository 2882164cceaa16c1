"""`top_judge --testset`: problems listed, copied, and scored."""

import argparse
import json
import shutil
from pathlib import Path

from symtop_ros.judge.scoreboard import Entry, format_json, format_table, read_entries
from symtop_ros.testset import score

ALL = "all"  # in place of a name: copies every problem into a folder of its own, or scores them
STATES = "states.csv"  # exact states of all problems; in a copy, those of its own
SHARED = ("score.py", "README.md", "LICENSE")


def run_testset(options: argparse.Namespace) -> int:
    """List the problems of the test set, score a trajectory, or copy a problem."""
    problems = score.read_problems()
    if not options.testset:
        print(score.list_problems(problems))
    elif options.files:
        return _score(problems, options)
    elif options.testset == ALL:
        for name in problems:
            _copy(problems, name, (options.output or Path()) / name)
    else:
        _copy(problems, options.testset, options.output or Path())
    return 0


def _score(problems: dict[str, score.Problem], options: argparse.Namespace) -> int:
    """Score a trajectory, or all of a folder."""
    path: Path = options.files[0]
    if options.testset == ALL:
        entries = read_entries(problems, path)
        print(format_json(entries) if options.json else format_table(entries))
    else:
        entries = [Entry(path.stem, score.score_file(problems, options.testset, path))]
        facts = json.dumps(entries[0].facts(), indent=1)
        print(facts if options.json else entries[0].score.format())
    worst = max(each.error for each in entries)
    return int(bool(options.max_error) and worst > options.max_error)


def _copy(problems: dict[str, score.Problem], name: str, folder: Path) -> None:
    """Write a problem, its models, and what is needed to score it alone, into a folder."""
    problem = score.find_problem(problems, name)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{name}.json"
    target.write_text(problem.format_json(), encoding="utf-8")
    source = score.FILE.parent
    states = folder / STATES
    with (source / STATES).open(encoding="utf-8") as file:
        rows = [next(file), *(row for row in file if row.startswith(f"{name},"))]
    states.write_text("".join(rows), encoding="utf-8")
    copied = [*sorted((source / "models").glob(f"{name}.*")), *(source / each for each in SHARED)]
    for each in copied:
        shutil.copy(each, folder / each.name)
    print(f"wrote {', '.join([target.name, STATES, *(each.name for each in copied)])} to {folder}")
