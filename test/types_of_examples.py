"""Types of what users copy: Python blocks of the documents, and the examples of docstrings.

mypy runs over a copy of each, in which every line stands at its place in the file, so that a
message has the line of the document.
"""

import ast
import doctest
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from documents import BLOCK, PAGES, ROOT

PARSER = doctest.DocTestParser()
MODULES = sorted((ROOT / "symtop_ros").rglob("*.py"))
# Examples of the library import what they need, so that they can be copied. All others may use the
# names of their module, as doctest has it.
COPIED = ("symtop_ros/physics/", "symtop_ros/truth/imu/")


def write_page(page: Path) -> str:
    """Return the Python blocks of a page, each line at its place; all blocks are one program."""
    text = page.read_text(encoding="utf-8")
    lines = [""] * (text.count("\n") + 1)
    for found in BLOCK.finditer(text):
        if found[1] == "python":
            first = text.count("\n", 0, found.start(2))
            for n, line in enumerate(found[2].splitlines(), first):
                lines[n] = line
    return "\n".join(lines)


def list_examples(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the examples of each docstring of a module, each line at its place, with its name."""
    text = path.read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            continue
        if ">>> " not in (ast.get_docstring(node, clean=False) or ""):
            continue
        docstring = node.body[0]
        lines = text.splitlines()[: docstring.end_lineno]
        lines[: docstring.lineno - 1] = [""] * (docstring.lineno - 1)
        code = [""] * len(lines)
        for example in PARSER.get_examples("\n".join(lines)):
            for n, line in enumerate(example.source.splitlines(), example.lineno):
                code[n] = line
        yield getattr(node, "name", "module"), "\n".join(code)


def list_own_names(path: Path) -> str:
    """Return a line that imports what a module imports and defines."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imports = [
        ast.unparse(node) for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    named = [node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)]
    assigned = [node.targets[0] for node in tree.body if isinstance(node, ast.Assign)]
    named += [each.id for each in assigned if isinstance(each, ast.Name)]
    module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    return "; ".join([*imports, f"from {module} import {', '.join(named)}"])


def write_all(folder: Path) -> int:
    """Write all programs into a folder; return their number."""
    count = 0
    for page in PAGES:
        if (code := write_page(page)).strip():
            count += 1
            (folder / f"{page.stem}_md.py").write_text(code, encoding="utf-8")
    for path in MODULES:
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        is_copied = path.relative_to(ROOT).as_posix().startswith(COPIED)
        for k, (owner, code) in enumerate(list_examples(path)):
            count += 1
            prelude = "" if is_copied else list_own_names(path)
            place = f"{name.replace('.', '_')}__{owner}_{k}.py"
            (folder / place).write_text(prelude + code, encoding="utf-8")
    return count


def main() -> int:
    """Check the types of all programs; return 1 if there is an error."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        count = write_all(folder)
        print(f"{count} documents and docstrings")
        config = ["--config-file", str(ROOT / "pyproject.toml")]
        command = [sys.executable, "-m", "mypy", *config, "--scripts-are-modules"]
        cache = ["--cache-dir", str(ROOT / ".mypy_cache")]
        files = sorted(map(str, folder.glob("*.py")))
        return subprocess.run([*command, *cache, *files], cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
