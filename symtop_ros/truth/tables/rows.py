"""Rows of a table, as they are read: numbers, what is missing, and the decimals of columns."""

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from decimal import DecimalException
from math import isnan
from operator import itemgetter
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.truth.tables.cells import (
    Row,
    choose_separator,
    count_decimals,
    is_missing,
    is_number,
    read_number,
    read_numbers,
    split_cells,
    split_lines,
)
from symtop_ros.truth.tables.columns import find_flags
from symtop_ros.truth.tables.table import Found, Line, Table
from symtop_ros.truth.tables.times import SplitStampError, TimeReader

ABSENT = -1.0  # the first number of a covariance
MOST = 300  # decimals of a double, nearly
SHOWN = 80  # characters of a row in a message
WRONG = (ValueError, DecimalException, OverflowError)  # of cells that are no numbers


@dataclass(eq=False)
class RowReader:
    """Rows of a table, as they are read."""

    path: Path
    found: Found
    time: tuple[int, ...]
    times: TimeReader
    numbers: "list[array[float]]" = field(default_factory=list)
    fewest: list[int] = field(default_factory=list)  # decimals of each column
    most: list[int] = field(default_factory=list)
    separator: str | None = None
    shift: int = 0  # 1 if a name of the row, which has none itself, stands before its cells
    empty: int = 0
    unreadable: int = 0
    odd: int = 0  # number of the first line with nan
    absent: int = 0  # rows whose covariance says that nothing was measured
    flags: tuple[int, ...] = ()  # places of the numbers that say so

    def __post_init__(self) -> None:
        """Make a place for each column."""
        self.numbers = [array("d") for _ in self.found.columns.places]
        self.flags = find_flags(self.found.head.names, self.found.columns.places)

    def read(self, block: list[Line]) -> None:
        """Read lines; the first one shows what separates the cells."""
        if not self.most:
            self._look(block[0])
        lines = [line for _, line in block]
        rows = split_lines(lines, self.separator)
        try:
            if max(map(len, rows)) > len(self.found.head.names) + self.shift:
                raise IndexError
            self._add(rows)
        except (IndexError, *WRONG):
            self._add_good(block, rows)

    def _look(self, line: Line) -> None:
        """Find the separator, and whether rows have names, by the first row."""
        names = self.found.head.names
        self.separator = choose_separator(line[1], len(names))
        cells = split_cells(line[1], self.separator)
        self.most = [-MOST] * len(self.numbers)
        self.fewest = [MOST] * len(self.numbers)
        if len(cells) == len(names) + 1 and cells[-1] and _is_row_name(line[1], cells[0]):
            self.shift = 1

    def _add(self, rows: Sequence[Row]) -> None:
        """Add rows of which each cell is a number, or none of them."""
        columns = [
            [*map(itemgetter(place + self.shift), rows)]
            for place in (*self.time, *self.found.columns.places)
        ]
        times, cells = columns[: len(self.time)], columns[len(self.time) :]
        numbers = [read_numbers(column) for column in cells]
        if any(self._is_absent(row) for row in rows if self.flags):
            raise ValueError("absent")
        if any(any(map(isnan, column)) for column in numbers):
            raise ValueError("nan")
        decimals = [count_decimals(column) for column in cells]
        self.times.read(times)
        for k, column in enumerate(numbers):
            self.numbers[k].extend(column)
            self.fewest[k] = min(self.fewest[k], decimals[k][0])
            self.most[k] = max(self.most[k], decimals[k][1])

    def _is_absent(self, cells: Row) -> bool:
        """Return True if a row says that a quantity of it was not measured.

        A covariance may be missing: it is not read for anything else.
        """
        said = (cells[each + self.shift] for each in self.flags if each + self.shift < len(cells))
        return any(is_number(cell) and read_number(cell) == ABSENT for cell in said)

    def _add_good(self, block: list[Line], rows: Sequence[Row]) -> None:
        """Add those of some rows that have numbers, and refuse those that have words."""
        for (number, line), cells in zip(block, rows, strict=True):
            self._refuse_longer(number, line, cells)
            try:
                picked = [cells[p + self.shift] for p in (*self.time, *self.found.columns.places)]
            except IndexError:
                raise self._refuse(number, line, "have all columns") from None
            if any(is_missing(cell) for cell in picked):
                self._leave_out(number, picked)
                continue
            try:
                if self._is_absent(cells):
                    self.absent += 1
                    continue
                self._add([cells])
            except SplitStampError:
                wanted = "have a stamp in whole ns (seconds go under t)"
                raise self._refuse(number, picked[0], wanted) from None
            except WRONG:
                raise self._refuse(number, line, "consist of numbers") from None

    def _leave_out(self, number: int, picked: Row) -> None:
        if all(picked):
            self.unreadable += 1
            self.odd = self.odd or number
        else:
            self.empty += 1

    def _refuse(self, number: int, line: str, condition: str) -> RefusedError:
        return RefusedError(
            f"line {number} of {self.path} must {condition}, got {one_line(line, SHOWN)}"
        )

    def _refuse_longer(self, number: int, line: str, cells: Row) -> None:
        count = len(self.found.head.names)
        if any(map(str.strip, cells[count + self.shift :])):
            condition = f"have as many cells as there are names ({count})"
            raise self._refuse(number, line, condition)

    def make(self) -> Table:
        """Return the table."""
        columns, shape = self.found.columns, (len(self.numbers), -1)
        values = np.array([np.frombuffer(each) if each else [] for each in self.numbers])
        values = values.reshape(shape).T * np.array(columns.factors)
        notes = [*columns.notes, *self._list_notes()]
        steps = self._find_steps(values)
        return Table(columns, self.times.make(), values, steps, tuple(notes), self.unreadable)

    def _list_notes(self) -> Iterator[str]:
        """Yield what is odd about the rows, in sentences."""
        if self.shift:
            yield "the first cell of each row has no name: read as the name of the row (R)"
        if self.empty:
            rows = write_count(self.empty, "row", "have")
            yield f"{rows} an empty cell: left out"
        if self.absent:
            rows = write_count(self.absent, "row", "have")
            yield f"{rows} no measurement, as a covariance begins with -1: left out"
        if self.unreadable:
            rows = write_count(self.unreadable, "row", "have")
            yield f"{rows} nan, the first in line {self.odd}: left out"

    def _find_steps(self, values: Real) -> Real:
        """Return the steps of the last decimals (m,) in the units of the program.

        A program that drops zeros writes different numbers of decimals into a column, and those of
        a column that does not change say nothing: its step is that of the others, if it is smaller.
        """
        if not len(values):
            return np.zeros(len(self.numbers))
        steps = 10.0 ** -np.clip(self.most, -MOST, MOST).astype(float)
        still = values.min(axis=0) == values.max(axis=0)
        drops = self.fewest != self.most
        if drops and not still.all():
            steps[still] = np.minimum(steps[still], steps[~still].max())
        return np.asarray(steps * np.array(self.found.columns.factors))


def _is_row_name(line: str, cell: str) -> bool:
    """Return whether the first cell of a row is its name, as R's write.table writes it."""
    return line.lstrip().startswith('"') or cell == "1"
