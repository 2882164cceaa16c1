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


def describe_engine() -> str:
    """Return what computes the states, in words.

    Examples
    --------
    >>> from symtop_ros.physics import accelerated, describe_engine
    >>> (describe_engine() == "the compiled kernel") == accelerated
    True
    """
    if accelerated:
        return "the compiled kernel"
    if os.environ.get("SYMTOP_PURE", "0") not in ("", "0"):
        return "Python (SYMTOP_PURE is set)"
    return "Python (the kernel was not built: it needs a C++ compiler and Python's headers)"


@contextmanager
def python_alone() -> Iterator[None]:
    """Have the motions that are created inside computed by Python, to compare the two.

    Under gravity alone the states have the same bits. The environment variable SYMTOP_PURE=1 has
    the same effect for a whole program.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, State, Top, python_alone
    >>> top, start = Top(0.000228, 0.0000572, 0.068), State.from_euler(theta=0.5, psi_dot=200.0)
    >>> with python_alone():
    ...     slow = Motion(top, start)
    >>> slow.at(10.0) == Motion(top, start).at(10.0)
    True
    """
    before = _is_used[0]
    _is_used[0] = False
    try:
        yield
    finally:
        _is_used[0] = before
