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
from symtop_ros.truth.testset.forms import FORMS
from symtop_ros.truth.testset.score import DESCRIPTIONS, FORMED, VERSION, read_problems
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

`make -C workshop importers` writes this page.

Do programs read the right bodies from the models of the [test
set](../symtop_ros/truth/testset/README.md#descriptions)? Each importer read the models of
{problems} (version {version} of the set) that have a joint, in each
description of the body. The mass, the centre of mass and the inertia tensor of the whole body, in
the frame of the link, were then compared with the numbers of the problem. Each cell has the worst
result of the three bodies. No motion was simulated.

{table}

- "right": the difference is at most 1e-13 of the largest component.
- "to 6 digits": the difference is at most 2e-6. The importer computes in single precision, or it is
  MuJoCo, which gives an empty link the smallest mass that it allows.
- "tensor wrong by": the largest difference of a component of the inertia tensor, divided by the
  largest component; "mass wrong by": the relative difference of the mass.
- "refused": the importer reports an error, ends without a result, or reads no mass. The reasons are
  at the end of the page.
- A dash: the format cannot express the description, or the importer does not read the format.

A format can express the same body in several
[forms](../symtop_ros/truth/testset/README.md#forms). The second table has those of `{formed}`. An
importer that does not support a form should refuse the model; some read a wrong body instead.

{forms}

These models were refused, with the message of the importer:

{refusals}

{date}.
"""


@dataclass(frozen=True)
class Reading:
    """The result of an importer for each file, by its name."""

    importer: Importer
    version: str
    found: dict[str, Any]

    @property
    def name(self) -> str:
        """The importer with its version."""
        return f"{self.importer.name} {self.version}"


def main() -> None:
    """Read, compare, and write the page."""
    with TemporaryDirectory() as folder:
        _write_models(Path(folder))
        readings = [_read(importer, Path(folder)) for importer in IMPORTERS]
    head = ["importer", "format", PLAIN, *(f"`.{each}`" for each in DESCRIPTIONS)]
    text = TEXT.format(
        problems="{}, {} and {}".format(*(f"`{each}`" for each in PROBLEMS)),
        version=VERSION,
        table=format_table(head, [*_list_rows(readings)]),
        formed=FORMED,
        forms=format_table(
            ["form", "format", *(each.name for each in readings)], [*_list_forms(readings)]
        ),
        refusals="\n".join(line for each in readings for line in _list_refusals(each)),
        date=find_date(),
    )
    PAGE.write_text(text, encoding="utf-8")
    print(PAGE.relative_to(ROOT))


def _write_models(folder: Path) -> None:
    for name in {*PROBLEMS, FORMED}:
        command = (Path(sys.executable).with_name("top_testset"), name)
        subprocess.run([*command, "-o", folder / name], check=True, stdout=subprocess.DEVNULL)


def _name(problem: str, description: str, form: str) -> str:
    ending = "" if description == PLAIN else f".{description}"
    return f"{problem}/{name_file(problem + ending, form)}"


def _read(importer: Importer, folder: Path) -> Reading:
    """Return the version of an importer, and what it has of each file."""
    files = [
        _name(problem, description, form)
        for problem in PROBLEMS
        for description in (PLAIN, *DESCRIPTIONS)
        for form in importer.formats
        if (description, form) not in UNSAID
    ]
    files += [_name(FORMED, each, form) for each, form in FORMS if form in importer.formats]
    python = ROOT / ".venv" / importer.place / "bin/python"
    version = _run([python, READ, importer.name], folder)["version"]
    return Reading(importer, version, _read_files([python, READ, importer.name], files, folder))


def _read_files(command: list[object], files: list[str], folder: Path) -> dict[str, Any]:
    """Return what a process reads of files; if it breaks off, of each file in its own one."""
    read = _run([*command, *files], folder)
    if len(files) > 1 and "found" not in read:
        return {name: _read_files(command, [name], folder)[name] for name in files}
    return dict(read.get("found", {files[0]: read}))


def _run(command: list[object], folder: Path) -> dict[str, Any]:
    """Return what a process prints, or why it prints nothing: a reader may end with its process."""
    done = subprocess.run(
        [str(word) for word in command], cwd=folder, check=False, stdout=subprocess.PIPE
    )
    status = done.returncode
    return json.loads(done.stdout) if not status else {"refused": f"it ends with status {status}"}


def _list_rows(readings: list[Reading]) -> Iterator[list[str]]:
    """Yield the verdicts on descriptions, a row for each importer and format."""
    for each in readings:
        for form in each.importer.formats:
            cells = [_judge(each.found, form, name) for name in (PLAIN, *DESCRIPTIONS)]
            yield [each.name, form.upper(), *cells]


def _list_forms(readings: list[Reading]) -> Iterator[list[str]]:
    """Yield the verdicts on forms, a row for each form and format."""
    facts = read_problems()[FORMED].facts
    for name, form in FORMS:
        path, exact = _name(FORMED, name, form), expect(facts, name)
        cells = [judge(each.found[path], exact) if path in each.found else "-" for each in readings]
        yield [f"`.{name}`", form.upper(), *cells]


def _judge(found: dict[str, Any], form: str, description: str) -> str:
    """Return the worst of the verdicts on some bodies."""
    if (description, form) in UNSAID:
        return "-"
    verdicts = [
        judge(found[_name(name, description, form)], expect(facts, description))
        for name, facts in ((name, read_problems()[name].facts) for name in PROBLEMS)
    ]
    return max(verdicts, key=lambda each: ("wrong" in each, each == "refused", len(each), each))


def _list_refusals(reading: Reading) -> Iterator[str]:
    """Yield what is said of the first file of each format that is refused for a reason."""
    for form in reading.importer.formats:
        said: dict[str, str] = {}
        for path, each in reading.found.items():
            if "refused" in each and path.endswith(name_file("", form)):
                said.setdefault(each["refused"], path.partition("/")[2])
        for reason, name in said.items():
            yield f"- {reading.name}, {form.upper()}: `{name}`, {reason}"


if __name__ == "__main__":
    main()
