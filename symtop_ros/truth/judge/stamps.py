"""Stamps that are rounded or cut, for example to ms, recognised from errors of the attitude.

Each time may be off by a step. What is left along the angular velocity is then time, as a clock
shows it, and what is left across it is what remains.
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.truth.judge.alignment import DELAY, Alignment
from symtop_ros.truth.judge.compare import Offset
from symtop_ros.truth.residuals.sampling import find_time_step

WITHIN = 0.55  # steps by which a time is off its mean, and by how many estimates at least
MOST = 0.99
LEAST = 0.2  # steps of jitter, of which times in a step have 0.29, and times in two places 0.25
ACROSS = 0.1  # part of the squares that is left across the angular velocity


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
        Root mean square in rad of what the true times leave.
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
