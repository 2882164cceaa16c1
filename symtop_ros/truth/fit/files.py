"""Records from tables of text: columns with the names of our tables and those of other tools."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.kinds import KINDS, READ
from symtop_ros.truth.residuals.sampling import (
    describe_repeats,
    find_repeats,
)
from symtop_ros.truth.tables.attitudes import turn_by_matrices
from symtop_ros.truth.tables.columns import (
    ANGLE_UNITS,
    ANGLES,
    AXIS,
    FORCE_UNITS,
    FORCES,
    POINT,
    RATE_UNITS,
    Head,
    find_matrix,
    find_quaternions,
    find_rates,
)
from symtop_ros.truth.tables.reader import Report, read_table
from symtop_ros.truth.tables.table import Columns, Table

# A table may have the columns of several kinds; what was measured comes before exact truth.
ORDER = ("angles", "theta", "pixels", "measured", "attitude", "matrix", "rates", "inertial", "axis")
KIND_OF = {"measured": "rates", "matrix": "attitude"}  # other kinds have their own names
ANGLE_WORDS, RATE_WORDS = "rad or degrees", "rad/s, deg/s or rpm"
Places = list[int]


@dataclass(frozen=True, eq=False)
class Rows:
    """Numbers of a table or a log, with the steps (m,) of their last decimals; 0: not known."""

    kind: str
    times: Real
    values: Real
    notes: tuple[str, ...]
    steps: Real | None = None

    def count_once(self) -> "Rows":
        """Return the rows without repeated ones."""
        again = find_repeats(self.times, self.values)
        if not again.any():
            return self
        notes = (*self.notes, *describe_repeats(self.times[again]))
        return Rows(self.kind, self.times[~again], self.values[~again], notes, self.steps)


@dataclass(frozen=True)
class WantedKind:
    """The columns of a kind of record; if no kind is given, the columns decide it."""

    kind: str | None

    def find(self, head: Head) -> Columns | None:
        """Return the columns of the kind by their names."""
        found = {
            name: places for name, places in _list_kinds(head.names) if self._takes(_name(name))
        }
        if not found:
            return None
        chosen = min(found, key=ORDER.index)
        others = dict.fromkeys(_name(name) for name in found if _name(name) != _name(chosen))
        names = " and ".join(others)
        note = f"read as {_name(chosen)}; the table has {names} as well (--kind)"
        return Columns(
            chosen,
            tuple(found[chosen]),
            _find_factors(head, _name(chosen), found[chosen]),
            (note,) if others else (),
        )

    def _takes(self, kind: str) -> bool:
        return self.kind in {None, kind}

    def describe(self, path: Path, first: str) -> str:
        """Return the refusal of a table without such columns."""
        kinds = (KINDS[name] for name in READ if self._takes(name))
        wanted = (", ".join(each.columns) for each in kinds)
        names = "; or ".join(wanted)
        return (
            f"{path} must have a column t (s) or stamp (ns), and the columns {names}; got {first}"
        )


def _name(name: str) -> str:
    return KIND_OF.get(name, name)


def _find_factors(head: Head, kind: str, places: Places) -> tuple[float, ...]:
    """Return the factors of the units of columns; those of points and quaternions do not matter."""
    if kind in {"angles", "theta"}:
        return head.find_factors(places, ANGLE_UNITS, ANGLE_WORDS)
    if kind in {"rates", "inertial"}:
        rates = head.find_factors(places[:3], RATE_UNITS, RATE_WORDS)
        return (*rates, *head.find_factors(places[3:], FORCE_UNITS, "m/s^2 or g"))
    return (1.0,) * len(places)


def read_rows(path: Path, kind: str | None, report: Report | None = None) -> Rows:
    """Return the rows of a table; if no kind is given, its columns decide it.

    `report` is called with the number of characters that were read, now and then.
    """
    table = read_table(path, WantedKind(kind), report)
    infinite = ~np.isfinite(table.values).all(axis=1)
    if infinite.any():
        row = int(np.argmax(infinite)) + 1
        raise RefusedError(f"{path} must have finite numbers, or empty cells, got inf in row {row}")
    return _make_rows(table)


def _make_rows(table: Table) -> Rows:
    is_matrix = table.columns.kind == "matrix"
    return Rows(
        _name(table.columns.kind),
        table.times.seconds,
        turn_by_matrices(table.values) if is_matrix else table.values,
        table.notes,
        None if is_matrix else table.steps,
    )


def _list_kinds(names: tuple[str, ...]) -> Iterator[tuple[str, Places]]:
    """Yield the kinds of which a table has all columns, with their places."""
    quaternions = find_quaternions(names)
    if len(quaternions) == 1:
        (places,) = quaternions.values()
        yield "attitude", [places[each] for each in "wxyz"]
    if matrix := find_matrix(names):
        yield "matrix", matrix
    if rates := find_rates(names, ("measured_", "")):
        is_measured = names[rates[0]].startswith("measured")
        yield "measured" if is_measured else "rates", rates
    forces = find_rates(names, ("measured_", ""), FORCES)
    if rates and forces:
        yield "inertial", [*rates, *forces]
    yield from _list_angles(names)
    yield from _list_points(names, bool(quaternions))


def _list_angles(names: tuple[str, ...]) -> Iterator[tuple[str, Places]]:
    """Yield the tilt alone, or with the azimuth."""
    angles = {
        angle: place
        for angle, pattern in ANGLES.items()
        for place, name in enumerate(names)
        if pattern.fullmatch(name)
    }
    if len(angles) == len(ANGLES):
        yield "angles", [angles["theta"], angles["phi"]]
    elif "theta" in angles:
        yield "theta", [angles["theta"]]


def _list_points(names: tuple[str, ...], has_quaternion: bool) -> Iterator[tuple[str, Places]]:
    """Yield the axis, or a point of a picture: u and v, or Tracker's x and y without z."""
    axis = {found[1]: k for k, name in enumerate(names) if (found := AXIS.fullmatch(name))}
    point = {found[1]: k for k, name in enumerate(names) if (found := POINT.fullmatch(name))}
    if "u" in point and "v" in point:
        yield "pixels", [point["u"], point["v"]]
    elif len(axis) == 3 and not has_quaternion:
        yield "axis", [axis[each] for each in "xyz"]
    elif "x" in point and "y" in point and "z" not in axis:
        yield "pixels", [point["x"], point["y"]]
