"""The type of one number, or of many: what a record of a top, a state or angles is a record of.

A checker of types sees `Top[float]` for one top and `Top[Real]` for many; where it cannot know,
a bare `Top` is one of either.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    N = TypeVar("N", default=Any)
else:
    from typing import TypeVar

    N = TypeVar("N")

# Numbers of which there are many, as arguments: rows, tables of rows, and arrays of any type.
Many = Sequence[Any] | NDArray[Any]
