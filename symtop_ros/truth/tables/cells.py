"""Cells of a line, and numbers as they are written."""

import csv
from collections.abc import Sequence
from itertools import repeat

from symtop_ros.base.refusals import plain

SEPARATORS = (";", "\t", ",")  # else any white space; the first two leave the comma to decimals
MISSING = frozenset(("", "nan", "na", "n/a", "null", "-", "--"))  # in small letters
Row = Sequence[str]


def find_separator(line: str) -> str | None:
    """Return the separator of the cells of a line; None for white space."""
    return next((each for each in SEPARATORS if each in line), None)


def choose_separator(line: str, count: int) -> str | None:
    """Return the separator that gives a row the required number of cells; 0: any number.

    A row of `0,5 1,5` between names without commas is separated by spaces.
    """
    if count:
        for separator in (*SEPARATORS, None):
            cells = split_cells(line, separator)
            if len(cells) - (not cells[-1]) == count or len(cells) == count:
                return separator
    return find_separator(line)


def split_cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line."""
    if separator is None and '"' not in line:
        return line.split() or [""]
    (cells,) = split_lines([line], separator)
    return [cell.strip() for cell in cells]


def split_lines(lines: Sequence[str], separator: str | None) -> list[list[str]]:
    """Return the cells of some lines, with blanks after them.

    Raises
    ------
    csv.Error
        If a quote does not end in its line.
    """
    if separator is None:
        if not any('"' in line for line in lines):
            return [line.split() for line in lines]
        lines, separator = [line.strip().replace("\t", " ") for line in lines], " "
    rows = list(csv.reader(lines, delimiter=separator, skipinitialspace=True))
    if len(rows) != len(lines):
        raise csv.Error("a quote does not end")
    return rows


def is_missing(cell: str) -> bool:
    """Return whether a cell stands for a missing number."""
    return cell.strip().lower() in MISSING


def read_number(cell: str) -> float:
    """Return a number, which may have a decimal comma."""
    return float(plain(cell.replace(",", ".")))


def is_number(cell: str) -> bool:
    """Return whether a cell is a number."""
    try:
        read_number(cell)
    except ValueError:
        return False
    return True


def read_numbers(column: Row) -> list[float]:
    """Return the numbers of cells that are all written as numbers."""
    text = "".join(column)
    if "," in text or "_" in text:
        return [*map(read_number, column)]
    return [*map(float, column)]


def count_decimals(column: Row) -> tuple[int, int]:
    """Return the fewest and the most decimals of cells; those of `1.5e-3` are four.

    Examples
    --------
    >>> count_decimals(["200.000", "1.5", "7"]), count_decimals(["1.5e-3", "2E2"])
    ((0, 3), (-2, 4))
    """
    text = "".join(column)
    if "," in text or " " in text:
        column = [cell.strip().replace(",", ".") for cell in column]
    if "e" in text or "E" in text:
        sizes = [*map(_count_decimals, column)]
        return min(sizes), max(sizes)
    sizes = [len(tail) for _, _, tail in map(str.partition, column, repeat("."))]
    return min(sizes), max(sizes)


def _count_decimals(cell: str) -> int:
    mantissa, _, exponent = cell.lower().partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or "0")
