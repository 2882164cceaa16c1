"""The least squares of a kind of cause next to an offset, with the weights of its noise.

Plain least squares are inexact for correlated errors, which may have little power at the frequency
of a derivative. So residuals are whitened by an autoregression, in the frame of the world or of the
body, whichever it describes better. The deviations of the whitened least squares come from the
sandwich estimator.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real, find_rotation_vectors
from symtop_ros.truth.judge.alignment import COLUMNS, PARAMETERS, ROUNDING, Alignment, move
from symtop_ros.truth.judge.causes import Cause
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.residuals.influence import Influences, find_influences
from symtop_ros.truth.residuals.residuals import CHANCE, Residuals
from symtop_ros.truth.residuals.whitening import find_noise

RESOLUTION = 1e-9 / math.sqrt(12)  # s: the standard deviation of a time in whole ns
ROUNDS = 3  # of noise and least squares: the noise hardly depends on the offset


def refine(
    fit: Alignment, kind: tuple[str, str, tuple[str, ...]], offset: Offset, *, is_sure: bool
) -> Cause:
    """Return the least squares of a kind of cause near an offset; `is_sure`: with deviations."""
    cause = Cause(*kind, offset, np.inf)
    best = fit.refine(offset, cause.columns)
    found = replace(cause, offset=best, cost=fit.cost(best))
    return make_sure(fit, found) if is_sure else found


def make_sure(fit: Alignment, cause: Cause) -> Cause:
    """Return a cause with its standard deviations, or with the reason why it lacks them."""
    if cause.cost <= ROUNDING:
        return replace(cause, independent=float(len(fit.some)))
    left = fit.find_remainder(cause.offset)
    found = replace(
        cause,
        rms=left.rms,
        independent=left.independent,
        correlation_time=left.correlation_time,
        fault=left.find_fault(cause.count),
    )
    if not found.count:
        return found
    return see(fit, found) if found.fault else weigh(fit, found, left)


def see(fit: Alignment, cause: Cause) -> Cause:
    """Return a cause with the changes of its numbers that have an effect as large as the residual.

    These are no deviations: correlated errors may hide larger changes.
    """
    columns = fit.derive_vectors(cause.offset, cause.columns)
    sizes = np.sqrt((columns**2).sum(axis=1).mean(axis=0)) + np.finfo(float).tiny
    seen = dict(zip(cause.columns, (cause.residual / sizes).tolist(), strict=True))
    own = tuple(seen[PARAMETERS[name]] for name in cause.parameters)
    return replace(cause, seen=own, turn_seen=cause.residual)


def weigh(fit: Alignment, cause: Cause, left: Residuals) -> Cause:
    """Return a cause as the least squares of whitened errors, with their deviations.

    Errors that are no noise may pull it far away: then it stays where it is.
    """
    most = cause.cost * (1 + CHANCE / left.numbers)
    moved = cause.offset
    for _ in range(ROUNDS):
        values = find_white_influences(fit, moved, cause.columns)
        moved = move(moved, values.sum(axis=0))
    if fit.cost(moved) <= most:
        rms = fit.find_remainder(moved).rms
        cause = replace(cause, offset=moved, cost=fit.cost(moved), rms=rms)
    else:
        values = fit.find_influences(cause.offset, cause.columns)
    # The power of slow noise is as uncertain as so few estimates make it, also after whitening.
    influences = Influences(values, cause.count, left.independent)
    # All estimates may have one stamp, as those of a clock that stands still.
    least = {"delay": RESOLUTION, "clock": RESOLUTION / max(fit.seconds, 1e-9)}
    own = tuple(
        math.hypot(influences.find_deviation(np.eye(COLUMNS)[PARAMETERS[name]]), least.get(name, 0))
        for name in cause.parameters
    )
    turns = tuple(influences.find_deviation(each) for each in _list_turns(cause.offset))
    return replace(cause, deviations=own, turn_deviations=turns)


def find_white_influences(fit: Alignment, offset: Offset, free: list[int]) -> Real:
    """Return the changes (m, 11) by each estimate in the frame in which its noise is smaller."""
    follows = fit.find_follows(offset)
    frames = [
        (find_noise(left, follows, len(free)), columns, left)
        for columns, left in fit.derive_frames(offset, free)
    ]
    noise, columns, left = min(frames, key=lambda each: float(np.log(each[0].sigma).sum()))
    values = np.zeros((int(noise.kept.sum()), COLUMNS))
    values[:, free] = find_influences(noise.whiten(columns), noise.whiten(left))
    return values


def _list_turns(offset: Offset) -> Iterator[Real]:
    """Yield what changes the angle of each rotation: a turn about its own axis."""
    for q, places in ((offset.world, slice(0, 3)), (offset.body, slice(3, 6))):
        slope = np.zeros(COLUMNS)
        vector = find_rotation_vectors(q)
        size = float(np.linalg.norm(vector))
        # without an angle there is no axis; that of a heading is as good as any
        slope[places] = vector / size if size else [0.0, 0.0, 1.0]
        yield slope
