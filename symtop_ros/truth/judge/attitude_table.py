"""Attitudes from tables of text, in the unit of time that was stated or in parts of it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.tables.attitudes import turn_by_angles, turn_by_matrices
from symtop_ros.truth.tables.columns import (
    ANGLE_UNITS,
    DEGREE,
    NUMBERED,
    RATE_UNITS,
    TURNS,
    UNSAID,
    Head,
    find_matrix,
    find_quaternions,
    find_rates,
    find_turns,
)
from symtop_ros.truth.tables.reader import Report, read_table
from symtop_ros.truth.tables.table import Columns, Table
from symtop_ros.truth.tables.times import Times
from symtop_ros.truth.topics.estimates import MAX_STAMP, Estimates

QUATERNION, ROTATION = "quaternion", "matrix"  # else an order of `attitudes.ORDERS`
NUMBERED_NOTE = "the components q0 to q3 of the quaternion are read as w, x, y, z"
# Seconds since 1970 as a double are off by 1e-7 s, and have up to seven decimals.
EPOCH = 10**18  # ns
DIGITS = 9  # decimals of a time in whole ns


@dataclass(frozen=True, eq=False)
class AttitudeTable:
    """Rows of a table, with their times in ns if its unit is right; they may be beyond 64 bits."""

    times: tuple[int, ...]
    numbers: Real  # quaternions w, x, y, z, and angular velocities if there are any
    notes: tuple[str, ...]
    unreadable: int = 0  # rows that were left out as they have nan

    def read(self, part: int = 1, shift: int = 0) -> Estimates:
        """Return the estimates, with times divided by `part` and shifted by `shift` ns."""
        stamps = [min(max(each // part + shift, -MAX_STAMP), MAX_STAMP) for each in self.times]
        rates = self.numbers[:, 4:] if self.numbers.shape[1] > 4 else None
        found = Estimates.of(stamps, self.numbers[:, :4], rates, self.unreadable)
        return replace(found, notes=(*found.notes, *self.notes)).count_once()


@dataclass(frozen=True)
class WantedAttitudes:
    """A quaternion, roll, pitch and yaw in an order, or a matrix, and rates if there are any."""

    order: str | None

    def find(self, head: Head) -> Columns | None:
        """Return the columns of an attitude by their names."""
        rates = find_rates(head.names)
        factors = head.find_factors(rates, RATE_UNITS, "rad/s, deg/s or rpm")
        if groups := find_quaternions(head.names):
            if len(groups) > 1:
                found = [one_line(head.names[places["w"]]) for places in groups.values()]
                raise RefusedError(
                    f"{head.path} must have the columns of one quaternion, got "
                    f"{' and '.join(found)}"
                )
            (quaternion,) = groups.values()
            places = [quaternion[each] for each in "wxyz"]
            is_numbered = NUMBERED.fullmatch(head.names[places[0]])
            notes = (NUMBERED_NOTE,) if is_numbered else ()
            return Columns(QUATERNION, (*places, *rates), (*(1.0,) * 4, *factors), notes)
        if matrix := find_matrix(head.names):
            return Columns(ROTATION, (*matrix, *rates), (*(1.0,) * 9, *factors))
        turns = find_turns(head.names)
        return self._find_angles(head, turns, rates, factors) if turns else None

    def _find_angles(
        self, head: Head, turns: list[int], rates: list[int], factors: tuple[float, ...]
    ) -> Columns:
        if self.order is None:
            raise RefusedError(
                f"--rpy must be the order of roll, pitch and yaw in {head.path} "
                "(zyx: yaw first), got none"
            )
        (factor, *_) = head.find_factors(turns, ANGLE_UNITS, "rad or degrees")
        found, unit = TURNS.fullmatch(head.names[turns[0]]), head.units[turns[0]]
        said = (found[2] or "") if found and unit in UNSAID else unit
        angle = {DEGREE: "degrees", 1.0: "rad"}.get(ANGLE_UNITS.get(said, factor), "")
        return Columns(
            self.order,
            (*turns, *rates),
            (*(1.0,) * 3, *factors),
            unit="" if said in UNSAID else angle,
        )

    def describe(self, path: Path, first: str) -> str:
        """Return the refusal of a table without an attitude."""
        return (
            f"{path} must have the columns stamp (ns) or t (s), w, x, y, z, or be a file of TUM or "
            f"EuRoC; got the header {first}"
        )


def read_attitudes(
    path: Path, order: str | None = None, report: Report | None = None
) -> AttitudeTable:
    """Return the attitudes of a table.

    `order` is that of roll, pitch and yaw, by `attitudes.ORDERS`.
    """
    table = read_table(path, WantedAttitudes(order), report)
    numbers, assumed = _turn(table)
    notes = [*assumed, *table.notes, *_describe_times(table.times)]
    return AttitudeTable(table.times.stamps, numbers, tuple(notes), table.unreadable)


def _turn(table: Table) -> tuple[Real, list[str]]:
    """Return rows with quaternions in front, and a note if a unit was assumed."""
    columns, rows = table.columns, table.values
    if columns.kind == QUATERNION:
        return rows, []
    if columns.kind == ROTATION:
        return np.concatenate([turn_by_matrices(rows[:, :9]), rows[:, 9:]], axis=1), []
    q, unit = turn_by_angles(rows[:, :3], columns.kind, columns.unit)
    note = [] if columns.unit else [f"roll, pitch and yaw have no unit: read as {unit}"]
    return np.concatenate([q, rows[:, 3:]], axis=1), note


def _describe_times(times: Times) -> Iterator[str]:
    """Name times that doubles have rounded."""
    latest = max(times.stamps, default=0)
    if times.unit == "s" and EPOCH < latest <= MAX_STAMP and times.decimals < DIGITS:
        off = np.spacing(latest / NANOSECONDS) / 2
        yield (
            f"t has {times.decimals} decimals, as doubles of epoch seconds have: it is off by up "
            f"to {max(off, times.step / 2):.1g} s. Write the column stamp, in ns"
        )
