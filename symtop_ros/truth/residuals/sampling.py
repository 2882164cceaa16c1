"""Rows of a record that occur twice, and times that are rounded or cut."""

from collections.abc import Iterator

import numpy as np

from symtop_ros.base.arrays import Mask, Real, Stamps
from symtop_ros.base.counts import write_count

NANOSECONDS = 1_000_000_000
FEWEST = 10  # steps that show it
FINEST = 10_000  # ns; times that are rounded more finely are as good as exact
# least number of steps of rounding in a step of time; if there are fewer, rows may be missing
WITHIN = 3


def find_repeats(times: Real | Stamps, values: Real) -> Mask:
    """Return True (n,) for rows that repeat the time and the values (n, m) of an earlier row.

    Two bags that were merged have the messages of both; a row that counts twice makes deviations
    too small by the square root of two.
    """
    again = np.zeros(len(times), dtype=bool)
    if not len(times) or (np.diff(times) > 0).all():
        return again
    order = np.argsort(times, kind="stable")
    same = np.diff(times[order]) == 0
    rows = order[np.append(same, False) | np.append(False, same)]  # those that share their time
    _, numbers = np.unique(times[rows], return_inverse=True)
    keys = np.column_stack([numbers.ravel(), values[rows]])
    _, firsts = np.unique(keys, axis=0, return_index=True)
    again[rows] = True
    again[rows[firsts]] = False
    return again


def describe_repeats(times: Real) -> Iterator[str]:
    """Yield a note on rows that occur twice, at times (n,) in s, if there are any."""
    if len(times):
        rows = write_count(len(times), "row", "is" if len(times) == 1 else "are")
        yield f"{rows} there a second time, the first at {times[0]:.9g} s: counted once"


def find_time_step(stamps: Stamps) -> float:
    """Return the step in s to which stamps (n,) in ns are rounded or cut; 0 if none is seen.

    Times that are rounded to ms are whole ms, and are not evenly spaced: at 120 Hz rows are 8 or
    9 ms apart. In times without some rows each step is a multiple of one step.
    """
    steps = np.diff(np.unique(stamps))
    if len(steps) < FEWEST or not np.ptp(steps):
        return 0.0
    step = int(np.gcd.reduce(steps))
    # if no step of time is one step of rounding, missing rows do not explain the steps
    is_coarse = step >= FINEST and (np.median(steps) >= WITHIN * step or steps.min() > step)
    return step / NANOSECONDS if is_coarse else 0.0


def describe_time_step(step: float) -> Iterator[str]:
    """Yield a note if times are rounded."""
    if step:
        size, half = f"{1e3 * step:g} ms", f"{1e3 * step / 2:g} ms"
        yield (
            f"times are rounded or cut to {size}: each is off by up to {half}, and if they are cut "
            f"all are early by {half}"
        )
