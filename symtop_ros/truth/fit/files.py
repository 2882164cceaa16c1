"""Records from tables of text: columns with the names of our tables and those of other tools.

Angles may be in degrees, if the name of a column says so; numbers may have decimal commas. Rows in
which a cell is empty are left out: Tracker leaves cells empty where nothing was seen.
"""

from array import array
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError, one_line, plain
from symtop_ros.physics import DEFAULT_GRAVITY
from symtop_ros.truth.fit.kinds import KINDS
from symtop_ros.truth.tables.columns import (
    ANGLES,
    AXIS,
    DEGREES,
    FORCES,
    POINT,
    TIMES,
    choose_time,
    describe_empty,
    find_quaternions,
    find_rates,
    find_separator,
    find_unit,
    join_names,
    refuse_twice,
    split_cells,
    split_names,
    split_units,
)

HEAD = 10  # lines within which the names of columns are looked for
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
ANGULAR = ("angles", "theta", "rates", "inertial")  # kinds with angles or their rates
G = ("g",)
REPORT_EVERY = 100_000  # lines
# A table may have the columns of several kinds; what was measured comes before exact truth.
ORDER = ("angles", "theta", "pixels", "measured", "attitude", "rates", "inertial", "axis")


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


def read_rows(path: Path, kind: str | None, report: Callable[[int], None] | None = None) -> Rows:
    """Return the rows of a table of a kind; without one, of the kind that its columns say.

    `report` is called with the number of bytes that were read, now and then.
    """
    try:
        with path.open(encoding="utf-8-sig", errors="strict", newline="") as file:
            return _read_lines(path, file, kind, report)
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise RefusedError(f"cannot read {path}: not a table of text") from None


def _read_lines(
    path: Path, file: Iterable[str], kind: str | None, report: Callable[[int], None] | None
) -> Rows:
    """Find the names within the first lines, and read the rows after them."""
    filled = ((number, line) for number, line in enumerate(file, 1) if line.strip())
    numbered = join_names(path, filled)
    head = ""
    for _, line in islice(numbered, HEAD):
        head = head or line
        if places := find_places(path, split_names(line), kind):
            return _read_numbers(path, places, numbered, report)
    raise RefusedError(_describe_names(path, kind, head))


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
    if unit in G:
        return DEFAULT_GRAVITY
    return np.pi / 180 if unit in DEGREES and kind in ANGULAR else 1.0


def _list_kinds(names: list[str]) -> Iterator[tuple[str, list[int]]]:
    """Yield the kinds of which a table has all columns, with their places."""
    quaternions = find_quaternions(names)
    if len(quaternions) == 1:
        (places,) = quaternions.values()
        yield "attitude", [places[each] for each in "wxyz"]
    if rates := find_rates(names, ("measured_", "")):
        is_measured = names[rates[0]].startswith("measured")
        yield "measured" if is_measured else "rates", rates
    forces = find_rates(names, ("measured_", ""), FORCES)
    if rates and forces:
        yield "inertial", [*rates, *forces]
    angles = {
        angle: place
        for angle, pattern in ANGLES.items()
        for place, name in enumerate(names)
        if pattern.fullmatch(name)
    }
    if "theta" in angles:
        yield (
            ("angles", [angles["theta"], angles["phi"]])
            if len(angles) == 2
            else (
                "theta",
                [angles["theta"]],
            )
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


@dataclass(eq=False)
class Lines:
    """Cells of a table, in the order of its lines."""

    path: Path
    wanted: tuple[int, ...]
    numbers: "array[float]"
    separator: str | None = None
    rows: int = 0
    empty: int = 0
    is_whole: bool = True  # all times are whole numbers

    def read(self, line: int, text: str) -> None:
        """Read a line; the first one shows what separates the cells."""
        if not self.rows:
            self.separator = next((s for s in (";", "\t") if s in text), find_separator(text))
        self.rows += 1
        cells = split_cells(text, self.separator)
        try:
            picked = [cells[place] for place in self.wanted]
            if all(picked):
                self.numbers.extend([_read_number(cell, self.separator) for cell in picked])
            else:
                self.empty += 1
        except (IndexError, ValueError) as error:
            lacks = isinstance(error, IndexError)
            wanted = "have all columns" if lacks else "have finite numbers, or empty cells"
            raise RefusedError(
                f"line {line} of {self.path} must {wanted}, got {one_line(text, 80)}"
            ) from None
        self.is_whole = self.is_whole and picked[0].lstrip("-").isdecimal()


def _read_numbers(
    path: Path,
    places: Places,
    lines: Iterable[tuple[int, str]],
    report: Callable[[int], None] | None,
) -> Rows:
    """Read the rows, and say what was left out."""
    done = 0
    table = Lines(path, (places.time, *places.columns), array("d"))
    for line, text in lines:
        if not text.startswith("#"):
            table.read(line, text)
        done += len(text)
        if report and table.rows % REPORT_EVERY == 0:
            report(done)
    numbers = np.frombuffer(table.numbers, dtype=float).reshape(-1, len(table.wanted))
    seconds = places.seconds or (1e-9 if table.is_whole else 1.0)
    times = (numbers[:, 0] - (numbers[0, 0] if len(numbers) else 0.0)) * seconds
    values = numbers[:, 1:] * places.factors
    return Rows(places.kind, times, values, tuple(_write_notes(table, places)))


def _write_notes(table: Lines, places: Places) -> Iterator[str]:
    """Yield what was odd about a table."""
    yield from describe_empty(table.empty)
    if places.others:
        others = " and ".join(places.others)
        yield f"read as {places.kind}; the table has {others} as well (--kind)"


def _read_number(cell: str, separator: str | None) -> float:
    value = float(plain(cell.replace(",", ".") if separator != "," else cell))
    if not np.isfinite(value):
        raise ValueError(cell)
    return value
