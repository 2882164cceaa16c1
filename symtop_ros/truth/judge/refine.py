"""The least squares of a kind of cause next to an offset."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real, find_rotation_vectors
from symtop_ros.truth.judge.causes import Cause
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.judge.fit import COLUMNS, PARAMETERS, ROUNDING, Fit


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
    influences = fit.find_influences(cause.offset, cause.columns, left)
    slopes = [_choose(PARAMETERS[name]) for name in cause.parameters]
    own = tuple(influences.find_deviation(each) for each in slopes)
    world, body = (influences.find_deviation(each) for each in _list_turns(cause.offset))
    return replace(found, deviations=own, turn_deviations=(world, body))


def _choose(place: int) -> Real:
    return np.asarray(np.eye(COLUMNS)[place])


def _list_turns(offset: Offset) -> Iterator[Real]:
    """Yield what changes the angle of each rotation: a turn about its own axis."""
    for q, places in ((offset.world, slice(0, 3)), (offset.body, slice(3, 6))):
        slope = np.zeros(COLUMNS)
        vector = find_rotation_vectors(q)
        size = float(np.linalg.norm(vector))
        # without an angle there is no axis; that of a heading is as good as any
        slope[places] = vector / size if size else [0.0, 0.0, 1.0]
        yield slope
