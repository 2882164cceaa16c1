"""The figures of the documentation: one file, from which every table in it is written.

A table stands between two comments that name it, `<!-- figures: NAME -->` and
`<!-- end of figures -->`. The text around it is written by hand.
"""

import json
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, TypeVar

from tqdm import tqdm

from workshop.speed.benchmarks import Results
from workshop.speed.document import Environment, format_chapters, format_summary
from workshop.speed.plots import NAMES
from workshop.speed.reference import Reference

FIGURES = "figures.json"
Work = TypeVar("Work")
END = "<!-- end of figures -->"


def collect_facts(results: Results, environment: Environment) -> dict[str, Any]:
    """Return all measurements, as values of a JSON file."""
    return {"environment": asdict(environment), "results": asdict(results)}


def format_sections(facts: dict[str, Any]) -> dict[str, str]:
    """Return the text of each section by its name."""
    results, environment = (
        Results.from_facts(facts["results"]),
        Environment(**facts["environment"]),
    )
    motion = Reference.read().article[0]
    return {
        "chapters": format_chapters(results, motion, environment),
        "summary": format_summary(results, motion),
    }


def find_section(text: str, name: str) -> str | None:
    r"""Return the text between the comments of a section, or None."""
    _, begin, rest = text.partition(f"<!-- figures: {name} -->")
    return rest.partition(END)[0].strip() if begin else None


def replace_section(text: str, name: str, content: str) -> str:
    """Return a text with a section replaced; unchanged if it has no such section."""
    head, begin, rest = text.partition(f"<!-- figures: {name} -->")
    if not begin:
        return text
    return f"{head}{begin}\n{content}\n{END}{rest.partition(END)[2]}"


def publish(folder: Path, docs: Path) -> None:
    """Write figures, tables and plots of a report into the documentation."""
    facts = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    publish_facts(facts, format_sections(facts), docs)
    for name in NAMES:
        shutil.copy(folder / f"{name}.svg", docs)


def write_results(
    name: str, facts: dict[str, Any], text: str, folder: Path, docs: Path | None = None
) -> None:
    """Write figures as NAME.json and their text as NAME.md, and both into the documentation."""
    (folder / f"{name}.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / f"{name}.md").write_text(text + "\n", encoding="utf-8")
    if docs:
        publish_facts({name: facts}, {name: text}, docs)


def track(work: Sequence[Work], describe: Callable[[Work], str]) -> Iterator[Work]:
    """Yield pieces of work, with a progress bar on a terminal and a line for each elsewhere."""
    if not sys.stderr.isatty():
        for number, each in enumerate(work, 1):
            print(f"{number} of {len(work)}: {describe(each)}", file=sys.stderr, flush=True)
            yield each
        return
    with tqdm(work, unit="", leave=False) as progress:
        for each in progress:
            progress.set_description(f"{describe(each):60.60}")
            yield each


def publish_facts(facts: dict[str, Any], sections: dict[str, str], docs: Path) -> None:
    """Write figures into the documentation; those of other commands stay."""
    path = docs / FIGURES
    others = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    path.write_text(json.dumps({**others, **facts}, indent=1) + "\n", encoding="utf-8")
    for page in (*docs.glob("*.md"), docs.parent / "README.md"):
        before = after = page.read_text(encoding="utf-8")
        for name, content in sections.items():
            after = replace_section(after, name, content)
        if after != before:
            page.write_text(after, encoding="utf-8")
