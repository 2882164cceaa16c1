"""The steps to which numbers are rounded, as they are seen or as they were written."""

import numpy as np

from symtop_ros.base.arrays import Real

MULTIPLES = 6  # the smallest difference of rounded values is a step, or 2 or 3, and seldom more
MANY = 1e12  # units; such differences of doubles are whole numbers by their own rounding
EVEN = 0.1  # of a unit; what decimals, or a change of units, leave of whole numbers


def find_steps(values: Real, written: Real | None = None) -> Real:
    """Return the steps (m,) to which columns (n, m) are rounded; 0 if no rounding is seen.

    Parameters
    ----------
    values : ndarray (n, m)
    written : ndarray (m,), optional
        Steps of the last decimals of the text. The larger one holds: a sensor's counts may be
        written with many decimals.

    A column that does not change shows no step, so it gets the smallest step of the others. If
    these have none, it gets the step of the text or, without a text, that of the last decimal.
    """
    steps = np.array([find_step(column) for column in values.T])
    still = np.ptp(values, axis=0) == 0
    if (steps[~still] > 0).all() and not still.all():
        steps[still] = steps[~still].min()
    elif written is not None:
        steps[still] = 0.0
    return steps if written is None else np.maximum(steps, written)


def find_step(values: Real) -> float:
    """Return the step of which all values (n,) are multiples, up to a constant; 0 if none."""
    differences = np.diff(np.unique(values))
    if not len(differences):
        return find_decimal(values[0])
    unit = differences.min() / MULTIPLES
    counts = differences / unit
    if counts.max() > MANY or np.abs(counts - np.round(counts)).max() > EVEN:
        return 0.0
    return float(np.gcd.reduce(np.round(counts).astype(np.int64)) * unit)


def find_decimal(value: float) -> float:
    """Return the step of the last decimal of a number that was written with up to nine digits."""
    digits = f"{value:.9g}".partition("e")[0]
    exponent = int(f"{value:.9e}".partition("e")[2])
    return float(10.0 ** (exponent + 1 - len(digits.replace(".", "").strip("-0") or "0")))
