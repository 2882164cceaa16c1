"""The valley of motions that fit nearly as well, and whether deviations hold along it.

One deviation away from the best motion the sum of squared residuals has grown by one. If the valley
is curved, a straight step leaves it, and the sum grows by much more. Often only the parameters are
curved: after thousands of nutations a step that changes Mgl keeps the period to first order alone,
and the period is known so well that the second order counts. So such a step is followed by one back
to the floor of the valley, in the directions that are known better. The deviation of a number holds
if on the floor, some deviations away on both sides, the sum has grown as expected, and the number
has changed as expected.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Real
from symtop_ros.truth.fit.refine import Fit, find_rounding

STRAIGHT = 2.0  # times the growth of squares; 1.0 to 1.1 in most records
GIVEN = 0.5  # share of the information on a step that is given, above which residuals say little
CURVED = 0.1  # share of a variance that may come from curved directions
BENT = 0.3  # deviations; a number that is bent by b of them has pulls of sqrt(1 + 3 b^2)
# Steps of Gauss and Newton to the floor, with the derivatives of the best motion. A valley that
# takes more is so bent that its deviations are in doubt.
DESCENTS = 4
FAR = 3.0  # deviations; a short record may have a straight valley that ends within them
SIDES = (1.0, -1.0)


@dataclass(frozen=True, eq=False)
class Valley:
    """The motions one deviation away from a fit, along the eigenvectors of Fisher's matrix."""

    fit: Fit

    @cached_property
    def steps(self) -> Real:
        """Steps (p, p) of one deviation, the one that is known least first."""
        values, vectors = self.fit.spectrum
        return np.asarray((vectors / np.sqrt(values) / self.fit.sizes[:, np.newaxis]).T)

    @cached_property
    def is_left(self) -> Mask:
        """True (p,) for steps that leave the valley if they are straight."""
        # the mean of both sides, as the least squares may have ended a little off the minimum
        grown = [
            float(np.mean([self._measure_growth(self.fit.x + side * step) for side in SIDES]))
            for step in self.steps
        ]
        return np.asarray([not is_near(each) for each in grown]) & ~self._are_given

    @cached_property
    def floors(self) -> dict[int, list[Real]]:
        """Motions on the floor to both sides, FAR deviations away, by the number of the step."""
        return {
            k: [self._descend(self.fit.x + side * FAR * self.steps[k], k) for side in SIDES]
            for k in map(int, np.flatnonzero(self.is_left))
        }

    @cached_property
    def is_curved(self) -> Mask:
        """True (p,) for directions along which a deviation is not what Fisher's matrix says."""
        found = np.zeros(len(self.steps), dtype=bool)
        for k, ends in self.floors.items():
            grown = [self._measure_growth(each) / FAR**2 for each in ends]
            found[k] = not all(map(is_near, grown))
        return found

    def is_straight(self, slope: Real, of: Callable[[Real], float]) -> bool:
        """Return True if the deviation of a number, by its derivatives (p,), holds."""
        values, vectors = self.fit.spectrum
        parts = ((slope / self.fit.sizes) @ vectors) ** 2 / values
        if parts[self.is_curved].sum() > CURVED * parts.sum():
            return False
        own = of(self.fit.x)
        bends = [np.mean([_ask(of, end) for end in ends]) - own for ends in self.floors.values()]
        return bool(np.square(bends).sum() <= (BENT * FAR**2) ** 2 * parts.sum())

    def _measure_growth(self, x: Real) -> float:
        return self._sum_squares(x) - self._sum_squares(self.fit.x)

    def _sum_squares(self, x: Real) -> float:
        left = self.fit.noise.whiten(self.fit.model.find_residuals(x))
        return float((left**2).sum() + self._find_errors(x) ** 2 @ self.fit.priors)

    def _find_errors(self, x: Real) -> Real:
        """Return the differences (p,) from what is known."""
        known = self.fit.model.record.known
        return np.array(
            [x[k] - known[n][0] if n in known else 0.0 for k, n in enumerate(self.fit.model.names)]
        )

    def _descend(self, x: Real, k: int) -> Real:
        """Return the lowest point that the directions after the k-th reach from x.

        In a very curved valley the result may be parameters without a motion.
        """
        values, vectors = self.fit.spectrum
        better = vectors[:, k + 1 :] / self.fit.sizes[:, np.newaxis]
        for _ in range(DESCENTS):
            left = self.fit.noise.whiten(self.fit.model.find_residuals(x))
            slope = np.einsum("tip,ti->p", self.fit.columns, left)
            slope += self._find_errors(x) * self.fit.priors
            x = x - better @ (better.T @ slope / values[k + 1 :])
        return x

    @cached_property
    def _are_given(self) -> Mask:
        """True (p,) for steps whose size comes from known values or from rounding.

        For these the residuals do not show how far away the motion may be.
        """
        _, fixed = find_rounding(self.fit.model.record, self.fit.white.shape[1])
        moved = np.einsum("tip,kp->tik", self.fit.columns[:, fixed], self.steps)
        return np.asarray(self.steps**2 @ self.fit.priors + (moved**2).sum(axis=(0, 1)) > GIVEN)


def _ask(of: Callable[[Real], float], x: Real) -> float:
    """Return a number of the motion of some parameters; NaN if there is no such motion."""
    try:
        return of(x)
    except ValueError:
        return np.nan


def is_near(growth: float) -> bool:
    """Return True if the growth of a sum of squares, divided by the expected one, is about one."""
    return 1 / STRAIGHT < growth < STRAIGHT
