"""Estimates from tables of text: columns with names, TUM and EuRoC, and what is odd about them."""

import csv
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal, InvalidOperation
from itertools import chain
from pathlib import Path

import numpy as np

from symtop_ros.judge.estimates import MAX_STAMP, Estimates
from symtop_ros.simulation.validation import RefusedError, one_line, plain
from symtop_ros.wire.layout import NANOSECONDS

TABLES = (".csv", ".tum", ".txt")  # endings of files that are no logs
SEPARATORS = (",", ";", "\t")  # else any white space
COLUMNS, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
STAMP, SECONDS = "stamp", "t"
# ColumnPlaces without names: EuRoC has ns, position, w, x, y, z, and more; TUM has s, position,
# x, y, z, w; KITTI has twelve numbers of a matrix, and no time.
EUROC, TUM, KITTI = 8, 8, 12
# Seconds since 1970 as a double are off by 1e-7 s, and have up to seven decimals.
EPOCH, DIGITS = 10**18, 9  # ns; decimals of a time in whole ns
Row = Sequence[str]


@dataclass(frozen=True)
class ColumnPlaces:
    """ColumnPlaces of a table with the time, the quaternion w, x, y, z, and the rates if given."""

    time: int
    numbers: tuple[int, ...]
    in_seconds: bool
    has_names: bool = True  # in the first line, which is then no row


def read_table(path: Path) -> Estimates:
    """Return the estimates of a table: columns with names, TUM, or EuRoC."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return _read_lines(path, file)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except RefusedError:
        raise
    except (csv.Error, ValueError) as error:
        raise RefusedError(f"cannot read {path}: not a table ({one_line(error)})") from None


def _read_lines(path: Path, lines: Iterable[str]) -> Estimates:
    numbered = ((number, line) for number, line in enumerate(lines, 1) if line.strip())
    number, first = next(numbered, (1, ""))
    separator = next((each for each in SEPARATORS if each in first), None)
    head = _split(first, separator)
    while first.startswith("#") and separator is None and not _is_named(head):
        number, first = next(numbered, (1, ""))  # a comment, as TUM has
        head = _split(first, separator)
    columns = _find_columns(path, head, first, separator)
    rows = [] if columns.has_names else [(number, first)]
    rest = (each for each in numbered if not each[1].startswith("#"))
    return _read_rows(path, columns, chain(rows, rest), separator)


def _split(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [cell.strip() for cell in cells]


def _is_named(head: Row) -> bool:
    return set(COLUMNS) <= {name.lstrip("# ") for name in head}


def _find_columns(path: Path, head: Row, first: str, separator: str | None) -> ColumnPlaces:
    """Return where the columns are, from the first line."""
    names = [name.lstrip("# ") for name in head]
    if separator is None and names and not names[0]:  # "# t w x y z"
        names = names[1:]
    if _is_named(head) and {STAMP, SECONDS} & set(names):
        time = STAMP if STAMP in names else SECONDS
        wanted = [*COLUMNS, *(RATES if set(RATES) <= set(names) else ())]
        places = tuple(names.index(name) for name in wanted)
        return ColumnPlaces(names.index(time), places, time == SECONDS)
    if separator == "," and len(head) >= EUROC and names[0].startswith("timestamp"):
        return ColumnPlaces(0, (4, 5, 6, 7), in_seconds=False)
    if separator == "," and len(head) >= EUROC and names[0].isdecimal():
        return ColumnPlaces(0, (4, 5, 6, 7), in_seconds=False, has_names=False)
    if separator is None and len(head) == TUM and _is_number(head[0]):
        return ColumnPlaces(0, (7, 4, 5, 6), in_seconds=True, has_names=False)
    if separator is None and len(head) == KITTI and _is_number(head[0]):
        raise RefusedError(f"{path} must have times, got poses of KITTI, which lack them")
    raise RefusedError(
        f"{path} must have the columns stamp (ns) or t (s), w, x, y, z, or be a file of TUM or "
        f"EuRoC; got the header {one_line(first) or 'nothing'}"
    )


def _is_number(text: str) -> bool:
    try:
        float(plain(text))
    except ValueError:
        return False
    return True


def _read_rows(
    path: Path, columns: ColumnPlaces, rows: Iterable[tuple[int, str]], separator: str | None
) -> Estimates:
    to_ns: Callable[[str], int] = _to_nanoseconds if columns.in_seconds else int
    stamps, numbers, lines, decimals = [], [], [], 0
    for line, row in rows:
        cells = _split(row, separator)
        try:
            time = plain(cells[columns.time])
            stamps.append(min(max(to_ns(time), -MAX_STAMP), MAX_STAMP))
            numbers.append([float(plain(cells[place])) for place in columns.numbers])
            lines.append(line)
            decimals = max(decimals, len(time.strip().partition(".")[2]))
        except (IndexError, ValueError, InvalidOperation, OverflowError) as error:
            condition = (
                "have all columns" if isinstance(error, IndexError) else "consist of numbers"
            )
            raise RefusedError(
                f"line {line} of {path} must {condition}, got {one_line(row)}"
            ) from None
    table = np.array(numbers, dtype=float).reshape(-1, len(columns.numbers))
    bad = np.flatnonzero(~np.isfinite(table).all(axis=1))
    infinite = [
        f"{len(bad)} rows have nan or infinity, the first in line {lines[place]}"
        for place in bad[:1]
    ]
    odd = _describe_times(stamps, columns.in_seconds, decimals)
    rates = table[:, 4:] if table.shape[1] > 4 else None
    return replace(Estimates.of(stamps, table[:, :4], rates), notes=(*infinite, *odd))


def _describe_times(stamps: Sequence[int], seconds: bool, decimals: int) -> Iterator[str]:
    """Name times that repeat, and times that doubles have rounded."""
    times, counts = np.unique(np.asarray(stamps, dtype=np.int64), return_counts=True)
    if repeated := int(counts.sum() - len(counts)):
        first = times[counts.argmax()] / NANOSECONDS
        yield f"{repeated} rows repeat a time, among them {first:.9g} s"
    if seconds and len(times) and times[-1] > EPOCH and decimals < DIGITS:
        off = np.spacing(times[-1] / NANOSECONDS) / 2
        yield (
            f"t has {decimals} decimals, as doubles of epoch seconds have: it is off by up to "
            f"{max(off, 0.5 * 10.0**-decimals):.1g} s. Write the column stamp, in ns"
        )


def _to_nanoseconds(text: str) -> int:
    """Return a time in s as ns, without the rounding of a double."""
    return int((Decimal(text) * NANOSECONDS).to_integral_value())
