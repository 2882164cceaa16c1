"""Accuracy by version of NumPy and SciPy, and by CPU features: run by hand, it needs a network.

    python workshop/speed/versions.py [FOLDER]

It sets up an environment for each pair of versions (in FOLDER, or in a temporary one) and prints a
table in Markdown. NPY_DISABLE_CPU_FEATURES makes NumPy use its code for simpler processors, whose
sines and exponentials may differ in the last bit.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import venv
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
# The oldest of which PyPI has wheels for this Python, and the newest.
OLDEST = {(3, 11): ("1.24.0", "1.9.2"), (3, 12): ("1.26.0", "1.11.2")}
NEWEST = ("", "")
# Prints the CPU features for which NumPy has code apart from its baseline. Their names depend on
# its version, and names that it does not know are ignored.
DISPATCHED = """
import numpy
core = getattr(numpy, "_core", None) or numpy.core
print(*core._multiarray_umath.__cpu_dispatch__)
"""
# Prints the versions, the largest error (an angle) in eps, and a digest of all states on the way.
PROGRAM = """
import hashlib, warnings
import numpy, scipy
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import spread_times
from workshop.speed.reference import EPS, Reference
reference, largest, digest = Reference.read(), 0.0, hashlib.sha256()
for problem in [*reference.article[:7], *reference.hard]:
    motion = Motion(problem.task.top, problem.task.start)
    for t in problem.times:
        largest = max(largest, problem.error(t, motion.at(t).orientation))
    states = motion.at(spread_times(10.0))
    digest.update(states.orientation.tobytes() + states.angular_velocity.tobytes())
print(numpy.__version__, scipy.__version__, f"{largest / EPS:.2f}", digest.hexdigest()[:12])
"""


def main(folder: Path) -> None:
    """Print the table."""
    print("| NumPy | SciPy | CPU features | largest error, eps | digest of all states |")
    print("|---|---|---|--:|---|")
    oldest = OLDEST.get(sys.version_info[:2])
    for numpy, scipy in filter(None, (oldest, NEWEST)):
        python = make_environment(folder / f"numpy-{numpy or 'newest'}", numpy, scipy)
        features = run(python, DISPATCHED)
        wide = [each for each in features if each.startswith("AVX512") or each == "X86_V4"]
        for name, disabled in (("all", []), ("no AVX-512", wide), ("baseline only", features)):
            found = run(python, PROGRAM, disabled)
            print(f"| {found[0]} | {found[1]} | {name} | {found[2]} | {found[3]} |", flush=True)


def make_environment(folder: Path, numpy: str, scipy: str) -> Path:
    """Return the Python of an environment with these versions; an empty one is the newest."""
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
        wanted = [
            f"{name}=={each}" if each else name
            for name, each in (("numpy", numpy), ("scipy", scipy))
        ]
        subprocess.run([python, "-m", "pip", "install", "--quiet", *wanted, "pyyaml"], check=True)
    return python


def run(python: Path, program: str, disabled: Sequence[str] = ()) -> list[str]:
    """Return the words that a program prints, without the CPU features named."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "NPY_DISABLE_CPU_FEATURES": " ".join(disabled),
    }
    result = subprocess.run(
        [python, "-W", "ignore", "-c", program],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return result.stdout.split()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as name:
            main(Path(name))
