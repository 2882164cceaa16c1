"""Records from tables of text: columns with the names of our tables and those of other tools.

Angles may be in degrees, if the name of a column says so; numbers may have decimal commas. Rows in
which a cell is empty are left out: Tracker leaves cells empty where nothing was seen.
"""

from array import array
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line, plain
from symtop_ros.truth.fit.kinds import KINDS
from symtop_ros.truth.judge.columns import (
    ANGLES,
    AXIS,
    POINT,
    TIMES,
    choose_time,
    find_quaternions,
    find_rates,
    find_separator,
    find_unit,
    refuse_twice,
    split_cells,
    split_names,
    split_units,
)

HEAD = 10  # lines within which the names of columns are looked for
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "": 1.0}
DEGREES = ("deg", "degree", "degrees", "°", "deg/s", "°/s", "dps")
REPORT_EVERY = 100_000  # lines
# A table may have the columns of several kinds; what was measured comes before exact truth.
ORDER = ("angles", "theta", "pixels", "measured", "attitude", "rates", "axis")


@dataclass(frozen=True)
class Places:
    """Places of the time and of the columns of a kind, and the factors of their units."""

    kind: str
    time: int
    columns: tuple[int, ...]
    seconds: float  # of the unit of time; 0: ns if the numbers are whole
    factors: tuple[float, ...]
    others: tuple[str, ...]  # kinds that the table has as well


@dataclass(frozen=True, eq=False)
class Rows:
    """Numbers of a table."""

    kind: str
    times: Real
    values: Real
    notes: tuple[str, ...]


def read_rows(path: Path, kind: str | None, tell: Callable[[int], None] | None = None) -> Rows:
    """Return the rows of a table of a kind; without one, of the kind that its columns say.

    `tell` is called with the number of bytes that were read, now and then.
    """
    try:
        with path.open(encoding="utf-8-sig", errors="strict", newline="") as file:
            return _read_lines(path, file, kind, tell)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise RefusedError(f"cannot read {path}: not a table of text") from None


def _read_lines(
    path: Path, file: Iterable[str], kind: str | None, tell: Callable[[int], None] | None
) -> Rows:
    """Find the names within the first lines, and read the rows after them."""
    numbered = ((number, line) for number, line in enumerate(file, 1) if line.strip())
    head = ""
    for number, line in numbered:
        head = head or line
        if places := find_places(path, split_names(line), kind):
            break
        if number >= HEAD:
            numbered = iter(())
    else:
        raise RefusedError(_describe_names(path, kind, head))
    return _read_numbers(path, places, numbered, tell)


def _describe_names(path: Path, kind: str | None, head: str) -> str:
    wanted = " or ".join(
        ", ".join(each.columns) for each in KINDS.values() if kind in {None, each.name}
    )
    got = one_line(head, 80) or "nothing"
    return f"{path} must have the columns t (s) or stamp (ns) and {wanted}, got {got}"


def find_places(path: Path, head: list[str], kind: str | None) -> Places | None:
    """Return where the columns of a kind are; None if these are no names of them."""
    names, units = split_units(head)
    times = [place for place, name in enumerate(names) if TIMES.fullmatch(name)]
    found = {name: places for name, places in _list_kinds(names) if kind in {None, _name(name)}}
    if not times or not found:
        return None
    chosen = min(found, key=ORDER.index)
    time, columns = choose_time(names, times), found[chosen]
    refuse_twice(path, names, [time, *columns])
    unit = find_unit(names[time], units[time], [*SECONDS])
    others = tuple(dict.fromkeys(_name(name) for name in found if _name(name) != _name(chosen)))
    factors = tuple(_find_factor(units[place], _name(chosen)) for place in columns)
    seconds = SECONDS[unit] if unit else 0.0
    return Places(_name(chosen), time, tuple(columns), seconds, factors, others)


def _name(name: str) -> str:
    return "rates" if name == "measured" else name


def _find_factor(unit: str, kind: str) -> float:
    return np.pi / 180 if unit in DEGREES and kind in {"angles", "theta", "rates"} else 1.0


def _list_kinds(names: list[str]) -> Iterator[tuple[str, list[int]]]:
    """Yield the kinds of which a table has all columns, with their places."""
    quaternions = find_quaternions(names)
    if len(quaternions) == 1:
        (places,) = quaternions.values()
        yield "attitude", [places[each] for each in "wxyz"]
    if rates := find_rates(names):
        is_measured = names[rates[0]].startswith("measured")
        yield "measured" if is_measured else "rates", rates
    angles = {
        angle: place
        for angle, pattern in ANGLES.items()
        for place, name in enumerate(names)
        if pattern.fullmatch(name)
    }
    if "theta" in angles:
        yield ("angles", [angles["theta"], angles["phi"]]) if len(angles) == 2 else (
            "theta",
            [angles["theta"]],
        )
    yield from _list_points(names, bool(quaternions))


def _list_points(names: list[str], has_quaternion: bool) -> Iterator[tuple[str, list[int]]]:
    """Yield the axis, or a point of a picture: u and v, or Tracker's x and y without z."""
    axis = {found[1]: k for k, name in enumerate(names) if (found := AXIS.fullmatch(name))}
    point = {found[1]: k for k, name in enumerate(names) if (found := POINT.fullmatch(name))}
    if "u" in point and "v" in point:
        yield "pixels", [point["u"], point["v"]]
    elif len(axis) == 3 and not has_quaternion:
        yield "axis", [axis[each] for each in "xyz"]
    elif "x" in point and "y" in point and "z" not in axis:
        yield "pixels", [point["x"], point["y"]]


def _read_numbers(
    path: Path,
    places: Places,
    rows: Iterator[tuple[int, str]],
    tell: Callable[[int], None] | None,
) -> Rows:
    """Read the rows; the first of them shows what separates the cells."""
    numbers, wanted = array("d"), (places.time, *places.columns)
    separator: str | None = None
    empty = count = done = 0
    whole = True
    for line, text in rows:
        if text.startswith("#"):
            continue
        if not count:
            separator = ";" if ";" in text else "\t" if "\t" in text else find_separator(text)
        count += 1
        done += len(text)
        if tell and count % REPORT_EVERY == 0:
            tell(done)
        cells = split_cells(text, separator)
        try:
            picked = [cells[place] for place in wanted]
        except IndexError:
            raise RefusedError(f"line {line} of {path} must have all columns, got {one_line(text)}") from None
        if not all(picked):
            empty += 1
            continue
        try:
            numbers.extend([_read_number(cell, separator) for cell in picked])
        except ValueError:
            raise RefusedError(
                f"line {line} of {path} must consist of finite numbers, or cells that are empty, "
                f"got {one_line(text)}"
            ) from None
        whole = whole and picked[0].lstrip("-").isdecimal()
    table = np.frombuffer(numbers, dtype=float).reshape(-1, len(wanted))
    notes = [f"{write_count(empty, 'row', 'have')} an empty cell, and are left out"] if empty else []
    if places.others:
        notes.append(f"read as {places.kind}; it has {' and '.join(places.others)} as well: --kind")
    seconds = places.seconds or (1e-9 if whole else 1.0)
    times = (table[:, 0] - (table[0, 0] if len(table) else 0.0)) * seconds
    return Rows(places.kind, times, table[:, 1:] * places.factors, tuple(notes))


def _read_number(cell: str, separator: str | None) -> float:
    value = float(plain(cell.replace(",", ".") if separator != "," else cell))
    if not np.isfinite(value):
        raise ValueError(cell)
    return value
