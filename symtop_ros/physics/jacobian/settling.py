"""Rounds of steps, until all derivatives at some times are right or no step helps."""

from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Places, Real
from symtop_ros.base.refusals import RefusedError, refuse
from symtop_ros.physics.jacobian.differences import Difference, Differences
from symtop_ros.physics.jacobian.differentiable import Differentiable
from symtop_ros.physics.jacobian.estimates import Estimates
from symtop_ros.physics.jacobian.neighbours import Neighbours
from symtop_ros.physics.jacobian.rounding import Rounding
from symtop_ros.physics.jacobian.scales import Scales
from symtop_ros.physics.jacobian.steps import MOST_ROUNDS, Steps
from symtop_ros.physics.times import ExactTimes, to_rough_seconds

UNRESOLVED = (
    "a time at which double precision resolves the derivatives (the start is too near the vertical "
    "or the separatrix)"
)
# Error of a row by the curvature of the other ones: next to the vertical the angle about the axis
# looks smooth by steps that are far too long for the tilt.
SPREAD = 2e-6
WILD = 1e7  # promised errors; steps that leave so much in a row turn phases by whole turns


class Settling:
    """Derivatives at times that share their steps."""

    def __init__(self, motion: Differentiable, times: Real | ExactTimes) -> None:
        """Begin with steps that suit the longest of the times (n,)."""
        self._seconds = to_rough_seconds(times)
        longest = float(np.abs(self._seconds).max())
        states = motion.at(times)
        self._scales = Scales(motion, states, longest)
        sizes, of_states = self._scales.of_steps, self._scales.of_states
        neighbours = Neighbours(motion, times, states)
        rounding = Rounding(motion, states, of_states)
        self._differences = Differences(neighbours, rounding, self._scales.of_blocks)
        most = neighbours.find_longest_steps(sizes)
        self._steps = Steps(sizes, most, self._scales.rate * longest)
        self._found = Estimates(len(self._seconds))
        self._last = np.zeros_like(self._found.derivatives)

    def settle(self) -> tuple[Real, Places]:
        """Return the derivatives (n, 6, 9), and the places of times at which they are not right."""
        left, columns = np.arange(len(self._seconds)), np.arange(9)
        for _ in range(MOST_ROUNDS):
            excess, helps = self._take_round(left, columns)
            is_open = excess > 1
            # A step about one axis of the body is rounded to one about all three.
            is_open[..., 3:6] = is_open[..., 3:6].any(axis=-1, keepdims=True)
            columns = np.flatnonzero(is_open.any(axis=(0, 1, 2)))
            left = left[is_open.any(axis=(1, 2, 3))]
            if not len(left) or not helps:
                break
        return self._found.derivatives.reshape(-1, 6, 9), left

    def _take_round(self, left: Places, columns: Places) -> tuple[Real, bool]:
        """Differentiate once, and change the steps.

        Return the errors (m, 2, 3, 9) in units of what is allowed, and whether a next round helps.
        """
        part = np.ix_(left, np.arange(2), np.arange(3), columns)
        new = self._differentiate(left, columns)
        self._last[part] = new.derivatives
        limit = self._find_allowed(self._last, left)[..., columns]
        wildness = (new.curved / limit).max(axis=(1, 2), keepdims=True)
        new = replace(new, curved=np.maximum(new.curved, limit * SPREAD * wildness))
        unusable = np.where(wildness > WILD, np.inf, 0.0)
        found = self._found
        found.add(part, self._steps.values[columns], replace(new, curved=new.curved + unusable))
        known = np.where(np.isinf(found.errors), self._last, found.derivatives)
        allowed = self._find_allowed(known, left)
        excess = found.errors[left] / allowed
        helps = self._steps.adapt(part, excess[..., columns], allowed[..., columns], new)
        return excess, helps

    def _differentiate(self, left: Places, columns: Places) -> Difference:
        new = self._differences.take(self._steps.values, left, columns)
        if new is None:
            raise refuse_time(float(self._seconds[0]))
        return new

    def _find_allowed(self, derivatives: Real, left: Places) -> Real:
        return self._scales.find_allowed(derivatives[left], self._scales.of_states[left])


def refuse_time(t: float) -> RefusedError:
    """Return the refusal of a time (s) at which no step resolves the derivatives."""
    return refuse("t", UNRESOLVED, t)
