"""Rows of a table, the columns that are read, and those that a program requires."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from symtop_ros.base.arrays import Real
from symtop_ros.truth.tables.columns import Head
from symtop_ros.truth.tables.times import Times

Line = tuple[int, str]  # with its number


@dataclass(frozen=True)
class Columns:
    """Columns that a program reads.

    Attributes
    ----------
    kind : str
        What they are, in a word of the program.
    places : tuple of int
    factors : tuple of float
        Factors of the units, one for each column or one for all.
    notes : tuple of str
        What was assumed.
    unit : str
        Unit of angles, if their names state it.
    """

    kind: str
    places: tuple[int, ...]
    factors: tuple[float, ...] = (1.0,)
    notes: tuple[str, ...] = ()
    unit: str = ""


class Wanted(Protocol):
    """The columns that a program requires of a table."""

    def find(self, head: Head) -> Columns | None:
        """Return the columns by their names; None if the names do not have them."""

    def describe(self, path: Path, first: str) -> str:
        """Return the refusal of a table without these columns; its first line is given."""


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of a table.

    Attributes
    ----------
    columns : Columns
    times : Times
    values : ndarray (n, m)
        In the units of the program; they may be infinite.
    steps : ndarray (m,)
        Steps of the last decimals of each column.
    notes : tuple of str
        What was left out or assumed, in sentences.
    unreadable : int
        Rows that were left out as a number is nan.
    """

    columns: Columns
    times: Times
    values: Real
    steps: Real
    notes: tuple[str, ...]
    unreadable: int = 0


@dataclass(frozen=True)
class Found:
    """The names of a table, its columns, and the first row if it has been read."""

    head: Head
    columns: Columns
    rest: tuple[Line, ...] = ()
