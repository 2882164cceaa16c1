"""Tables in Markdown, and their places in the documentation, which commands write anew.

Tables are narrow enough to be read without scrolling sideways. One that is written into a page of
the documentation stands between two comments that name it, `<!-- figures: NAME -->` and
`<!-- end of figures -->`, with a seal (provenance.py).
"""

import json
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

import yaml
from tqdm import tqdm

from workshop.speed.provenance import seal

Work = TypeVar("Work")
CHAPTERS: dict[str, list[str | list[str]]] = yaml.safe_load(
    Path(__file__).with_name("chapters.yaml").read_text(encoding="utf-8")
)
END = "<!-- end of figures -->"
COLUMNS = 7  # of one table at most


def format_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; the first column is aligned left, the others right."""
    lines = [head, ["---", *["--:"] * (len(head) - 1)], *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def format_tables(head: Sequence[str], rows: Sequence[Sequence[str]], kept: int = 1) -> str:
    """Return a table, as several ones below each other if it has more than `COLUMNS` columns.

    Each of these begins with the columns that are kept, and has about as many others.
    """
    others = len(head) - kept
    count = max(1, -(-others // (COLUMNS - kept)))
    bounds = [kept + others * part // count for part in range(count + 1)]
    return "\n\n".join(
        format_table(
            [*head[:kept], *head[first:last]], [[*row[:kept], *row[first:last]] for row in rows]
        )
        for first, last in pairwise(bounds)
    )


def format_ms(seconds: float) -> str:
    """Return a time in milliseconds."""
    return f"{seconds * 1e3:.3g}"


def group(entries: Iterable[Work], find: Callable[[Work], str]) -> dict[str, list[Work]]:
    """Return the entries that have the same key, by the keys in their order."""
    groups: dict[str, list[Work]] = {}
    for each in entries:
        groups.setdefault(find(each), []).append(each)
    return groups


def format_list(lines: Iterable[str]) -> str:
    """Return a list with a line for each entry."""
    return "\n".join(f"- {line}" for line in lines)


def write_chapter(name: str, **values: Any) -> str:
    """Return a chapter with its values, without paragraphs and lines that are empty."""
    parts = []
    for part in CHAPTERS[name]:
        lines = [part] if isinstance(part, str) else [f"- {line}" for line in part]
        filled = (line.format(**values) for line in lines)
        parts.append("\n".join(line for line in filled if line.strip("- ")))
    return "\n\n".join(filter(None, parts))


def replace_section(text: str, name: str, content: str) -> str:
    """Return a text with a section replaced, and sealed; unchanged if it has no such section."""
    head, begin, rest = text.partition(f"<!-- figures: {name} -->")
    if not begin:
        return text
    return f"{head}{begin}\n{seal(name, content)}\n{END}{rest.partition(END)[2]}"


def write_results(
    name: str, facts: dict[str, Any], text: str, folder: Path, docs: Path | None = None
) -> None:
    """Write figures as NAME.json and their text as NAME.md, and both into the documentation."""
    (folder / f"{name}.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / f"{name}.md").write_text(text + "\n", encoding="utf-8")
    if docs:
        publish({name: text}, docs)


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


def publish(sections: Mapping[str, str], docs: Path) -> None:
    """Write sections into the pages of the documentation that have them, by their names."""
    for page in (*docs.glob("*.md"), docs.parent / "README.md"):
        before = after = page.read_text(encoding="utf-8")
        for name, content in sections.items():
            after = replace_section(after, name, content)
        if after != before:
            page.write_text(after, encoding="utf-8")
