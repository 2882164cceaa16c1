"""`top_judge --testset`: problems listed, written, and scored."""

import argparse
import json
import re
from collections.abc import Mapping
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Any

from symtop_ros.base.header import make_header
from symtop_ros.physics import STANDARD_GRAVITY, Body, State, Top
from symtop_ros.run.models import FORMATS, FREE_FORMATS, UNSAID, name_file
from symtop_ros.run.models.descriptions import describe
from symtop_ros.run.models.snippets import format_snippets, format_world_snippets
from symtop_ros.truth.judge.judgement import enforce_limit
from symtop_ros.truth.judge.scoreboard import Entry, format_json, format_table, read_entries
from symtop_ros.truth.testset import score
from symtop_ros.truth.testset.tables import format_problems, tabulate

ALL = "all"  # in place of a name: writes every problem into its own folder, or scores them
SOURCE = score.FILE.parent
MODELS = "models"  # the folder of the whole set's models
README = "README.md"
CHECKSUMS = "SHA256SUMS"
INTRODUCTION = """\
# {name}: {what}

A problem of the test set that is described [below](#a-test-set-of-heavy-tops), in a folder that
stands alone: `{name}.json` has all of it, `problems.csv`, `states.csv`, `forces.csv` and
`world.csv` have it as tables, `{name}.mjcf`, `.sdf`, `.urdf` and `.usda` are models, and
`{name}.turned.mjcf` and the like say the same of the body in other words (see Descriptions). This
scores a trajectory, with Python and NumPy:

    python score.py {name} trajectory.csv

`sha256sum -c SHA256SUMS` checks the files.{free}

{snippets}
{world_snippets}
{rest}"""
LINK_OUT = re.compile(r"\[([^]]*)\]\(\.\.[^)]*\)")  # of the README, to files that a copy has not
FREE = """

The body has no weight. `{name}.free.mjcf`, `.free.sdf`, `.free.urdf` and `.free.usda` hold it by
nothing: engines have separate code for free bodies, which a ball joint does not reach."""
OF_THE_SET = ("Files", "An example: MuJoCo")  # sections that name files that a copy has not


def run_testset(options: argparse.Namespace) -> int:
    """List the problems of the test set, score a trajectory, or write the set or a problem."""
    problems = score.read_problems()
    folder = options.output
    if options.testset and options.files:
        return _score(problems, options)
    if options.testset == ALL:
        for name in problems:
            _write_problem(problems, name, (folder or Path()) / name)
    elif options.testset:
        _write_problem(problems, options.testset, folder or Path())
    elif folder:
        _write_set(problems, folder)
    else:
        print(score.list_problems(problems))
    return 0


def _score(problems: dict[str, score.Problem], options: argparse.Namespace) -> int:
    """Score a trajectory, or all of a folder."""
    path: Path = options.files[0]
    header = make_header("scores" if options.testset == ALL else "score", [path])
    header |= {"testset": score.describe_testset()}
    if options.testset == ALL:
        entries = read_entries(problems, path)
        text = format_table(entries, problems)
        print(format_json(header, entries, problems) if options.json else text)
    else:
        entries = [Entry(path.stem, score.score_file(problems, options.testset, path))]
        facts = json.dumps(header | entries[0].facts(), indent=1)
        print(facts if options.json else entries[0].score.format())
    enforce_limit(max(each.error for each in entries), options.max_error)
    return 0


def _write_set(problems: dict[str, score.Problem], folder: Path) -> None:
    """Write all problems as one set, with its models in a separate folder."""
    facts = [each.facts for each in problems.values()]
    models = {name: text for each in facts for name, text in _describe_models(each).items()}
    texts = {
        score.FILE.name: format_problems(facts, STANDARD_GRAVITY, score.VERSION),
        **tabulate(facts),
        **{f"{MODELS}/{name}": text for name, text in models.items()},
    }
    shared = {README: _read_readme(), **_read_shared()}
    _write_files(folder, {**texts, **shared, CHECKSUMS: _sum_up(texts)})
    what = f"the test set {score.VERSION} to {folder}: {len(facts)} problems, {len(models)} models"
    print(f"wrote {what}")


def _write_problem(problems: dict[str, score.Problem], name: str, folder: Path) -> None:
    """Write a problem, its models, and what is needed to score it alone, into a folder."""
    problem = score.find_problem(problems, name)
    texts = {
        f"{name}.json": problem.format_json(),
        **tabulate([problem.facts]),
        README: _introduce(problem.facts),
        **_describe_models(problem.facts),
        **_read_shared(),
    }
    texts[CHECKSUMS] = _sum_up(texts)
    _write_files(folder, texts)
    print(f"wrote {', '.join(texts)} to {folder}")


def _write_files(folder: Path, texts: Mapping[str, str]) -> None:
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def _sum_up(texts: Mapping[str, str]) -> str:
    """Return the checksums of files, in the form of the program sha256sum."""
    return "".join(
        f"{sha256(texts[name].encode()).hexdigest()}  {name}\n" for name in sorted(texts)
    )


def _describe_models(facts: Mapping[str, Any]) -> dict[str, str]:
    """Return the models of a problem in all descriptions; without weight, also with no joint."""
    top = Top(facts["Ix"], facts["Iz"], facts["Mgl"])
    formats = FORMATS if top.Mgl else {**FORMATS, **FREE_FORMATS}
    start, body = _read_motion(facts)
    name = facts["name"]
    texts = {name_file(name, form): write(top, start, body) for form, write in formats.items()}
    for each, (form, write) in product(score.DESCRIPTIONS, formats.items()):
        if (each, form) not in UNSAID:
            described = describe(each, body)
            texts[name_file(f"{name}.{each}", form)] = write(top, start, body, described)
    return texts


def _read_motion(facts: Mapping[str, Any]) -> tuple[State, Body]:
    body = Body(facts["mass"], facts["arm"], facts["Ix_centre"], facts["Iz"], STANDARD_GRAVITY)
    return State(facts["orientation"], facts["angular_velocity"]), body


def _read_shared() -> dict[str, str]:
    return {name: (SOURCE / name).read_text(encoding="utf-8") for name in ("score.py", "LICENSE")}


def _read_readme() -> str:
    """Return the README of the set, without links to files that a copy has not."""
    return LINK_OUT.sub(r"\1", (SOURCE / README).read_text(encoding="utf-8"))


def _introduce(facts: Mapping[str, Any]) -> str:
    """Return the README of a copied problem: how it starts in engines, then that of the set."""
    start, body = _read_motion(facts)
    duration = facts["times"][-1]
    sections = _read_readme().split("\n## ")
    return INTRODUCTION.format(
        name=facts["name"],
        what=facts["what"],
        free="" if facts["Mgl"] else FREE.format(name=facts["name"]),
        snippets=format_snippets(facts["name"], start, body, duration),
        world_snippets=format_world_snippets(start, body, duration),
        rest="\n## ".join(each for each in sections if not each.startswith(OF_THE_SET)),
    )
