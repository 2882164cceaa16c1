"""A deviation on which outliers have no influence."""

import numpy as np

from symtop_ros.base.arrays import Real

NORMAL = 1.4826  # deviation of a normal distribution, in median distances from the median


def find_spread(rows: Real) -> Real:
    """Return a deviation of each column, (m,), on which outliers have no influence."""
    middle = np.median(rows, axis=0)
    return np.asarray(NORMAL * np.median(np.abs(rows - middle), axis=0) + 1e-300)
