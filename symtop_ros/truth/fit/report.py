"""The report of a fit: as a record for JSON, and as text, both from the same numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.base.counts import write_count
from symtop_ros.base.header import make_header
from symtop_ros.base.measured import format_measured, write_measured
from symtop_ros.truth.fit.check import FAILS, HOLDS, UNCLEAR, Check
from symtop_ros.truth.fit.record import Known
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.fit.rivals import Rival, find_calm, find_rivals
from symtop_ros.truth.fit.unknown import Unknown, list_unknown
from symtop_ros.truth.fit.values import Value, convert, list_values
from symtop_ros.truth.residuals.lines import Line
from symtop_ros.words import write
from symtop_ros.words.templates import TEMPLATES

LABELS = {
    "spin": "spin (omega_z)",
    "theta_dot": "theta'",
    "phi_dot": "phi'",
    "mean_precession_rate": "mean precession",
    "nutation_period": "nutation period",
    "spin_half_time": "spin is half after",
    "kick_time": "kick after",
    "kick": "change of the rates",
}
SLIGHT = 0.1  # of the deviation by the noise: less is not written
# part of the square of a systematic deviation that may come from causes that are not named
REST = 0.1
ANGLES = "theta", "phi", "theta_dot", "phi_dot"


@dataclass(frozen=True, eq=False)
class Report:
    """The report of a fit.

    Attributes
    ----------
    source : str
        Name of the record.
    rows : int
        Rows of the file, of which the fit may have taken a part.
    fit : Fit
    given : dict
        Known values, as for `values.convert`.
    rivals : sequence of Rival
        Models that explain the record better than one free motion does, the clearest first; `fit`
        is the fit of the first one.
    """

    source: str
    rows: int
    fit: Fit
    given: dict[str, Known]
    rivals: Sequence[Rival] = ()

    @classmethod
    def compare(cls, source: str, rows: int, fit: Fit, given: dict[str, Known]) -> "Report":
        """Return the report of one free motion, or of a model that explains the record better."""
        rivals = find_rivals(fit, Check(fit))
        calm = find_calm(fit, rivals)
        if calm is not fit:
            fit, rivals = calm, find_rivals(calm, Check(calm))
        best = next((each for each in rivals if each.explains), None)
        best = best or next((each for each in rivals if each.loses_spin), None)
        if best is None:
            return cls(source, rows, fit, given)
        others = [each for each in rivals if each is not best]
        return cls(source, rows, best.fit, given, [best, *others])

    @property
    def verdict(self) -> str:
        """HOLDS, UNCLEAR or FAILS; the model is one free motion."""
        return FAILS if self.rivals else self.check.verdict

    @cached_property
    def values(self) -> list[Value]:
        """All numbers, also those that are not known."""
        found = list_values(self.fit)
        return [*found, *convert(found, self.given)]

    @cached_property
    def check(self) -> Check:
        """The test of the model."""
        return Check(self.fit)

    @cached_property
    def unknown(self) -> list[Unknown]:
        """Statements on what the record does not determine."""
        return list_unknown(self.fit, self.values, self.given)

    def facts(self) -> dict[str, Any]:
        """Return all figures, for JSON."""
        record = self.fit.model.record
        known = {each.name: describe_value(each) for each in self.values if each.is_known}
        return {
            **make_header("fit", [Path(self.source)]),
            "source": self.source,
            "kind": record.kind.name,
            "rows": self.rows,
            "taken": len(record),
            "seconds": record.seconds,
            "values": known,
            "unknown": [describe_unknown(each) for each in self.unknown],
            "model": self._describe_model(),
            "notes": list(record.notes),
        }

    def _describe_model(self) -> dict[str, Any]:
        check, noise, columns = self.check, self.fit.noise, self.fit.model.kind.columns
        return {
            "verdict": self.verdict,
            "rivals": [
                {
                    "kind": each.kind,
                    "gain": each.gain,
                    "needed": each.needed,
                    "explains": each.explains,
                }
                for each in self.rivals
            ],
            "text": self.write_verdict(),
            "residuals_are_white": check.is_white,
            "residual_rms": np.sqrt((self.fit.residuals[noise.kept] ** 2).mean(axis=0)).tolist(),
            "outliers": noise.outliers,
            "stretch": check.stretch,
            "still": [columns[column] for column in check.still],
            "noise_order": len(noise.partial),
            "is_flicker": noise.is_flicker,
            "is_lone": self.fit.is_lone,
            "independent_rows": self.fit.remainder.independent,
            "no_deviations_as": check.fault or None,
            "changed": [vars(each) for each in check.changes],
            "lines": [{**vars(each), "column": self._name(each)} for each in check.lines],
        }

    def format(self) -> str:
        """Return the report as text."""
        record = self.fit.model.record
        head = (
            f"{self.source}: {record.kind.name}, {write_count(self.rows, 'row')} in "
            f"{record.seconds:.4g} s"
        )
        known = [each for each in self.values if each.is_known]
        lines = [head, *write_legend(known), *map(write_row, known)]
        lines.append(self.write_verdict())
        lines += [f"not known: {write_unknown(each)}" for each in self.unknown]
        return "\n".join([*lines, *(f"note: {note}" for note in record.notes)])

    def _name(self, line: Line) -> str:
        """Return the name of the column of the residuals that has a line."""
        return self.fit.model.kind.residuals[line.column]

    def _describe_line(self, line: Line) -> dict[str, Any]:
        at = {"kind": line.name} if line.name else None
        return {**vars(line), "column": self._name(line), "at": at, "percent": 100 * line.share}

    @property
    def _lacks_friction(self) -> bool:
        is_wrong = bool(self.check.changes) or self.check.is_smooth
        return is_wrong and not self.rivals and not self.fit.model.record.has_friction

    def _describe_rivals(self) -> dict[str, Any]:
        """Return the fields of the sentence on what explains the record better; or none."""
        if not self.rivals:
            return {}
        first, *others = self.rivals
        kind = first.kind if first.explains else "other_loss"
        fields = {"gain": first.gain, "needed": first.needed}
        other = {"kind": others[0].kind, "gain": others[0].gain} if others else None
        return {"verdict": kind, **fields, "other": other}

    def write_verdict(self) -> str:
        """Return whether the model holds, in a sentence."""
        noise, order = self.fit.noise, len(self.fit.noise.partial)
        verdict, kind = self.check.verdict, self.fit.model.kind
        if verdict == UNCLEAR and self.check.is_noise:
            verdict = "lone"
        elif verdict == HOLDS and self.check.lines:
            verdict = "lined"
        record = {
            "verdict": verdict,
            **self._describe_rivals(),
            "undamped": {} if self._lacks_friction else None,
            "outliers": {"count": write_count(noise.outliers, "row")} if noise.outliers else None,
            "lasting": {"order": order} if order and not noise.is_flicker else None,
            "flicker": {} if noise.is_flicker else None,
            "stretch": {"count": str(self.check.stretch)} if self.check.stretch else None,
            "still": [{"name": kind.columns[column]} for column in self.check.still] or None,
            "lines": [self._describe_line(each) for each in self.check.lines] or None,
            "changes": [vars(each) for each in self.check.changes] or None,
            "fault": {"kind": self.check.fault} if self.check.fault else None,
        }
        return write("model", record)


def describe_value(value: Value) -> dict[str, Any]:
    """Return a number for JSON."""
    return {
        "value": value.value,
        "deviation": value.deviation,
        "systematic": {part.cause: part.shift for part in value.parts},
        "total": value.total,
        "unit": value.unit,
    }


def write_row(value: Value) -> str:
    """Return a number with its deviation and its unit, as a row of a text."""
    measured = format_measured(value.value, value.deviation, 12)
    label = LABELS.get(value.name, value.name)
    when = " (first row)" if value.name in ANGLES else ""
    return f"  {label:20}{measured}{write_systematic(value)} {value.unit}{when}".rstrip()


def write_legend(values: Sequence[Value]) -> list[str]:
    """Return a line that explains the numbers after +-, if any number has a second deviation."""
    return [write("legend", {})] if any(map(write_systematic, values)) else []


def write_systematic(value: Value) -> str:
    """Return the systematic deviation with its causes; empty if the noise is far larger.

    The causes are the largest, as many as make up nearly all of it.
    """
    if value.systematic < SLIGHT * value.deviation:
        return ""
    causes, left = [], value.systematic**2
    for part in sorted(value.parts, key=lambda part: -abs(part.shift)):
        if left > REST * value.systematic**2:
            causes.append(part.cause)
        left -= part.shift**2
    deviation = write_measured(value.value, value.systematic)[1]
    return write("systematic", {"deviation": deviation, "causes": causes})


def write_unknown(unknown: Unknown) -> str:
    """Return a sentence on what a record does not determine, and why."""
    record: dict[str, Any] = {f"n{k}": number for k, number in enumerate(unknown.numbers)}
    if unknown.kind in {"weak", "together", "cut"}:  # the last two are a value with its deviation
        value, deviation = unknown.numbers[-2:]
        record["value"] = format_measured(value, deviation)
    if unknown.kind == "together":
        record["factor"] = format_measured(unknown.numbers[0], unknown.numbers[1])
    text = write(f"unknown.{unknown.kind}", {**record, "names": unknown.names})
    remedy = f"remedy.{unknown.kind}"  # an option of the program, where the page has its own
    return text + (write(remedy, {}) if remedy in TEMPLATES else "")


def describe_unknown(unknown: Unknown) -> dict[str, Any]:
    """Return a statement for JSON."""
    return {
        "kind": unknown.kind,
        "names": unknown.names.replace(" and ", ", ").split(", "),
        "numbers": list(unknown.numbers),
        "text": write_unknown(unknown),
    }
