"""Old names of the public API: each works for one minor version and warns."""

import warnings
from typing import Any, TypeVar

T = TypeVar("T")


def warn_of_name(old: str, new: str, value: T) -> T:
    """Return what an old name stands for; the warning names the line that uses the name.

    Only what the old name calls directly may call this: the property, method or `__getattr__`.
    """
    warnings.warn(f"{old} is now {new}", DeprecationWarning, stacklevel=3)
    return value


class OldName:
    """The old name of a member of a class.

    Parameters
    ----------
    new : str
        Its name now. Without one it is internal, and has the old name with an underscore.
    """

    def __init__(self, new: str = "") -> None:
        self._new = new

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = self._new or f"_{name}"
        what = f"now {owner.__name__}.{self._new}" if self._new else "internal"
        self._text = f"{owner.__name__}.{name} is {what}: the old name goes in 0.8"

    def __get__(self, instance: Any, owner: type) -> Any:
        warnings.warn(self._text, DeprecationWarning, stacklevel=2)
        return getattr(owner if instance is None else instance, self._name)
