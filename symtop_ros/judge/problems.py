"""`top_judge --testset`: problems listed, copied, and scored."""

import argparse
import json
import re
import shutil
from hashlib import sha256
from pathlib import Path

from symtop_ros.judge.scoreboard import TABLES, Entry, format_json, format_table, read_entries
from symtop_ros.models.snippets import format_snippets
from symtop_ros.models.world_snippets import format_world_snippets
from symtop_ros.physics import STANDARD_GRAVITY, Body, State
from symtop_ros.testset import score

ALL = "all"  # in place of a name: copies every problem into a folder of its own, or scores them
README = "README.md"
SHARED = ("score.py", "score.mjs", "score.cpp", "LICENSE")
CHECKSUMS = "SHA256SUMS"
INTRODUCTION = """\
# {name}: {what}

A problem of the test set that is described [below](#a-test-set-of-heavy-tops), in a folder that
stands alone: `{name}.json` has all of it, `problems.csv`, `states.csv`, `forces.csv` and
`world.csv` have it as tables, `{name}.mjcf`, `.sdf` and `.urdf` are models. Each of these scores a
trajectory and prints the same:

    python score.py {name} trajectory.csv
    node score.mjs {name} trajectory.csv
    g++ -O2 -std=c++17 score.cpp -o score && ./score {name} trajectory.csv

`sha256sum -c SHA256SUMS` checks the files.{free}

{snippets}
{rest}"""
LINK_OUT = re.compile(r"\[([^]]*)\]\(\.\.[^)]*\)")  # of the README, to files that a copy has not
FREE = """

The body has no weight. `{name}.free.mjcf`, `.free.sdf` and `.free.urdf` hold it by nothing: engines
have code of their own for free bodies, which a ball joint does not reach."""
OF_THE_SET = ("Files", "An example: MuJoCo")  # sections that name files that a copy has not


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
        write = format_json if options.json else format_table
        print(write(entries, problems))
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
    for table in TABLES:
        with (source / table).open(encoding="utf-8") as file:
            rows = [next(file), *(row for row in file if row.startswith(f"{name},"))]
        (folder / table).write_text("".join(rows), encoding="utf-8")
    (folder / README).write_text(_describe(problem, source), encoding="utf-8")
    copied = [*sorted((source / "models").glob(f"{name}.*")), *(source / each for each in SHARED)]
    for each in copied:
        shutil.copy(each, folder / each.name)
    names = [target.name, *TABLES, README, *(each.name for each in copied)]
    sums = [f"{sha256((folder / each).read_bytes()).hexdigest()}  {each}\n" for each in names]
    (folder / CHECKSUMS).write_text("".join(sums), encoding="utf-8")
    names.append(CHECKSUMS)
    print(f"wrote {', '.join(names)} to {folder}")


def _describe(problem: score.Problem, source: Path) -> str:
    """Return the README of a copied problem: how it starts in engines, then that of the set."""
    facts = problem.facts
    body = Body(facts["mass"], facts["arm"], facts["Ix_centre"], facts["Iz"], STANDARD_GRAVITY)
    start = State(facts["orientation"], facts["angular_velocity"])
    duration = facts["times"][-1]
    snippets = format_snippets(facts["name"], start, body, duration)
    readme = (source / README).read_text(encoding="utf-8")
    readme = LINK_OUT.sub(r"\1", readme)
    sections = readme.split("\n## ")
    return INTRODUCTION.format(
        name=facts["name"],
        what=facts["what"],
        free="" if facts["Mgl"] else FREE.format(name=facts["name"]),
        snippets=f"{snippets}\n{format_world_snippets(start, body, duration)}",
        rest="\n## ".join(each for each in sections if not each.startswith(OF_THE_SET)),
    )
