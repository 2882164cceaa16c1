"""Stamps that are rounded or cut, for example to ms, recognised from errors of the attitude.

Each time may be wrong by a step. An error of a stamp causes an error of the attitude along the
angular velocity only; the error across it remains.
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.truth.judge.alignment import DELAY, Alignment
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.residuals.sampling import find_time_step

WITHIN = 0.55  # largest error of a time, in steps, and the share of the estimates within it
MOST = 0.99
LEAST = 0.2  # least jitter, in steps: uniformly distributed times have 0.29 of a step
ACROSS = 0.1  # largest part of the squares that may remain across the angular velocity


@dataclass(frozen=True)
class Steps:
    """Stamps in steps.

    Attributes
    ----------
    step : float
        In s.
    jitter : float
        Deviation of the times from their mean delay, in s.
    left : float
        Root mean square in rad of the error that would remain with the true times.
    """

    step: float
    jitter: float
    left: float


def find_steps(fit: Alignment, offset: Offset) -> Steps | None:
    """Return the steps of stamps, if they explain what an offset with a delay leaves."""
    step = find_time_step(fit.some.stamps)
    if not step:
        return None
    left = fit.find_left(offset)
    by_time = fit.derive_vectors(offset, [DELAY])[:, :, 0]
    squares = (by_time**2).sum(axis=1)
    late = (by_time * left).sum(axis=1) / np.where(squares > 0, squares, 1.0)
    rest = float(((left - by_time * late[:, np.newaxis]) ** 2).sum(axis=1).mean())
    jitter = float(late.std())
    is_within = (np.abs(late - late.mean()) <= WITHIN * step).mean() >= MOST
    is_time = rest <= ACROSS * float((left**2).sum(axis=1).mean())
    if is_within and is_time and jitter >= LEAST * step:
        return Steps(step, jitter, float(np.sqrt(rest)))
    return None
