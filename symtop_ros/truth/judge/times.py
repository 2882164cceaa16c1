"""The times of a table, in the unit and epoch that were stated or in others that fit the run.

A unit and an epoch are causes as others are: each is tried, and taken if attitudes then follow the
motion up to constant rotations and a delay.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.alignment import SAMPLES, Alignment
from symtop_ros.truth.judge.attitude_table import AttitudeTable
from symtop_ros.truth.judge.grid import HOPELESS, Tables, fit_rotations
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates

DAY = 86_400 * NANOSECONDS  # ns
YEAR = 365.25 * DAY
# Parts of the unit that was stated, by what the times are then: seconds were stated, or ns.
PARTS = {1: "", 1000: "1e-3", 10**6: "1e-6", 10**9: "1e-9"}
FEWEST = 10  # estimates that show a unit
TRIED = ("", "delay")
MOVING = 4 * HOPELESS  # mean square of half angles between the attitudes and their mean


def read_times(table: AttitudeTable, truth: Truth, name: str, of_sensor: bool) -> Estimates:
    """Return the estimates of a table with the times that fit the run.

    Times that lie outside of the run are refused if no other unit and no shift to its start
    explains them.
    """
    stated = replace(table.read(), of_sensor=of_sensor)
    if len(table.times) < FEWEST:
        return stated
    late = min(table.times) - (truth.begin or 0)
    if abs(late) < DAY and _fits(stated, truth):
        return stated
    for found in _list_readings(table, truth):
        if _fits(candidate := replace(found, of_sensor=of_sensor), truth):
            return candidate
    if abs(late) >= DAY and truth.end is None:
        raise RefusedError(
            f"{name} must have times within the run: the first estimate is {_write_span(late)} the "
            "start of the scene, and no other unit or epoch explains it"
        )
    return stated


def _list_readings(table: AttitudeTable, truth: Truth) -> Iterator[Estimates]:
    """Yield the estimates in other units and epochs, with a note, that begin within a day.

    Times of the day of the run have no other epoch: estimates may begin later than it.
    """
    begin = truth.begin or 0
    first = min(table.times)
    is_far = abs(first - begin) >= DAY
    for part, text in PARTS.items():
        for shift in (0, begin - first // part) if is_far else (0,):
            if (part, shift) != (1, 0) and abs(first // part + shift - begin) < DAY:
                found = table.read(part, shift)
                yield replace(found, notes=(*found.notes, _describe(text, bool(shift))))


def _describe(part: str, is_shifted: bool) -> str:
    unit = f"the times are in {part} of the unit that was stated" if part else ""
    epoch = (
        "the times have another epoch: they are counted from the first one" if is_shifted else ""
    )
    return f"likely mistake: {' and '.join(filter(None, (unit, epoch)))}"


def _write_span(late: int) -> str:
    size = abs(late)
    where = "after" if late > 0 else "before"
    amount, unit = (size / YEAR, "years") if size > YEAR else (size / DAY, "days")
    return f"{amount:.0f} {unit} {where}"


def _fits(estimates: Estimates, truth: Truth) -> bool:
    """Return whether attitudes turn, and follow the motion up to rotations and a delay."""
    run = truth.select(estimates)
    if len(run) < max(FEWEST, len(estimates) // 2) or not np.ptp(run.stamps):
        return False
    some = run.thin(SAMPLES)
    # those that keep one attitude fit any instant
    if 1 - np.linalg.eigvalsh(some.orientations.T @ some.orientations)[-1] / len(some) < MOVING:
        return False
    tables = Tables(truth, Alignment(some, truth).fastest)
    costs = [fit_rotations(tables.tabulate(some, name)[1], "both")[0].min() for name in TRIED]
    return bool(min(costs) <= HOPELESS)
