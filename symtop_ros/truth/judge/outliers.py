"""Outliers among estimates, and fits without them."""

from collections.abc import Callable

import numpy as np

from symtop_ros.base.arrays import Mask, Real
from symtop_ros.truth.judge.alignment import Alignment
from symtop_ros.truth.judge.causes import CHANGES, Cause
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.spread import NORMAL
from symtop_ros.truth.topics.estimates import Estimates

FAR = 5.0  # deviations of a component; a normal number is farther once in two million
ROUNDS = 6  # of causes and outliers
FEWEST = 0.5  # part of the estimates that is kept, at least


def find_outliers(fit: Alignment, cause: Cause) -> Mask:
    """Return True (n,) for estimates with a residual that is large for the spread of the others.

    The residual must be large in both frames. Noise about an axis of one frame has an oscillating
    component in the other frame, and exceeds a multiple of its median there more often than normal
    numbers do.
    """
    _, known = fit.exact(cause.offset)
    found = np.zeros(len(fit.some), dtype=bool)
    least = float(np.sqrt(fit.rounding))
    frames = fit.find_remainder(cause.offset).frames
    found[known] = np.all([_find_far(each, least) for each in frames], axis=0)
    return found


def _find_far(left: Real, least: float) -> Mask:
    """Return True (n,) for rows of which a component is far off."""
    spread = np.maximum(NORMAL * np.median(np.abs(left), axis=0), least)
    return np.asarray((np.abs(left) > FAR * spread).any(axis=1))


def trim(run: Estimates, truth: Truth, find: Callable[[Estimates], Cause]) -> Estimates:
    """Return the estimates without outliers; the cause is fitted to the others."""
    kept = np.ones(len(run), dtype=bool)
    for _ in range(ROUNDS):
        cause = find(run.select(kept))
        fit = Alignment(CHANGES[cause.change][2](run), truth)
        before, kept = kept, ~find_outliers(fit, cause)
        if (kept == before).all() or kept.mean() < FEWEST:
            break
    return run.select(kept)


def count_outliers(run: Estimates, truth: Truth, cause: Cause) -> int:
    """Return the number of outliers of a cause."""
    return int(find_outliers(Alignment(CHANGES[cause.change][2](run), truth), cause).sum())
