"""The number of first rows of a record that one motion explains, up to a possible kick.

The first part is made longer until its motion no longer explains the rows that are added.
"""

import numpy as np

from symtop_ros.truth.fit.record import FEWEST, Record
from symtop_ros.truth.fit.refine import Fit, refine
from symtop_ros.truth.fit.search import EFFORTS, Candidate, search
from symtop_ros.truth.fit.sides import expand

SHORTEST = 3 * FEWEST  # rows that show a motion
JUMPS = 3.0  # deviations of the first rows that a motion does not explain
ROWS = 4  # rows that the motion must not explain
# largest ratio of the deviation of a row to the deviation of what the rows before do not predict
CALM = 1.4


def find_best(record: Record) -> Candidate:
    """Return the best motion of a quick search."""
    return expand(search(record.plain, EFFORTS[0]), record)[0]


def explains(fit: Fit) -> bool:
    """Return whether the residuals of a motion are hardly larger than their whitened noise.

    In a few rows of white noise an autoregression may seem likely by chance, but it then explains
    little.
    """
    whole = fit.noise.predictors[1][0]  # deviations of a row without others before it
    return fit.remainder.is_white and float(whole.max()) < CALM


def find_reach(record: Record) -> int | None:
    """Return the number of first rows that one motion explains; None for none or all."""
    count = min(max(len(record) // 8, SHORTEST), len(record))
    part = record.select(slice(count))
    found = find_best(part)
    fit = refine(found.model.move(part), found.x)
    if not explains(fit):
        return None
    while count < len(record):
        more = min(count + max(count // 4, ROWS), len(record))
        longer = _extend(fit, record, more)
        if leaves(longer, fit, count):
            return _find_end(fit, record, count, more)
        fit, count = longer, more
    return None


def _extend(fit: Fit, record: Record, count: int) -> Fit:
    return refine(fit.model.move(record.select(slice(count))), fit.x)


def leaves(longer: Fit, fit: Fit, count: int) -> bool:
    """Return whether a motion fails to explain the rows that were added."""
    size = float(np.sqrt((longer.residuals / fit.noise.sigma) ** 2).mean())
    return size > 1.3 or not longer.remainder.is_white


def _find_end(fit: Fit, record: Record, low: int, high: int) -> int:
    """Return the first row that the motion of the rows before does not explain."""
    model = fit.model.move(record.select(slice(high)))
    left = np.abs(model.find_residuals(fit.x) / fit.noise.sigma).max(axis=1)
    far = left[low:] > JUMPS + 2
    after = np.convolve(far, np.ones(ROWS, dtype=int))[: len(far)] >= ROWS - 1
    return low + max(int(np.argmax(after)) - ROWS + 2, 0) if after.any() else high
