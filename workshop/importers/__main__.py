"""Write docs/truth_importers.md: python -m workshop.importers, or make -C workshop importers.

Each importer reads the models of some problems in its own environment. What it has then of mass,
centre of mass and moments is compared with the numbers of the problem.
"""

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from symtop_ros.run.models import UNSAID, name_file
from symtop_ros.truth.testset.score import DESCRIPTIONS, VERSION, read_problems
from workshop.importers.compare import expect, judge
from workshop.speed.conditions import find_date
from workshop.speed.publish import format_table

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/truth_importers.md"
READ = Path(__file__).with_name("read.py")
PROBLEMS = ("free_rod_fast", "cusps", "flat_disc")  # slender, the article's, and flat
PLAIN = "plain"


@dataclass(frozen=True)
class Importer:
    """A program that reads models, its environment in .venv, and the formats that it reads."""

    name: str
    place: str
    formats: tuple[str, ...]


IMPORTERS = (
    Importer("mujoco", "", ("mjcf", "urdf")),
    Importer("mujoco", "mujoco-3.12", ("mjcf", "urdf")),
    Importer("pinocchio", "", ("mjcf", "urdf")),
    Importer("drake", "", ("mjcf", "sdf", "urdf")),
    Importer("pybullet", "importers", ("mjcf", "sdf", "urdf")),
    Importer("newton", "importers", ("mjcf", "urdf", "usd")),
    Importer("usd-core", "importers", ("usd",)),
)
TEXT = """# Which importer reads which description

`make -C workshop importers` writes this page. Programs read the models of {problems} of
the [test set](../symtop_ros/truth/testset/README.md#descriptions) {version}, those with a joint.
What each then has of mass, centre of mass and moments of the whole body, in the frame of the link,
is compared with the numbers of the problem: of the three bodies the worst is shown. Nothing is
integrated here.

{table}

"Right" is 1e-13 of the largest component, "to 6 digits" 2e-6: single precision, or the least mass
that MuJoCo gives to an empty link. A dash: the format cannot say it.

{refusals}

{date}.
"""


def main() -> None:
    """Read, compare, and write the page."""
    with TemporaryDirectory() as folder:
        _write_models(Path(folder))
        rows, refusals = [], []
        for importer in IMPORTERS:
            version, found = _read(importer, Path(folder))
            for form in importer.formats:
                cells = [_judge(found, form, each) for each in (PLAIN, *DESCRIPTIONS)]
                rows.append([f"{importer.name} {version}", form.upper(), *cells])
                if reason := next(_list_refusals(found, form), ""):
                    refusals.append(f"- {importer.name} {version}, {form.upper()}: {reason}")
    head = ["importer", "format", PLAIN, *(f"`.{each}`" for each in DESCRIPTIONS)]
    text = TEXT.format(
        problems="{}, {} and {}".format(*(f"`{each}`" for each in PROBLEMS)),
        version=VERSION,
        table=format_table(head, rows),
        refusals="What is said where a model is refused:\n\n" + "\n".join(refusals),
        date=find_date(),
    )
    PAGE.write_text(text, encoding="utf-8")
    print(PAGE.relative_to(ROOT))


def _write_models(folder: Path) -> None:
    for name in PROBLEMS:
        command = (Path(sys.executable).with_name("top_testset"), name)
        subprocess.run([*command, "-o", folder / name], check=True, stdout=subprocess.DEVNULL)


def _name(problem: str, description: str, form: str) -> str:
    ending = "" if description == PLAIN else f".{description}"
    return f"{problem}/{name_file(problem + ending, form)}"


def _read(importer: Importer, folder: Path) -> tuple[str, dict[str, Any]]:
    """Return the version of an importer, and what it has of each file."""
    files = [
        _name(problem, description, form)
        for problem in PROBLEMS
        for description in (PLAIN, *DESCRIPTIONS)
        for form in importer.formats
        if (description, form) not in UNSAID
    ]
    python = ROOT / ".venv" / importer.place / "bin/python"
    done = subprocess.run(
        [python, READ, importer.name, *files], cwd=folder, check=True, stdout=subprocess.PIPE
    )
    found = json.loads(done.stdout)
    return found["version"], found["found"]


def _judge(found: dict[str, Any], form: str, description: str) -> str:
    """Return the worst of the verdicts on some bodies."""
    if (description, form) in UNSAID:
        return "-"
    verdicts = [
        judge(found[_name(name, description, form)], expect(facts, description))
        for name, facts in ((name, read_problems()[name].facts) for name in PROBLEMS)
    ]
    return max(verdicts, key=lambda each: ("wrong" in each, each == "refused", len(each), each))


def _list_refusals(found: dict[str, Any], form: str) -> Iterator[str]:
    for path, each in found.items():
        if "refused" in each and path.endswith(name_file("", form)):
            yield f"`{path.partition('/')[2]}`, {each['refused']}"


if __name__ == "__main__":
    main()
