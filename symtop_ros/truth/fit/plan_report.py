"""The report of a plan: as a record for JSON, and as text, both from the same numbers."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from symtop_ros.base.counts import write_count
from symtop_ros.base.header import make_header
from symtop_ros.truth.fit.plan import LONGEST, PRECISE, Plan, Start
from symtop_ros.truth.fit.record import Known
from symtop_ros.truth.fit.report import (
    describe_unknown,
    describe_value,
    write_legend,
    write_row,
    write_unknown,
)
from symtop_ros.truth.fit.unknown import Unknown, list_unknown
from symtop_ros.truth.fit.values import SIZED, Value, convert, list_quantities, list_values
from symtop_ros.words import write

ALIKE = 1.05  # ratio of two deviations up to which they count as equal


@dataclass(frozen=True, eq=False)
class PlanReport:
    """The report of a plan.

    Attributes
    ----------
    source : str
        The scene with its changes.
    plan : Plan
    given : dict
        Known values, as for `values.convert`.
    """

    source: str
    plan: Plan
    given: dict[str, Known]

    @cached_property
    def values(self) -> list[Value]:
        """All numbers, also those that will not be known."""
        found = list_values(self.plan.fit)
        return [*found, *convert(found, self.given)]

    @cached_property
    def unknown(self) -> list[Unknown]:
        """Statements on what the record will not determine."""
        return list_unknown(self.plan.fit, self.values, self.given)

    @cached_property
    def rows(self) -> dict[str, int | None]:
        """Rows for a relative deviation of PRECISE, of numbers that no twin hides."""
        shown = {name for name, _ in list_quantities(self.plan.fit)}
        return {
            each.name: self.plan.count_rows(each.name)
            for each in self.values
            if each.name in shown.intersection(SIZED) and each.value and not self._is_hidden(each)
        }

    def _is_hidden(self, value: Value) -> bool:
        """Return True if a number is not known although its deviation is small enough."""
        return not value.is_known and value.deviation <= PRECISE * abs(value.value)

    def facts(self) -> dict[str, Any]:
        """Return all figures, for JSON."""
        record = self.plan.record
        return {
            **make_header("fit_plan", []),
            "source": self.source,
            "kind": record.kind.name,
            "rows": len(record),
            "seconds": record.seconds,
            "noise": self.plan.noise.tolist(),
            "values": {
                each.name: describe_value(each) | {"rows_for_1_percent": self.rows.get(each.name)}
                for each in self.values
                if each.is_known
            },
            "unknown": [describe_unknown(each) for each in self.unknown],
            "starts": [vars(each) for each in self.plan.starts],
            "notes": list(record.notes),
        }

    def format(self) -> str:
        """Return the report as text."""
        record = self.plan.record
        head = {
            "source": self.source,
            "name": record.kind.name,
            "rows": write_count(len(record), "row"),
            "seconds": record.seconds,
            "rate": 1 / record.step,
        }
        known = [each for each in self.values if each.is_known]
        lines = [write("plan", head), *write_legend(known), *map(self._write_row, known)]
        lines += [f"not known: {write_unknown(each)}" for each in self.unknown]
        lines += [self._write_late(each) for each in self.values if self._is_late(each)]
        notes = [f"note: {note}" for note in record.notes]
        return "\n".join([*lines, *map(self._write_start, self.plan.starts), *notes])

    def _write_row(self, value: Value) -> str:
        row = write_row(value)
        return f"{row}; {self._write_rows(value)}" if value.name in self.rows else row

    def _write_rows(self, value: Value) -> str:
        rows = self.rows[value.name]
        if rows is None:
            return write("plan.never", {"most": LONGEST})
        return write("plan.rows", {"count": write_count(rows, "row")})

    def _is_late(self, value: Value) -> bool:
        """Return True if a number that is not known will be, by more rows."""
        return not value.is_known and self.rows.get(value.name) is not None

    def _write_late(self, value: Value) -> str:
        return write("plan.late", {"name": value.name, "rows": self._write_rows(value)})

    def _write_start(self, start: Start) -> str:
        times = start.deviation / self.plan.best.deviation
        is_worse = times > ALIKE
        record = {
            "what": {**vars(start)},
            "deviation": start.deviation,
            "best": {} if start is self.plan.best else None,
            "times": {"times": times} if is_worse else None,
            "doubt": None if start.is_straight else {},
        }
        return write("plan.start", record)
