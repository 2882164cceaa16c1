"""Old names of the public API: each works for one minor version and warns of its replacement."""

import warnings
from typing import TypeVar

T = TypeVar("T")


def warn_of_name(old: str, new: str, value: T) -> T:
    """Return what an old name stands for; the warning names the line that uses the name.

    Only what the old name calls directly may call this: the property, method or `__getattr__`.
    """
    warnings.warn(f"{old} is now {new}", DeprecationWarning, stacklevel=3)
    return value
