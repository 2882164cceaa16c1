"""Estimates from CSV files, and what is odd about such a file."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Decimal, InvalidOperation
from pathlib import Path

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.estimates import MAX_STAMP, Estimates
from symtop_ros.simulation.validation import RefusedError, one_line
from symtop_ros.wire.layout import NANOSECONDS

CSV = ".csv"
COLUMNS, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
# Seconds since 1970 as a double are off by 1e-7 s, and have up to seven decimals.
EPOCH, DIGITS = 10**18, 9  # ns; decimals of a time in whole ns


def read_csv(path: Path) -> Estimates:
    """Return the estimates of a CSV file."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return _read_rows(path, csv.DictReader(file, skipinitialspace=True))
    except OSError as error:
        raise RefusedError(f"cannot open {path}: {error.strerror}") from None
    except (csv.Error, UnicodeDecodeError, ValueError) as error:
        if isinstance(error, RefusedError):
            raise
        raise RefusedError(f"cannot read {path}: not a CSV file ({one_line(error)})") from None


def _read_rows(path: Path, rows: csv.DictReader[str]) -> Estimates:
    names = [name.strip() for name in rows.fieldnames or ()]
    rows.fieldnames = names
    time = "stamp" if "stamp" in names else "t"
    missing = [name for name in (time, *COLUMNS) if name not in names]
    if missing:
        raise RefusedError(
            f"{path} must have the columns stamp (ns) or t (s), w, x, y, z; got no {missing[0]}"
        )
    to_ns: Callable[[str], int] = int if time == "stamp" else _to_nanoseconds
    wanted = [*COLUMNS, *(RATES if set(RATES) <= set(names) else ())]
    stamps, numbers, decimals = [], [], 0
    for line, row in enumerate(rows, start=2):
        try:
            stamps.append(min(max(to_ns(row[time]), -MAX_STAMP), MAX_STAMP))
            numbers.append([float(row[name]) for name in wanted])
            decimals = max(decimals, len(row[time].strip().partition(".")[2]))
        except (TypeError, ValueError, InvalidOperation, OverflowError):
            raise RefusedError(
                f"line {line} of {path} must consist of numbers, got {one_line(dict(row))}"
            ) from None
    table = np.array(numbers, dtype=float).reshape(-1, len(wanted))
    notes = _describe_rows(table) + _describe_times(stamps, time == "t", decimals)
    found = Estimates.of(stamps, table[:, :4], table[:, 4:] if len(wanted) > 4 else None)
    return replace(found, notes=notes)


def _describe_rows(table: Real) -> tuple[str, ...]:
    """Name the first row that is not finite."""
    bad = np.flatnonzero(~np.isfinite(table).all(axis=1)) + 2
    return tuple(
        f"{len(bad)} rows have nan or infinity, the first in line {line}" for line in bad[:1]
    )


def _describe_times(stamps: Sequence[int], seconds: bool, decimals: int) -> tuple[str, ...]:
    """Name times that repeat, and times that doubles have rounded."""
    notes = []
    times, counts = np.unique(np.asarray(stamps, dtype=np.int64), return_counts=True)
    if repeated := int(counts.sum() - len(counts)):
        first = times[counts.argmax()] / NANOSECONDS
        notes.append(f"{repeated} rows repeat a time, among them {first:.9g} s")
    if seconds and len(times) and times[-1] > EPOCH and decimals < DIGITS:
        off = np.spacing(times[-1] / NANOSECONDS) / 2
        notes.append(
            f"t has {decimals} decimals, as doubles of epoch seconds have: it is off by up to "
            f"{max(off, 0.5 * 10.0**-decimals):.1g} s. Write the column stamp, in ns"
        )
    return tuple(notes)


def _to_nanoseconds(text: str) -> int:
    """Return a time in s as ns, without the rounding of a double."""
    return int((Decimal(text) * NANOSECONDS).to_integral_value())
