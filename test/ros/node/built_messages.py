"""Environments in which messages can be imported that PyPI does not have."""

import contextlib
import ctypes
import importlib.util
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

BUILT = Path(sys.prefix, "messages")


def find_messages(package: str) -> Path | None:
    """Return the folder of a package, or PACKAGE-VERSION, that was built; None: it is installed."""
    folder = BUILT / package
    installed = "-" not in package and importlib.util.find_spec(package)
    if installed and not str(installed.origin).startswith(str(folder)):
        return None
    if not folder.is_dir():
        pytest.skip(f"{package} is not built: python workshop/messages.py")
    return folder


@contextlib.contextmanager
def importing(package: str) -> Iterator[None]:
    """Make the messages of a package importable in this process."""
    folder = find_messages(package)
    module = package.partition("-")[0]
    with pytest.MonkeyPatch.context() as patch:
        if folder:
            patch.syspath_prepend(folder)
            for path in (folder / "lib").glob("*typesupport_*_c.so"):
                ctypes.CDLL(path)  # ROS asks the loader, which does not know the folder
        yield
    for name in [each for each in sys.modules if module in each]:
        del sys.modules[name]
    importlib.invalidate_caches()


def with_messages(package: str, variables: dict[str, str]) -> dict[str, str]:
    """Return variables with which a package of messages is found."""
    folder = find_messages(package)
    if folder is None:
        return variables
    places = {"PYTHONPATH": folder, "LD_LIBRARY_PATH": folder / "lib"}
    found = {name: [str(place), variables.get(name)] for name, place in places.items()}
    return variables | {name: os.pathsep.join(filter(None, each)) for name, each in found.items()}
