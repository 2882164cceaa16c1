"""The wording of refused arguments, which stands once in the tests too."""

from __future__ import annotations

import re
from contextlib import AbstractContextManager
from typing import Any

import pytest

NUMBER = "a number"
FINITE_NUMBER = "a finite number"
FINITE_ARRAY = "an array of finite numbers"
VECTOR = "3 finite numbers"
HOLD = "'spin_rate' or 'spin_momentum'"
TILTED = "tilted (phi' is undefined on the vertical; an angular impulse works there)"
ONE_STATE = "one state"
NOT_TOO_FAST = "s of the start (the motion then becomes too fast)"


def refused(name: str, condition: str, value: str = "") -> AbstractContextManager[Any]:
    """Expect "NAME must be ... CONDITION ..., got VALUE ..." in a ValueError."""
    pattern = f"{re.escape(name)} must be .*{re.escape(condition)}.*, got {re.escape(value)}"
    return pytest.raises(ValueError, match=f"^{pattern}")
