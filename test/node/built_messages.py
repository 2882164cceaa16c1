"""Environments in which messages can be imported that PyPI does not have."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

BUILD = Path(__file__).parents[1] / "build_messages.py"


def with_messages(package: str, folder: Path, variables: dict[str, str]) -> dict[str, str]:
    """Return variables with which a package of messages is found; build what is not installed."""
    if importlib.util.find_spec(package):
        return variables
    if not (shutil.which("gcc") and shutil.which("g++")):
        pytest.skip(f"{package} is not installed, and there is no compiler to build it")
    subprocess.run(
        [sys.executable, BUILD, package, folder],
        check=True,
        capture_output=True,
        timeout=240,
        text=True,
    )
    places = {"PYTHONPATH": folder, "LD_LIBRARY_PATH": folder / "lib"}
    found = {name: [str(place), variables.get(name)] for name, place in places.items()}
    return variables | {name: os.pathsep.join(filter(None, each)) for name, each in found.items()}
