"""Rows of a sensor at its limit, which are no measurements."""

from dataclasses import replace

import numpy as np

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.aliases import RATES
from symtop_ros.truth.fit.files import Rows
from symtop_ros.truth.fit.kinds import KINDS
from symtop_ros.truth.residuals import saturation
from symtop_ros.truth.residuals.saturation import Saturation, find_saturated, find_saturations

MOST = 0.5  # of the rows that may be left out


def leave_out_saturated(rows: Rows) -> Rows:
    """Return the rows within the range of the sensor, with a note on those that are not.

    Raises
    ------
    RefusedError
        If more than half of the rows are at a limit.
    """
    if rows.kind not in RATES or not len(rows.values):
        return rows
    rates = find_saturations(rows.values[:, :3], saturation.RATES)
    forces = find_saturations(rows.values[:, 3:], saturation.FORCES)
    found = (*rates, *(replace(each, column=each.column + 3) for each in forces))
    if not found:
        return rows
    good = ~find_saturated(rows.values, found).any(axis=1)
    parts = ", ".join(_describe(each, rows) for each in found)
    if good.mean() < 1 - MOST:
        raise RefusedError(f"a record must be within the range of its sensor, got {parts}")
    left_out = write_count(int((~good).sum()), "row", "are")
    note = f"{left_out} at the limit of the sensor: left out ({parts})"
    return replace(
        rows, times=rows.times[good], values=rows.values[good], notes=(*rows.notes, note)
    )


def _describe(found: Saturation, rows: Rows) -> str:
    name, unit = KINDS[rows.kind].columns[found.column], "rad/s" if found.column < 3 else "m/s^2"
    share = found.rows / len(rows.values)
    limit = f"{found.limit:.5g} {unit}"
    degrees = f" ({np.degrees(found.limit):.5g} deg/s)" if found.column < 3 else ""
    return f"{name} at {limit}{degrees} in {share:.0%} of the rows"
