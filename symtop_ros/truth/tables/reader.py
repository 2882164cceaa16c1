"""One reader of tables of text, for each program that takes one.

It finds the names of columns within the first lines, with their units; in a form without names it
knows the columns from the numbers. Then it reads the cells that a program wants, as they are
written: times without the rounding of a double, and numbers with the step of their last decimal.
Rows without a number where one is wanted are left out, and counted.
"""

import csv
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.truth.tables.cells import choose_separator, find_separator, split_cells
from symtop_ros.truth.tables.columns import Head, find_times
from symtop_ros.truth.tables.forms import find_encoding, read_start
from symtop_ros.truth.tables.heads import find_form, is_data, is_units, join_names
from symtop_ros.truth.tables.rows import RowReader
from symtop_ros.truth.tables.table import Columns, Found, Line, Table, Wanted
from symtop_ros.truth.tables.times import TimeReader

HEAD = 10  # lines within which the names of columns are looked for
BLOCK = 1000  # rows that are read together
REPORT_EVERY = 100  # blocks
SHOWN = 80  # characters of a line in a message
Report = Callable[[int], None]


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
