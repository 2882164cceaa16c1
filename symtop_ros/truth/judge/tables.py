"""Estimates from tables of text: columns with names, TUM and EuRoC, and what is odd about them."""

import csv
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal, InvalidOperation
from itertools import chain
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line, plain
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.tables.attitudes import turn_by_angles, turn_by_matrices
from symtop_ros.truth.tables.columns import (
    DEGREES,
    NUMBERED,
    TIMES,
    Row,
    choose_time,
    describe_empty,
    find_quaternions,
    find_rates,
    find_separator,
    find_turns,
    find_unit,
    is_number,
    join_names,
    refuse_twice,
    split_cells,
    split_names,
    split_units,
)
from symtop_ros.truth.tables.iso import write_seconds
from symtop_ros.truth.topics.estimates import MAX_STAMP, Estimates

DIGITS_OF = {"s": 9, "ms": 6, "us": 3, "ns": 0}  # digits after the point that are whole ns
# Columns without names: EuRoC has ns, position, w, x, y, z, and more; TUM has s, position, x, y, z,
# w; KITTI has twelve numbers of a matrix, and no time.
EUROC, TUM, KITTI = 8, 8, 12
MATRIX = (1, 2, 3, 5, 6, 7, 9, 10, 11)  # places in a row of KITTI with a time in front
POSITIONAL = {
    "ns": "no names of columns: read as EuRoC's, timestamp (ns), position, w, x, y, z",
    "s": "no names of columns: read as TUM's, timestamp (s), position, x, y, z, w",
    "matrix": "no names of columns: read as a time (s) and KITTI's poses, a matrix of 3 rows",
}
NUMBERED_NOTE = "the components q0 to q3 of the quaternion are read as w, x, y, z"
# Seconds since 1970 as a double are off by 1e-7 s, and have up to seven decimals.
EPOCH = 10**18  # ns
DIGITS = 9  # decimals of a time in whole ns


@dataclass(frozen=True)
class ColumnPlaces:
    """Places of the time, the quaternion w, x, y, z or another attitude, and the rates if given."""

    time: int
    numbers: tuple[int, ...]
    unit: str  # of the time: "s", "ms", "us" or "ns"; "" if the numbers show it
    note: str = ""  # what was assumed
    form: str = "wxyz"  # of the attitude, else "matrix", or an order of `attitudes.ORDERS`
    angle: str = ""  # unit of the angles, if their names say it


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of a table, with their times in ns if its unit is right; they may be beyond 64 bits."""

    times: tuple[int, ...]
    numbers: Real  # quaternions w, x, y, z, and angular velocities if there are any
    notes: tuple[str, ...]

    def read(self, part: int = 1, shift: int = 0) -> Estimates:
        """Return the estimates, with times that are so many times shorter, and shifted by ns."""
        stamps = [min(max(each // part + shift, -MAX_STAMP), MAX_STAMP) for each in self.times]
        rates = self.numbers[:, 4:] if self.numbers.shape[1] > 4 else None
        found = Estimates.of(stamps, self.numbers[:, :4], rates)
        return replace(found, notes=(*found.notes, *self.notes))


def read_table(path: Path, order: str | None = None) -> Table:
    """Return the rows of a table: columns with names in any order, TUM, EuRoC, or timed KITTI.

    `order` is that of roll, pitch and yaw, by `attitudes.ORDERS`.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return _read_lines(path, file, order)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except RefusedError:
        raise
    except (csv.Error, ValueError) as error:
        raise RefusedError(f"cannot read {path}: not a table ({one_line(error)})") from None


def _read_lines(path: Path, lines: Iterable[str], order: str | None) -> Table:
    """Read names from a comment or from the first line, and then rows."""
    filled = ((number, line) for number, line in enumerate(lines, 1) if line.strip())
    numbered = join_names(path, filled)
    columns = None
    first = (1, "")
    for number, line in numbered:
        found = _find_names(path, split_names(line), order)
        columns = found or columns
        if not found and not line.startswith("#"):
            first = number, line
            break
    separator = find_separator(first[1])
    columns = columns or _guess_columns(path, split_cells(first[1], separator), first[1])
    rows = [first] if first[1] else []
    rest = (each for each in numbered if not each[1].startswith("#"))
    return _read_rows(path, columns, chain(rows, rest), separator)


def _find_names(path: Path, head: Row, order: str | None) -> ColumnPlaces | None:
    """Return where the columns are, by their names; None if these are no names of columns."""
    names, units = split_units(head)
    times = [place for place, name in enumerate(names) if TIMES.fullmatch(name)]
    groups = find_quaternions(names)
    turns = find_turns(names)
    if not times or not (groups or turns):
        return None
    if not groups:
        return _find_angles(path, (names, units), times, turns, order)
    if len(groups) > 1:
        kinds = " and ".join(one_line(names[places["w"]]) for places in groups.values())
        raise RefusedError(f"{path} must have the columns of one quaternion, got {kinds}")
    (quaternion,) = groups.values()
    wanted = [*(quaternion[each] for each in "wxyz"), *find_rates(names)]
    time = choose_time(names, times)
    refuse_twice(path, names, [time, *wanted])
    is_numbered = NUMBERED.fullmatch(names[quaternion["w"]])
    note = NUMBERED_NOTE if is_numbered else ""
    unit = find_unit(names[time], units[time], [*DIGITS_OF])
    return ColumnPlaces(time, tuple(wanted), unit, note)


def _find_angles(
    path: Path, head: tuple[Row, Row], times: Sequence[int], turns: list[int], order: str | None
) -> ColumnPlaces:
    """Return where roll, pitch and yaw are, and their unit."""
    if order is None:
        raise RefusedError(
            f"--rpy must be the order of roll, pitch and yaw in {path} (zyx: yaw first), got none"
        )
    names, units = head
    time, wanted = choose_time(names, times), [*turns, *find_rates(names)]
    refuse_twice(path, names, [time, *wanted])
    said = units[turns[0]] or names[turns[0]].rpartition("_")[2]
    angle = "degrees" if said in DEGREES else "rad" if said == "rad" else ""
    unit = find_unit(names[time], units[time], [*DIGITS_OF])
    return ColumnPlaces(time, tuple(wanted), unit, form=order, angle=angle)


def _guess_columns(path: Path, head: Row, first: str) -> ColumnPlaces:
    """Return where the columns of a table without names are."""
    numbers = [is_number(cell) for cell in head]
    if len(head) >= EUROC and all(numbers) and head[0].isdecimal() and "," in first:
        return ColumnPlaces(0, (4, 5, 6, 7), "ns", POSITIONAL["ns"])
    if len(head) == TUM and all(numbers):
        return ColumnPlaces(0, (7, 4, 5, 6), "s", POSITIONAL["s"])
    if len(head) == KITTI + 1 and all(numbers):
        return ColumnPlaces(0, MATRIX, "s", POSITIONAL["matrix"], "matrix")
    if len(head) == KITTI and all(numbers):
        raise RefusedError(f"{path} must have times, got poses of KITTI, which lack them")
    raise RefusedError(
        f"{path} must have the columns stamp (ns) or t (s), w, x, y, z, or be a file of TUM or "
        f"EuRoC; got the header {one_line(first) or 'nothing'}"
    )


def _read_rows(
    path: Path, columns: ColumnPlaces, rows: Iterable[tuple[int, str]], separator: str | None
) -> Table:
    times, numbers, lines, empty = [], [], [], 0
    for line, row in rows:
        cells = split_cells(row, separator)
        try:
            picked = [cells[place] for place in columns.numbers]
            if not all(picked):  # as Motive and others leave what was not seen
                empty += 1
                continue
            times.append(write_seconds(plain(cells[columns.time]).strip()))
            Decimal(times[-1])
            numbers.append([float(plain(cell)) for cell in picked])
            lines.append(line)
        except (IndexError, ValueError, InvalidOperation) as error:
            missing = isinstance(error, IndexError)
            condition = "have all columns" if missing else "consist of numbers"
            raise RefusedError(
                f"line {line} of {path} must {condition}, got {one_line(row)}"
            ) from None
    table = np.array(numbers, dtype=float).reshape(-1, len(columns.numbers))
    bad = np.flatnonzero(~np.isfinite(table).all(axis=1))
    infinite = [
        f"{write_count(len(bad), 'row', 'have')} nan or infinity, the first in line {lines[place]}"
        for place in bad[:1]
    ]
    unit = columns.unit or ("s" if any("." in time for time in times) else "ns")
    stamps = [*_read_times(path, times, unit, lines)]
    odd = [columns.note] if columns.note else []
    odd += [*describe_empty(empty), *_describe_times(stamps, unit, times)]
    table, note = _turn(table, columns)
    return Table(tuple(stamps), table, (*infinite, *note, *odd))


def _turn(table: Real, columns: ColumnPlaces) -> tuple[Real, list[str]]:
    """Return rows with quaternions in front, and a note if a unit was assumed."""
    if columns.form == "wxyz":
        return table, []
    if columns.form == "matrix":
        return turn_by_matrices(table), []
    q, unit = turn_by_angles(table[:, :3], columns.form, columns.angle)
    note = [] if columns.angle else [f"roll, pitch and yaw have no unit: read as {unit}"]
    return np.concatenate([q, table[:, 3:]], axis=1), note


def _read_times(path: Path, times: Sequence[str], unit: str, lines: Sequence[int]) -> Iterator[int]:
    """Yield times in ns, without the rounding of a double."""
    for text, line in zip(times, lines, strict=True):
        number = Decimal(text)
        if unit == "ns" and number.is_finite() and number != number.to_integral_value():
            raise RefusedError(
                f"line {line} of {path} must have a stamp in whole ns (seconds go under t), got "
                f"{text}"
            )
        try:
            yield int(number.scaleb(DIGITS_OF[unit]).to_integral_value())
        except (OverflowError, ValueError, InvalidOperation):
            raise RefusedError(
                f"line {line} of {path} must consist of numbers, got {text}"
            ) from None


def _describe_times(stamps: Sequence[int], unit: str, times: Row) -> Iterator[str]:
    """Name times that repeat, and times that doubles have rounded."""
    counts: dict[int, int] = {}
    for stamp in stamps:
        counts[stamp] = counts.get(stamp, 0) + 1
    if repeated := len(stamps) - len(counts):
        first = max(counts, key=lambda each: counts[each]) / NANOSECONDS
        rows = "row repeats" if repeated == 1 else "rows repeat"
        yield f"{repeated} {rows} a time, among them {first:.9g} s"
    decimals = max((len(time.partition(".")[2]) for time in times), default=0)
    latest = max(stamps, default=0)
    if unit == "s" and EPOCH < latest <= MAX_STAMP and decimals < DIGITS:
        off = np.spacing(latest / NANOSECONDS) / 2
        yield (
            f"t has {decimals} decimals, as doubles of epoch seconds have: it is off by up to "
            f"{max(off, 0.5 * 10.0**-decimals):.1g} s. Write the column stamp, in ns"
        )
