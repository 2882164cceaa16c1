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


class Internal:
    """The old name of a member that is internal now, and has an underscore."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name, self._old = f"_{name}", f"{owner.__name__}.{name}"

    def __get__(self, instance: Any, owner: type) -> Any:
        text = f"{self._old} is internal: it goes in 0.8"
        warnings.warn(text, DeprecationWarning, stacklevel=2)
        return getattr(owner if instance is None else instance, self._name)
