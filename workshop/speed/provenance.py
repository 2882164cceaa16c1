"""Which sources a table was measured with, and whether a hand has changed it.

Each table that a command writes into the documentation ends with a comment, the seal: a digest of
the sources that it measures (without comments and docstrings), and one of its own text. `python -m
workshop tables` lists the tables whose sources have changed since, in docs/accuracy_tables.md.
"""

import ast
import hashlib
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
DIGITS = 12  # of a digest, in base 16
SEAL = re.compile(r"\n*<!-- of sources (\w+), text (\w+) -->")
SECTION = re.compile(r"<!-- figures: ([^>]+) -->\n(.*?)\n<!-- end of figures -->", re.DOTALL)
COMMENTS = {
    ".py": re.compile(r"(?m:(?:^|(?<=\s))#.*$)"),
    **dict.fromkeys((".h", ".hpp", ".cpp"), re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)),
}
DOCUMENTED = ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef
LIST = "sources"  # the section that lists all others, and is measured by nothing
KERNEL = (
    "symtop_ros/physics/*.py",
    "symtop_ros/physics/kernel/*.*",
    "symtop_ros/physics/kernel/driven/*",
    "symtop_ros/physics/kernel/exact/*",
    "symtop_ros/physics/kernel/functions/*",
)
PEERS = (
    *(f"workshop/speed/{name}.py" for name in ("benchmarks", "many", "reference", "sweep")),
    "workshop/speed/peers/*.*",
)
NODE = (*KERNEL, "symtop_ros/ros/**/*.py", "symtop_ros/run/**/*.py")
REPORT = (*KERNEL, *PEERS)
# By table: the command that writes it, and the sources that it measures.
TABLES: dict[str, tuple[str, tuple[str, ...]]] = {
    **dict.fromkeys(
        ("chapters", "summary", "many motions", "measured motion", "others ahead"),
        ("report", REPORT),
    ),
    "derivatives": ("derivatives", (*KERNEL, "workshop/speed/derivatives.*")),
    "filters": ("filters", (*KERNEL, "symtop_ros/run/**/*.py", "workshop/speed/filters.py")),
    "assumptions": (
        "records",
        (
            "symtop_ros/truth/fit/*.py",
            "symtop_ros/truth/residuals/*.py",
            "workshop/records/*.py",
        ),
    ),
    "testset": ("scores", (*REPORT, "workshop/speed/testset.py")),
    **{
        name: (command, (*NODE, f"workshop/load/{file}.py", "workshop/load/listener.py"))
        for name, command, file in (
            ("node cost", "node-cost", "node_cost"),
            ("measured node", "node-cost", "node_cost"),
            ("starts", "starts", "starts"),
            ("links", "links", "links"),
            ("stress", "stress", "stress"),
        )
    },
}


class Table(NamedTuple):
    """A table in the documentation, and what its seal says."""

    name: str
    page: Path
    sources: str  # digest of the sources that it was measured with
    is_whole: bool  # False if its text was changed after it was written

    def is_of_these_sources(self) -> bool:
        """Return True if the sources that it measures are what they were."""
        return self.sources == digest_sources(self.name)


def digest_sources(name: str, root: Path = ROOT) -> str:
    """Return the digest of the sources that a table measures, as they are now."""
    digest = hashlib.sha256()
    patterns = TABLES[name][1]
    found = {path for each in patterns for path in root.glob(each) if path.is_file()}
    for path in sorted(path for path in found if path.suffix not in (".so", ".dylib", ".dll")):
        text = strip(path.read_text(encoding="utf-8"), path.suffix)
        digest.update(f"{path.relative_to(root).as_posix()}\0{text}\0".encode())
    return digest.hexdigest()[:DIGITS]


def strip(text: str, suffix: str) -> str:
    """Return a source without docstrings, comments and blanks, which change no figure."""
    if suffix == ".py":
        text = _drop_docstrings(text)
    if comments := COMMENTS.get(suffix):
        text = comments.sub("", text)
    return "".join(text.split())


def _drop_docstrings(text: str) -> str:
    lines = text.splitlines()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None:
            first = node.body[0]
            for number in range(first.lineno, (first.end_lineno or 0) + 1):
                lines[number - 1] = ""
    return "\n".join(lines)


def seal(name: str, content: str) -> str:
    """Return the content of a table with its seal at the end."""
    if name == LIST:
        return content
    return f"{content}\n\n{write_seal(digest_sources(name), content)}"


def write_seal(sources: str, content: str) -> str:
    """Return the comment of a table of these sources."""
    return f"<!-- of sources {sources}, text {_digest(content)} -->"


def list_tables(pages: list[Path]) -> Iterator[Table]:
    """Yield all tables of some pages that commands write, but for the list of them."""
    for page in pages:
        for name, text in SECTION.findall(page.read_text(encoding="utf-8")):
            if name == LIST:
                continue
            found = SEAL.search(text)
            sources, digest = found.groups() if found else ("", "")
            yield Table(name, page, sources, digest == _digest(SEAL.sub("", text)))


def find_pages(docs: Path) -> list[Path]:
    """Return the pages that may have tables: of the documentation, the README and the test set."""
    testset = docs.parent / "symtop_ros/truth/testset/README.md"
    pages = [docs.parent / "README.md", *sorted(docs.glob("*.md")), testset]
    return [page for page in pages if page.is_file()]


def _digest(text: str) -> str:
    return hashlib.sha256(text.strip().encode()).hexdigest()[:DIGITS]
