"""The compiled kernel, if it was built and is wanted: the same motions as from Python, much faster.

Python is the reference; `exact` and `driven` describe and test what the kernel computes. Without a
compiler the package is installed without it. The environment variable SYMTOP_PURE=1 selects Python
for a whole program, and `Motion(..., pure=True)` for one motion.
"""

import os
from importlib import import_module
from typing import Any

# True if Python is to compute the states of motions that are not asked for otherwise.
PURE = os.environ.get("SYMTOP_PURE", "0") not in ("", "0")


def _load() -> Any:
    """Return the compiled module, or None."""
    try:
        return import_module("symtop_ros.physics.kernel._kernel")
    except ImportError:  # it was not built
        return None


_KERNEL = _load()
accelerated: bool = _KERNEL is not None and not PURE


def find_kernel(pure: bool) -> Any:
    """Return the compiled module, or None if Python is to be used."""
    return None if pure else _KERNEL


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
    if PURE:
        return "Python (SYMTOP_PURE is set)"
    return "Python (the kernel was not built: it needs a C++ compiler and Python's headers)"
