"""The least squares of a kind of cause next to an offset."""

from dataclasses import replace

import numpy as np

from symtop_ros.truth.judge.causes import LEVELS, Cause
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.judge.fit import PARAMETERS, ROUNDING, Fit


def refine(
    fit: Fit, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, is_sure: bool
) -> Cause:
    """Return the least squares of a kind of cause near an offset; `is_sure`: with deviations."""
    cause = Cause(*kind, offset, np.inf)
    best = fit.refine(offset, cause.columns)
    found = replace(cause, offset=best, cost=fit.cost(best))
    return add_deviations(fit, found) if is_sure else found


def add_deviations(fit: Fit, cause: Cause) -> Cause:
    """Return a cause with its standard deviations, or with the reason why it lacks them."""
    if cause.cost <= ROUNDING:
        return replace(cause, independent=float(len(fit.some)))
    left = fit.find_remainder(cause.offset)
    found = replace(
        cause,
        independent=left.independent,
        correlation_time=left.correlation_time,
        fault=left.find_fault(cause.count),
    )
    if found.fault or not found.count:
        return found
    sure = fit.find_deviations(cause.offset, cause.columns, left)
    own = tuple(float(sure[PARAMETERS[name]]) for name in cause.parameters)
    turn = float(np.linalg.norm(sure[list(LEVELS[cause.level][0])]))
    return replace(found, deviations=own, turn_deviation=turn)
