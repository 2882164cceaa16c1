"""Try the node with each ROS 2, Python and NumPy, playback with each Rerun, and all lower bounds.

python workshop/matrix.py: each cell gets a separate environment in .venv/matrix, in which it
installs the package and runs TESTS. The table is for docs/ros_reference.md.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = ROOT / ".venv" / "matrix" / "cell"
TESTS = (
    "test/ros/node/test_topics.py",
    "test/ros/client/test_main.py",
    "test/run/check/test_samples.py",
)
DISTRIBUTIONS = {
    "jazzy": ("3.11", "3.12", "3.13", "3.14"),
    "kilted": ("3.11", "3.12", "3.13", "3.14"),
}
NUMPYS = {"1": "numpy<2", "2": "numpy>=2,<3"}
# The oldest Rerun of setup.py, and the newest.
RERUNS = ("rerun-sdk~=0.38.0", "rerun-sdk")
PLAYBACK_TESTS = ("test/replay/view", "test/replay/test_other_readers.py")
# All lower bounds of setup.py together: uv finds them there. Everything that computes is tried, and
# what reads logs and models with other libraries.
LOWEST = "--resolution=lowest-direct"
LOWEST_TESTS = (
    *TESTS,
    *(f"test/{name}" for name in ("base", "words", "physics", "run", "truth", "digits")),
    "test/test_release.py",
)
TOOLS = ("pytest", "coverage", "hypothesis", "mpmath", "python-flint", "rosbags", "pillow")
PACKAGES = ("numpy", "scipy", "ros-rclpy", "rerun-sdk")
# An active environment, and that of ROS wheels, would reach into the cell.
FOREIGN = ("PYTHONPATH", "LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE")
TIMEOUT = 1800  # s for an installation, or for the tests
HEAD = "| extra | Python | NumPy | SciPy | rclpy | Rerun | result |\n|---|---|---|---|---|---|---|"


class Cell(NamedTuple):
    """A combination: an extra of setup.py, a version of Python, another requirement, and tests."""

    extra: str
    python: str
    wanted: str
    tests: tuple[str, ...] = TESTS

    @property
    def is_lowest(self) -> bool:
        """True if every requirement is at its lower bound."""
        return self.wanted == LOWEST


def cells() -> Iterator[Cell]:
    """Yield all combinations. NumPy 1 has no wheels from Python 3.13 on."""
    for distribution, pythons in DISTRIBUTIONS.items():
        for python in pythons:
            for number, numpy in NUMPYS.items():
                if number != "1" or python in ("3.11", "3.12"):
                    yield Cell(distribution, python, numpy)
    for rerun in RERUNS:
        yield Cell("playback", "3.11", rerun, PLAYBACK_TESTS)
    yield Cell("jazzy,test", "3.11", LOWEST, LOWEST_TESTS)


def find_python(version: str) -> str | None:
    """Return an interpreter of a version: on PATH, or of pyenv."""
    installed = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"))
    return str(installed[-1]) if installed else shutil.which(f"python{version}")


def try_cell(cell: Cell) -> str:
    """Try a combination and return its row of the table."""
    python = find_python(cell.python)
    if python is None:
        return row(cell, {}, "not tried: this Python was not installed")
    shutil.rmtree(ENVIRONMENT, ignore_errors=True)
    try:
        run(python, "-m", "venv", ENVIRONMENT)
        inside = ENVIRONMENT / "bin" / "python"
        installed = install(inside, cell)
        if installed.returncode:
            return row(cell, {}, f"cannot be installed: {last_line(installed.stderr)}")
        versions = versions_of(inside)
        tested = run(inside, "-m", "pytest", "-q", "-m", "not realtime and not long", *cell.tests)
        result = last_line(tested.stdout).strip("= ")
        return row(cell, versions, re.sub(r", \d+ (deselected|warnings?)", "", result))
    except subprocess.TimeoutExpired:
        return row(cell, {}, f"ended after {TIMEOUT} s")
    finally:
        shutil.rmtree(ENVIRONMENT, ignore_errors=True)


def install(inside: Path, cell: Cell) -> subprocess.CompletedProcess[str]:
    """Install the package into an environment, with what a combination asks for."""
    pip = (inside, "-m", "pip", "install", "--quiet", "--prefer-binary")
    package = f".[{cell.extra}]"
    if not cell.is_lowest:
        return run(*pip, package, cell.wanted, *TOOLS)
    run(*pip, "uv")
    return run(inside, "-m", "uv", "pip", "install", "--python", inside, cell.wanted, package)


def run(*command: object) -> subprocess.CompletedProcess[str]:
    """Run a command in the root of the repository, without the environment of another Python."""
    environment = {name: text for name, text in os.environ.items() if name not in FOREIGN}
    return subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        env={**environment, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
        timeout=TIMEOUT,
    )


def versions_of(python: Path) -> dict[str, str]:
    """Return the versions of Python and of all packages in an environment."""
    found = json.loads(run(python, "-m", "pip", "list", "--format=json").stdout)
    version = run(python, "-c", "import platform; print(platform.python_version())").stdout.strip()
    return {"python": version} | {each["name"]: each["version"] for each in found}


def last_line(text: str) -> str:
    """Return the last line of a text, without times, or "nothing"."""
    lines = text.strip().splitlines() or ["nothing"]
    return re.sub(r" in \d.*", "", lines[-1])[:100]


def row(cell: Cell, versions: dict[str, str], result: str) -> str:
    """Return a row of the table."""
    known = (versions.get(name, "") for name in PACKAGES)
    return f"| {' | '.join((cell.extra, versions.get('python', cell.python), *known, result))} |"


def is_good(line: str) -> bool:
    """Return True for the row of a cell that passed, or that could not be tried here."""
    result = line.split("|")[-2]
    return "not tried" in result or ("passed" in result and not re.search("failed|error", result))


def main() -> int:
    """Try all cells; return 1 if one of those that were tried did not pass."""
    print(f"Tried on {datetime.now(timezone.utc):%Y-%m-%d}:\n\n{HEAD}", flush=True)
    good = True
    for cell in cells():
        found = try_cell(cell)
        print(found, flush=True)
        good = good and is_good(found)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
