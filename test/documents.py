"""Parts of the documents that can be tried: code blocks, links, and names in tables."""

import math
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
FIRST = sorted(ROOT.glob("*.md"), key=lambda path: path.stem != "README")
PAGES = [*FIRST, *sorted(ROOT.glob("docs/*.md"))]
BLOCK = re.compile(r"^ *```(\w+)\n(.*?)^ *```$(?:\n+```text\n(.*?)^```$)?", re.M | re.S)
DRIVEN = re.compile("friction|torque=")  # the code of a motion whose last digits may differ
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
LINK = re.compile(r"\]\(([^)#\s]*)(?:#([^)\s]+))?\)")
PATH = re.compile(
    r"(?<![\w/])((?:test|symtop_ros|workshop|examples|design|config|docs)/[\w./]+\.(?:py|yaml|xml|md|json))"
)
WRITTEN = "top.html"  # by `make panel` and `make docs`; article/test_page.py opens each link to it


def blocks(page: Path, language: str) -> list[tuple[str, str]]:
    """Return the blocks of a page in a language, each with the output directly below it."""
    found = BLOCK.findall(page.read_text(encoding="utf-8"))
    return [(code, output) for kind, code, output in found if kind == language]


def find_section(text: str, name: str) -> str | None:
    """Return the text between the comments of a section that a command writes, or None."""
    _, begin, rest = text.partition(f"<!-- figures: {name} -->")
    return rest.partition("<!-- end of figures -->")[0].strip() if begin else None


def commands(page: Path) -> Iterator[tuple[list[str], str]]:
    """Yield the words of each shell command of a page, and the output that is shown for it."""
    for code, output in blocks(page, "sh"):
        for line in code.replace("\\\n", " ").splitlines():
            if words := shlex.split(line, comments=True):
                yield words, output


def console(page: Path, name: str) -> tuple[list[str], str]:
    """Return the commands of the block of a page that names a file, and the output shown there."""
    found = re.findall(r"```console\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    (lines,) = (each.splitlines() for each in found if name in each)
    typed = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return typed, "".join(f"{line}\n" for line in lines if not line.startswith("$ "))


def broken_links(page: Path) -> Iterator[str]:
    """Yield the links and paths of a page that lead to no file or heading."""
    text = page.read_text(encoding="utf-8")
    for link, anchor in LINK.findall(text):
        target = page.parent / link if link else page
        if link.startswith("http") or target.name == WRITTEN:
            continue
        if not target.exists() or (anchor and anchor not in anchors(target)):
            yield f"{link}#{anchor}"
    yield from (path for path in PATH.findall(text) if not (ROOT / path).exists())


def anchors(page: Path) -> set[str]:
    """Return the anchors of the headings of a page, as a forge makes them."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w -]", "", each.lower()).replace(" ", "-") for each in headings}


def rows(page: Path, section: str) -> list[list[str]]:
    """Return the cells of the first table of a section, without its head."""
    text = page.read_text(encoding="utf-8").split(f"\n## {section}\n")[1].split("\n## ")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines[2:]]


def names(cell: str) -> list[str]:
    """Return the names that a cell of a table has in backticks."""
    return re.findall(r"`([^`]+)`", cell)


def same(printed: str, shown: str, code: str | None = None) -> bool:
    """Compare an output with that of a document: equal words, and numbers to nine digits.

    The output of `code` must be equal letter for letter, unless the code has a driven motion.
    """
    if code and not DRIVEN.search(code):
        return printed.split() == shown.split()
    if NUMBER.sub("#", printed).split() != NUMBER.sub("#", shown).split():
        return False
    pairs = zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True)
    return all(math.isclose(float(a), float(b), rel_tol=1e-9, abs_tol=1e-9) for a, b in pairs)
