"""Releases of packages, each in an environment of its own."""

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

from workshop.releases.engines import Engine

HOME = Path(__file__).parents[2] / ".venv" / "releases"
INSTALL_LIMIT = 300  # s
PYTHONS = (11, 12, 13, 10, 9, 8, 7)  # 3.x; the first that has a wheel is used
LONGEST = 120  # characters of a reason
NONE = 99  # a version that no package has: pip answers with those that there are


def list_releases(engine: Engine) -> dict[str, Path]:
    """Return the releases, the oldest first, each with the program that runs it."""
    if not engine.is_python:
        node = Path(shutil.which("node") or "node")
        text = execute(["npm", "view", engine.package, "versions", "--json"], HOME.parent).stdout
        names = json.loads(text or "[]")  # an object if it failed
        return {each: node for each in names if "-" not in each} if type(names) is list else {}
    found: dict[str, Path] = {}
    for python in find_pythons():
        command = [*_pip("download", python), "--no-deps", f"{engine.package}=={NONE}"]
        answer = re.search(r"from versions: (.*?)\)", execute(command, HOME.parent).stderr)
        for each in answer[1].split(", ") if answer else []:
            if re.fullmatch(r"[\d.]+(post\d+)?", each):
                found.setdefault(each, python)
    return {each: found[each] for each in sorted(found, key=order)}


def order(release: str) -> list[int]:
    """Return the numbers of a release, by which releases are sorted."""
    return [int(each) for each in re.findall(r"\d+", release)]


def find_pythons() -> list[Path]:
    """Return the interpreters python3.N of this machine, one of each version."""
    root = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    folders = [Path(sys.base_prefix, "bin"), *root.glob("versions/*/bin"), Path("/usr/bin")]
    found: dict[str, Path] = {}
    for path in (folder / f"python3.{minor}" for minor in PYTHONS for folder in folders):
        if path.exists():
            found.setdefault(path.name, path)
    return list(found.values())


def install(engine: Engine, release: str, program: Path, place: Path) -> str:
    """Install a release into a folder; return an empty text, or what went wrong."""
    if not engine.is_python:
        wanted = f"{engine.package}@{release}"
        command = ["npm", "install", "--ignore-scripts", "--no-audit", "--no-fund"]
        result = execute([*command, "--prefix", str(place), wanted], place)
        return explain(result) if result.returncode else ""
    command = [*_pip("install", program), "--target", str(place), f"{engine.package}=={release}"]
    # Older releases were built for NumPy 1; the newest may ask for NumPy 2.
    for numpy in ("numpy<2", "numpy"):
        result = execute([*command, numpy], place)
        if not result.returncode:
            return ""
    return explain(result)


def _pip(command: str, python: Path) -> list[str]:
    pip = [sys.executable, "-m", "pip", "--python", str(python), "--disable-pip-version-check"]
    return [*pip, command, "--only-binary", ":all:"]


def execute(
    command: list[str], place: Path, limit: int = INSTALL_LIMIT
) -> subprocess.CompletedProcess[str]:
    """Run a program in a folder; one that takes too long, or is missing, has failed."""
    try:
        return subprocess.run(
            command, cwd=place, capture_output=True, text=True, timeout=limit, check=False
        )
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, "", f"took more than {limit} s")
    except OSError as error:
        return subprocess.CompletedProcess(command, 1, "", f"{command[0]}: {error.strerror}")


def explain(result: subprocess.CompletedProcess[str]) -> str:
    """Return the last line that names an error, or the last of all."""
    lines = [each.strip() for each in result.stderr.splitlines() if each.strip()]
    named = [each for each in lines if "error:" in each.lower()] or lines
    return (
        textwrap.shorten(named[-1], LONGEST, placeholder=" ...")
        if named
        else f"ended with status {result.returncode}"
    )
