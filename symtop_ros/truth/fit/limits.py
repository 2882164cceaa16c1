"""Rows in which a sensor is at its limit: they are left out."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.ndimage import binary_dilation

from symtop_ros.base.arrays import Mask, Real
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.aliases import RATES
from symtop_ros.truth.fit.check import Check
from symtop_ros.truth.fit.files import Rows
from symtop_ros.truth.fit.fitting import fit_motion
from symtop_ros.truth.fit.kinds import ACROSS, KINDS
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.residuals import saturation
from symtop_ros.truth.residuals.saturation import Saturation, find_saturated, find_saturations

MOST = 0.5  # of the rows that may be left out
SPIN = 2  # column of the rate about the axis
# If a spin is close to a limit, positive noise puts a row at the limit, and the remaining rows have
# negative noise. So this many rows before and after a row at the limit are left out, too.
BESIDE = 8


def leave_out_saturated(rows: Rows) -> Rows:
    """Return the rows within the range of the sensor, with a note on those left out.

    The rate about the axis is left out if it is beyond the range in most rows.

    Raises
    ------
    RefusedError
        If more than half of the rows are at another limit.
    """
    if rows.kind not in RATES or not len(rows.values):
        return rows
    rates = find_saturations(rows.values[:, :3], saturation.RATES)
    forces = find_saturations(rows.values[:, 3:], saturation.FORCES)
    found = (*rates, *(replace(each, column=each.column + 3) for each in forces))
    if not found:
        return rows
    both = (rows.values[:, :3], rates), (rows.values[:, 3:], forces)
    bad = np.concatenate([find_saturated(*each) for each in both], axis=1)
    at_limit = int(bad.any(axis=1).sum())
    bad[:, SPIN] = binary_dilation(bad[:, SPIN], iterations=BESIDE)
    if rows.kind == "rates" and bad[:, SPIN].mean() > MOST:
        rows = _leave_out_spin(rows, _describe_spin(rows.values[bad[:, SPIN], SPIN]))
        found, bad = tuple(each for each in found if each.column != SPIN), bad[:, :SPIN]
    parts = ", ".join(_describe(each, rows) for each in found)
    is_bad = np.asarray(bad.any(axis=1))
    beside = ", or next to it" if is_bad.sum() > at_limit else ""
    why = f"at the limit of the sensor{beside}: left out ({parts})"
    return _leave_out(rows, is_bad, why, parts)


def _leave_out(rows: Rows, bad: Mask, why: str, parts: str) -> Rows:
    """Return the rows that are not bad, with a note that says why."""
    if bad.mean() > MOST:
        raise RefusedError(f"a record must be within the range of its sensor, got {parts}")
    if not bad.any():
        return rows
    note = f"{write_count(int(bad.sum()), 'row', 'are')} {why}"
    times, values = rows.times[~bad], rows.values[~bad]
    return replace(rows, times=times, values=values, notes=(*rows.notes, note))


def _leave_out_spin(rows: Rows, note: str) -> Rows:
    """Return the rates across the axis."""
    steps = None if rows.steps is None else rows.steps[:SPIN]
    return Rows(ACROSS.name, rows.times, rows.values[:, :SPIN], (*rows.notes, note), steps)


def fit_record(record: Record, report: Callable[[float], None]) -> Fit:
    """Return the motion that explains a record.

    Only the rates across the axis are fitted if the rate about the axis never changes although the
    other rates have noise: the sensor is then at an unusual limit. With a mount the model stays in
    doubt, because a tilt adds a part of the spin to the other rates.
    """
    fit = fit_motion(record, report)
    if record.kind.name != "rates" or record.has_mount or SPIN not in Check(fit).still:
        return fit
    notes = *record.notes, _describe_spin(record.values[:, SPIN])
    values = record.values[:, :SPIN]
    steps = None if record.steps is None else record.steps[:SPIN]
    return fit_motion(replace(record, kind=ACROSS, values=values, notes=notes, steps=steps), report)


def _describe_spin(values: Real) -> str:
    """Return the note on rates (n,) about the axis that are at the limit of the sensor."""
    limit = float(np.median(values))
    at = f"wz at {limit:.5g} rad/s ({np.degrees(limit):.5g} deg/s)"
    return f"{at}, the limit of the sensor: the spin is beyond it, and wz is left out"


def _describe(found: Saturation, rows: Rows) -> str:
    name, unit = KINDS[rows.kind].columns[found.column], "rad/s" if found.column < 3 else "m/s^2"
    share = found.rows / len(rows.values)
    limit = f"{found.limit:.5g} {unit}"
    degrees = f" ({np.degrees(found.limit):.5g} deg/s)" if found.column < 3 else ""
    return f"{name} at {limit}{degrees} in {share:.0%} of the rows"
