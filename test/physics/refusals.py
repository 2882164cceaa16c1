"""The wording of refused arguments, which stands once in the tests too."""

import math
import re
from contextlib import AbstractContextManager
from typing import Any

import pytest

from symtop_ros.physics import Motion

FINITE_ARRAY = "an array of finite numbers"
NOT_TOO_LATE = "s from the start (1e15 turns)"


def meet(motion: Motion, t: float) -> float:
    """The time, or the last one that the refusal names if it is too late."""
    try:
        motion.at(t)
    except ValueError as refusal:
        if NOT_TOO_LATE not in str(refusal):
            raise
        last = float(str(refusal).removeprefix("t must be less than ").split()[0])
        return math.copysign(0.9 * last, t)
    return t


def refused(name: str, condition: str, value: str = "") -> AbstractContextManager[Any]:
    """Expect "NAME must be ... CONDITION ..., got VALUE ..." in a ValueError."""
    pattern = f"{re.escape(name)} must be .*{re.escape(condition)}.*, got {re.escape(value)}"
    return pytest.raises(ValueError, match=f"^{pattern}")
