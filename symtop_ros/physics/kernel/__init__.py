"""The compiled kernel, if it was built and is wanted: the same states as from Python, much faster.

Python is the reference; `exact` and `driven` describe and test what the kernel computes. Without a
compiler the package is installed without it. The environment variable SYMTOP_PURE=1 selects Python.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

import numpy as np

from symtop_ros.physics.exact.phases import ROWS


def _load() -> Any:
    """Return the compiled module, or None."""
    if os.environ.get("SYMTOP_PURE", "0") not in ("", "0"):
        return None
    try:
        module = import_module("symtop_ros.physics.kernel._kernel")
    except ImportError:  # it was not built
        return None
    module.set_rows(np.array(ROWS))
    return module


_KERNEL = _load()
_is_used = [_KERNEL is not None]
accelerated: bool = _KERNEL is not None


def find_kernel() -> Any:
    """Return the compiled module, or None if Python is to be used."""
    return _KERNEL if _is_used[0] else None


@contextmanager
def python_alone() -> Iterator[None]:
    """Have the motions that are created inside computed by Python, to compare the two."""
    before = _is_used[0]
    _is_used[0] = False
    try:
        yield
    finally:
        _is_used[0] = before
