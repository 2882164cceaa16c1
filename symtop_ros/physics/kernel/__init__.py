"""The compiled kernel, if it was built and is wanted: the same states as from Python, much faster.

Python is the reference; `exact` and `driven` describe and test what the kernel computes. Without a
compiler the package is installed without it. The environment variable SYMTOP_PURE=1 selects Python.
"""

import os
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


KERNEL = _load()
accelerated: bool = KERNEL is not None
