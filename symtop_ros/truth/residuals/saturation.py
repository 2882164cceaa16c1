"""Columns at the limit of their sensor: numbers that are all the same at one end of a column.

Beyond its range a sensor outputs the limit. Such a number is no measurement with noise, and a
motion that is fitted to it is wrong by the part that was cut away.
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Mask, Real

# A number at the end of a swing is there more often than others, by at most 2.4 if it is rounded:
# the last step of a sine has 1/(sqrt(2) - 1) times as many as the one before.
HEAP = 5.0
FEWEST = 12  # rows at a limit, and different numbers of a column that has one
# Limits of sensors; a sensor may end one count earlier, or at a count of a rounded factor.
RATES = np.radians([125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0])  # rad/s
FORCES = 9.80665 * np.array([2.0, 4.0, 8.0, 16.0, 32.0])  # m/s^2
NEAR = 1.5e-3  # of a limit
COUNT = 2.0**-14  # of a limit; two counts of 16 bits


@dataclass(frozen=True)
class Saturation:
    """A limit that a column reaches, and in how many rows."""

    column: int
    limit: float
    rows: int


def find_saturations(values: Real, ranges: Real) -> tuple[Saturation, ...]:
    """Return the limits that columns (n, m) reach.

    `ranges` (k,) are limits of sensors in the unit of the columns: a column that has one of them in
    each row is at its limit, while any other constant may come from a steady motion.
    """
    return tuple(
        Saturation(column, limit, int((numbers == limit).sum()))
        for column, numbers in enumerate(values.T)
        for limit in _list_limits(numbers, ranges)
    )


def find_saturated(values: Real, found: tuple[Saturation, ...]) -> Mask:
    """Return True (n, m) for numbers of a sensor that are at a limit of any of its columns.

    All axes of a sensor have the same range, in both directions up to one count. So if one column
    has a heap at a limit, the numbers of another column at this limit are saturated, too, even if
    they are few.
    """
    ends = np.array([abs(each.limit) for each in found])
    sizes = np.abs(values)[..., np.newaxis]
    return np.asarray((np.abs(sizes - ends) <= COUNT * ends).any(axis=-1))


def _list_limits(numbers: Real, ranges: Real) -> list[float]:
    """Return the limits of a column: its ends, if they are away from zero and heaped."""
    levels, counts = np.unique(numbers, return_counts=True)
    ends = [end for end, sign in ((0, -1), (-1, 1)) if sign * levels[end] > 0]
    if len(levels) < FEWEST:
        ends = [end for end in ends if np.abs(abs(levels[end]) / ranges - 1).min() < NEAR]
        usual = 0
    else:
        usual = int(counts[1:-1].max())
    return [float(levels[end]) for end in ends if counts[end] >= FEWEST + HEAP * usual]
