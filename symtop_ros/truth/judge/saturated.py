"""A gyroscope whose range is smaller than the spin, recognised from rates or attitudes."""

from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.saturation import NEAR, RATES, find_saturations
from symtop_ros.truth.topics.estimates import Estimates
from symtop_ros.words import write

MOST = 20_000  # estimates that are looked at
TURN = 1.5  # rad from one estimate to the next, beyond which turns may be missed
USUAL = 0.9  # of the turns are at the limit
BEYOND = 1.01  # smallest exact rate, in limits


@dataclass(frozen=True)
class Saturated:
    """A limit of a sensor, in rad/s, that the estimates show while the exact rate is beyond it.

    Attributes
    ----------
    limit : float
    exact : float
        Median of the exact rate there, in rad/s.
    share : float
        Share of the estimates that are at the limit.
    of : str
        "rates" or "turns".
    """

    limit: float
    exact: float
    share: float
    of: str

    def describe(self) -> str:
        """Return a sentence on the limit."""
        numbers = {"degrees": float(np.degrees(self.limit)), "share": 100 * self.share}
        return write("saturated", {**vars(self), **numbers})


def find_saturated(estimates: Estimates, truth: Truth) -> Saturated | None:
    """Return the limit at which the rates, or the rotations about the axis, stay."""
    some = estimates.select(np.arange(len(estimates)) < MOST)
    _, exact, known = truth.states_at(some.stamps, some.of_sensor)
    some, exact = some.select(known), exact[known]
    if len(some) < 2:
        return None
    return _find_in_rates(some, exact) or _find_in_turns(some, exact)


def _find_in_rates(some: Estimates, exact: Real) -> Saturated | None:
    if some.angular_velocities is None:
        return None
    rates = np.asarray(some.angular_velocities)
    for each in find_saturations(rates, RATES):
        at = rates[:, each.column] == each.limit
        found = float(np.median(exact[at, each.column]))
        if found / each.limit > BEYOND:
            return Saturated(each.limit, found, float(at.mean()), "rates")
    return None


def _find_in_turns(some: Estimates, exact: Real) -> Saturated | None:
    """Return the usual limit of sensors at which attitudes turn about an axis of the body."""
    q, steps = some.orientations, np.diff(some.stamps) / NANOSECONDS
    fast = np.abs(exact[:-1]).max(axis=1) * steps > TURN
    if fast.any() or not steps.all():  # two attitudes at one time have no rate
        return None
    turns = find_rotation_vectors(compose(invert(q[:-1]), q[1:])) / steps[:, np.newaxis]
    for column, limit in np.ndindex(3, len(RATES)):
        at = np.abs(np.abs(turns[:, column]) / RATES[limit] - 1) < NEAR
        found = float(np.median(exact[:-1, column]))
        if at.mean() > USUAL and abs(found) > BEYOND * RATES[limit]:
            size = float(np.copysign(RATES[limit], found))
            return Saturated(size, found, float(at.mean()), "turns")
    return None
