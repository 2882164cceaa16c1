"""Steps of the parameters, which are changed until their errors are as promised."""

from typing import Any

import numpy as np

from symtop_ros.base.arrays import Places, Real
from symtop_ros.physics.jacobian.differences import FARTHEST, Difference
from symtop_ros.physics.jacobian.nodes import ORDER, TINY

RESPONSE = 0.25  # of the outermost states, in rad or in units of the fastest rate
MOST_ROUNDS = 24
# Factors of a step from one round to the next. Those next to the best one are such that no step is
# taken twice.
LONGER, MOST_LONGER, SHORTER, MOST_SHORTER = 1.5, 1e6, 0.95, 0.02
NEXT = 1.09


class Steps:
    """A step of each parameter."""

    def __init__(self, sizes: Real, longest: Real, turned: float) -> None:
        """Begin with steps that move the outermost states by `RESPONSE`.

        `sizes` (9,) are those of the parameters, `longest` (9,) the longest steps, and `turned` is
        the largest angle, in rad, by which a change by all of a parameter may turn a state.
        """
        self._longest = longest
        self.values = np.minimum(longest, sizes * (RESPONSE / 5 / (1 + turned)))
        self._too_long = np.full(9, -1)  # the element for which a step of a column was

    def adapt(self, part: Any, excess: Real, limit: Real, found: Difference) -> bool:
        """Change the steps of columns by their worst elements; return False if that is no use.

        `part` has the places of times and columns in all derivatives, and `excess` (m, 2, 3, c) how
        many times their errors are those that are allowed, `limit`.
        """
        columns = part[-1].ravel()
        worst = excess.reshape(-1, len(columns)).argmax(axis=0)
        places = np.unravel_index(worst * len(columns) + np.arange(len(columns)), excess.shape)
        faults = limit, found.responses, found.curved, found.rough
        limit, responses, curved, rough = (
            np.broadcast_to(each, excess.shape)[places] for each in faults
        )
        elements = part[0].ravel()[places[0]] * 6 + worst % 6
        is_open = excess[places] > 1
        is_near = self._too_long[columns] == elements
        is_long = curved > rough / 3
        longer = np.where(is_near, NEXT, np.clip(3 * rough / limit, LONGER, MOST_LONGER))
        factors = np.where(is_long, _shorten(responses, curved, rough), longer)
        self._too_long[columns[is_long]] = elements[is_long]
        is_lost = self._set(columns, factors, is_open)
        # More steps reduce an error by rounding, by their root.
        is_lost |= is_near & ~is_long & (rough > MOST_ROUNDS / 3 * limit)
        return not (is_lost & is_open).any()

    def _set(self, columns: Places, factors: Real, is_open: Any) -> Any:
        """Change steps by factors, and return which of them are as long as before."""
        before = self.values[columns]
        steps = np.minimum(before * factors, self._longest[columns])
        self.values[columns[is_open]] = steps[is_open]
        return steps == before


def _shorten(responses: Real, curved: Real, rough: Real) -> Real:
    """Return factors of steps that are too long."""
    # The best step has an error by curvature of a tenth of that by rounding.
    shorter = (rough / np.maximum(10 * curved, rough + TINY)) ** (1 / (ORDER + 1))
    shorter = np.where(responses > FARTHEST, RESPONSE / (4 * responses + TINY), shorter)
    return np.asarray(np.clip(shorter, MOST_SHORTER, SHORTER))
