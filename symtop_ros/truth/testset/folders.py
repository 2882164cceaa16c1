"""The folders that `top_testset -o` writes: the whole set, or a problem that stands alone."""

import re
from collections.abc import Mapping
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Any

from symtop_ros.physics import DEFAULT_GRAVITY, Body, State, Top
from symtop_ros.run.models import FORMATS, FREE_FORMATS, UNSAID, name_file
from symtop_ros.run.models.descriptions import describe
from symtop_ros.truth.testset import score
from symtop_ros.truth.testset.forms import write_forms
from symtop_ros.truth.testset.snippets import format_snippets, format_world_snippets
from symtop_ros.truth.testset.tables import format_problems, tabulate

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


def write_set(problems: dict[str, score.Problem], folder: Path) -> None:
    """Write all problems as one set, with its models in a separate folder."""
    facts = [each.facts for each in problems.values()]
    models = {name: text for each in facts for name, text in _describe_models(each).items()}
    texts = {
        score.FILE.name: format_problems(facts, DEFAULT_GRAVITY, score.VERSION),
        **tabulate(facts),
        **{f"{MODELS}/{name}": text for name, text in models.items()},
    }
    shared = {README: _read_readme(), **_read_shared()}
    _write_files(folder, {**texts, **shared, CHECKSUMS: _sum_up(texts)})
    what = f"the test set {score.VERSION} to {folder}: {len(facts)} problems, {len(models)} models"
    print(f"wrote {what}")


def write_problem(problems: dict[str, score.Problem], name: str, folder: Path) -> None:
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
    if name == score.FORMED:
        forms = write_forms(top, start, body).items()
        texts |= {name_file(f"{name}.{each}", form): text for (each, form), text in forms}
    return texts


def _read_motion(facts: Mapping[str, Any]) -> tuple[State, Body]:
    body = Body(facts["mass"], facts["arm"], facts["Ix_centre"], facts["Iz"], DEFAULT_GRAVITY)
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
