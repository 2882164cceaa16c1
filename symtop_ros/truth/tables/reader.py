"""One reader of tables of text, for each program that takes one.

It finds the names of columns within the first lines, with their units; of a form without names it
knows them by its numbers. Then it reads the cells that a program wants, as they are written: times
without the rounding of a double, and numbers with the step of their last decimal. Rows without a
number where one is wanted are left out, and rows that are there twice count once; both are said.
"""

import csv
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from decimal import DecimalException
from itertools import chain
from math import isnan
from operator import itemgetter
from pathlib import Path
from typing import Protocol

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.truth.tables.cells import (
    Row,
    choose_separator,
    count_decimals,
    find_separator,
    is_missing,
    read_numbers,
    split_cells,
    split_lines,
)
from symtop_ros.truth.tables.columns import Head, find_times
from symtop_ros.truth.tables.forms import find_encoding, read_start
from symtop_ros.truth.tables.heads import find_form, is_data, is_units, join_names
from symtop_ros.truth.tables.times import SplitStampError, TimeReader, Times

HEAD = 10  # lines within which the names of columns are looked for
BLOCK = 1000  # rows that are read together
REPORT_EVERY = 100  # blocks
MOST = 300  # decimals of a double, nearly
SHOWN = 80  # characters of a row in a message
WRONG = (ValueError, DecimalException, OverflowError)  # of cells that are no numbers
Line = tuple[int, str]  # with its number
Report = Callable[[int], None]


@dataclass(frozen=True)
class Columns:
    """Columns that a program reads.

    Attributes
    ----------
    kind : str
        What they are, in a word of the program.
    places : tuple of int
    factors : tuple of float
        Of the units of each, or one of all.
    notes : tuple of str
        What was assumed.
    unit : str
        Of angles, if their names say it.
    """

    kind: str
    places: tuple[int, ...]
    factors: tuple[float, ...] = (1.0,)
    notes: tuple[str, ...] = ()
    unit: str = ""


class Wanted(Protocol):
    """What a program reads of a table."""

    def find(self, head: Head) -> Columns | None:
        """Return the columns by their names; None if these are no names of them."""

    def describe(self, path: Path, first: str) -> str:
        """Return the refusal of a table that lacks them, whose first line is given."""


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


def read_table(path: Path, wanted: Wanted, report: Report | None = None) -> Table:
    """Return the rows of a table.

    `report` is called with the number of characters that were read, now and then.

    Raises
    ------
    RefusedError
        If it is no table of text, or has other columns, or a row that is no row of numbers.
    """
    encoding = find_encoding(path, read_start(path))
    try:
        with path.open(encoding=encoding) as file:
            return _read_lines(path, file, wanted, report)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except RefusedError:
        raise
    except (csv.Error, ValueError) as error:
        raise RefusedError(f"cannot read {path}: not a table ({one_line(error)})") from None


def _read_lines(path: Path, file: Iterable[str], wanted: Wanted, report: Report | None) -> Table:
    filled = ((number, line) for number, line in enumerate(file, 1) if line.strip())
    lines = join_names(path, filled)
    found = _find_names(path, lines, wanted)
    time, unit = find_times(found.head)
    is_stamp = "stamp" in found.head.names[time[0]]
    rows = RowReader(path, found, time, TimeReader(unit, is_stamp=is_stamp))
    done = 0
    for number, block in enumerate(_list_blocks(chain(found.rest, lines))):
        rows.read(block)
        done += sum(len(line) for _, line in block)
        if report and number % REPORT_EVERY == 0:
            report(done)
    return rows.make()


def _list_blocks(lines: Iterator[Line]) -> Iterator[list[Line]]:
    block: list[Line] = []
    for line in lines:
        if not line[1].startswith("#"):
            block.append(line)
        if len(block) == BLOCK:
            yield block
            block = []
    if block:
        yield block


@dataclass(frozen=True)
class Found:
    """The names of a table, its columns, and the first row if it has been read."""

    head: Head
    columns: Columns
    rest: tuple[Line, ...] = ()


def _find_names(path: Path, lines: Iterator[Line], wanted: Wanted) -> Found:
    """Find the names within the first lines; those nearest to the rows count."""
    found: Found | None = None
    above: list[str] = []  # lines that are no comments
    for line in lines:
        is_comment = line[1].startswith("#")
        head = Head.of(path, line[1])
        if new := _try_names(head, wanted):
            found = Found(head, new)
        elif found and not is_comment:
            return _take_units(found, line, wanted)
        elif not is_comment and (new_form := _guess_names(path, line, above, wanted)):
            return new_form
        above += [] if is_comment or found else [line[1]]
        if len(above) >= HEAD:
            break
    if found:
        return found
    raise RefusedError(wanted.describe(path, one_line(above[0], SHOWN) if above else "nothing"))


def _try_names(head: Head, wanted: Wanted) -> Columns | None:
    times, _ = find_times(head) if len(head.names) > 1 else ((), "")
    columns = wanted.find(head) if times else None
    if columns:
        head.refuse_twice([*times, *columns.places])
    return columns


def _take_units(found: Found, line: Line, wanted: Wanted) -> Found:
    """Return the names with the units of a row below them, or with a first row of numbers."""
    cells = split_cells(line[1], choose_separator(line[1], len(found.head.names)))
    if not is_units(cells, found.columns.places):
        return replace(found, rest=(line,))
    head = found.head.take_units(cells)
    return Found(head, wanted.find(head) or found.columns)


def _guess_names(path: Path, line: Line, above: list[str], wanted: Wanted) -> Found | None:
    """Return names of a form without names; a row below unknown names has none."""
    separator = find_separator(line[1])
    cells = split_cells(line[1], separator)
    if any(len(split_cells(each, separator)) == len(cells) for each in above):
        return None
    form = find_form(path, cells, separator)
    head = Head.read(path, form.names) if form else None
    columns = _try_names(head, wanted) if head else None
    if form and head and columns:
        noted = replace(columns, notes=(form.note, *columns.notes))
        return Found(head, noted, rest=(line,))
    if is_data(cells):
        raise RefusedError(wanted.describe(path, one_line((above or [line[1]])[0], SHOWN)))
    return None


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

    def __post_init__(self) -> None:
        """Make a place for each column."""
        self.numbers = [array("d") for _ in self.found.columns.places]

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
        if any(any(map(isnan, column)) for column in numbers):
            raise ValueError("nan")
        decimals = [count_decimals(column) for column in cells]
        self.times.read(times)
        for k, column in enumerate(numbers):
            self.numbers[k].extend(column)
            self.fewest[k] = min(self.fewest[k], decimals[k][0])
            self.most[k] = max(self.most[k], decimals[k][1])

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
