"""Style, spelling and types of what belongs to the project: python test/lint.py [style] [types].

The tools are given the files that git tracks; without git, those of the project's own folders. What
else lies in a checkout, such as results of the commands of the documents, is not looked at.
"""

import subprocess
import sys
from collections.abc import Iterable
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
FOLDERS = ("config", "design", "docs", "examples", "launch", "resource", "symtop_ros", "test")
FOLDERS = (*FOLDERS, "workshop")
TOP = ("*.py", "*.md", "*.rst", "*.toml", "*.cfg", "*.xml", "*.cff", "*.in", "Makefile")
BUILT = ("*.pyc", "*.so", "*.dylib", "*.dll")
TYPED = ("symtop_ros/*", "workshop/*", "examples/*", "design/*")
# A shipped page: packed data, and modules that are checked in the package.
GENERATED = "docs/top.html"


def list_files() -> list[str]:
    """Return the paths of the project's files, relative to the checkout."""
    git = ["git", "-C", str(ROOT)]
    try:
        top = subprocess.run(
            [*git, "rev-parse", "--show-toplevel"], capture_output=True, text=True, check=False
        )
    except OSError:  # there is no git
        return list_without_git()
    if top.returncode or Path(top.stdout.strip()).resolve() != ROOT.resolve():
        return list_without_git()
    found = subprocess.run([*git, "ls-files", "-z"], capture_output=True, check=True).stdout
    paths = found.decode().split("\0")[:-1]
    return sorted(path for path in paths if (ROOT / path).is_file())  # some may be removed


def list_without_git() -> list[str]:
    """Return the paths of the files in the folders of the project, as in an archive of it."""
    found = [path for each in FOLDERS for path in (ROOT / each).rglob("*")]
    found += [path for each in TOP for path in ROOT.glob(each)]
    return sorted(
        path.relative_to(ROOT).as_posix()
        for path in found
        if path.is_file() and not any(path.match(each) for each in BUILT)
    )


def select(paths: Iterable[str], *patterns: str) -> list[str]:
    """Return the paths that match a pattern."""
    return [path for path in paths if any(fnmatch(path, each) for each in patterns)]


def list_commands(*chosen: str) -> list[list[str]]:
    """Return the commands that check style or types, or both."""
    paths = [path for path in list_files() if path != GENERATED]
    programs = select(paths, "*.py", "resource/top_*")
    modules = [
        name.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        for name in select(programs, *TYPED)
    ]
    kernel = select(paths, "*.hpp", "*.h", "*.cpp", "*.c", "*.cu")
    page = ["sh", str(ROOT / "test/check_js.sh"), str(Path(sys.prefix, "js"))]
    commands = {
        "style": [
            [str(BIN / "ruff"), "check", *programs, "pyproject.toml"],
            [str(BIN / "ruff"), "format", "--check", *programs, *select(paths, "*.md")],
            [str(BIN / "clang-format"), "--dry-run", "--Werror", *kernel],
            [str(BIN / "codespell"), *paths],
            [*page, "style"],
        ],
        "types": [
            [str(BIN / "mypy"), *(word for name in modules for word in ("-m", name))],
            [sys.executable, str(ROOT / "test/types_of_examples.py")],
            [str(BIN / "mypy"), str(ROOT / "test/public_types.py")],
            [*page, "types"],
        ],
    }
    return [command for name in chosen or commands for command in commands[name]]


def main() -> int:
    """Run all commands; return 1 if any failed."""
    commands = list_commands(*sys.argv[1:])
    statuses = [subprocess.run(each, cwd=ROOT, check=False).returncode for each in commands]
    return int(any(statuses))


if __name__ == "__main__":
    sys.exit(main())
