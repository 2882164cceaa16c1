"""The residuals of an explanation: whether they are noise, and how many are independent.

Errors of filters are correlated in time and differ along axes, so nothing here assumes white or
isotropic noise.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr

from symtop_ros.base.arrays import Real
from symtop_ros.truth.residuals.correlation import (
    average,
    measure_correlation,
    sum_correlations,
)

PER_PARAMETER = 10  # independent estimates for each parameter, at least
# Thousands of values are tried, and each can make the sum of squares smaller by chance: by less
# than this, in units of the variance of one independent number.
CHANCE = 36.0
WANDERING = 0.1  # part of the run; a longer correlation time is no noise
# Ten squares of normal numbers add up to more than 40 once in 50 000 times.
WHITE = 40.0
BLOCKS = (1, 8, 64)  # estimates in a mean
FEWEST = 50  # means that a test needs
LOUD = 0.3  # rad; noise of an attitude is smaller
# The distance of the distribution of noise from the normal one (Kolmogorov) is 0.06 if it is
# uniform and 0.07 if it has the tails of Laplace; that of two values is at least 0.34. Samples of
# normal numbers reach 0.15 + 1/sqrt(n) once in 300 times if n = 30, and never if n = 300.
ODD_SHAPE, SHAPE_CHANCE = 0.15, 1.0
FAIR = 0.25  # part of the mean square of derivatives, below which they show little
MINOR = 0.01  # part of the mean square, below which a component is not looked at


@dataclass(frozen=True, eq=False)
class Residuals:
    """Residuals of an explanation as rotation vectors, at increasing stamps."""

    frames: tuple[Real, Real]  # in the world and in the frame of the body, (n, 3) each, in rad
    seconds: float  # from the first to the last stamp

    @cached_property
    def _correlation(self) -> float:
        """Sum of the squares of the correlations over all lags, in the frame that has more.

        The squares, as correlations that swing cancel. Chance adds at most 1/n to each.
        """
        return max(sum_correlations(each) for each in self.frames)

    @property
    def rms(self) -> float:
        """Root mean square of the angles in rad."""
        return float(np.sqrt((self.frames[0] ** 2).sum(axis=1).mean()))

    @property
    def independent(self) -> float:
        """Number of estimates that are independent: n if the noise is white."""
        # The correlations r^k of an autoregression add up to twice their squares, if r is near 1.
        return len(self.frames[0]) / (1 + 4 * self._correlation)

    @property
    def numbers(self) -> float:
        """Number of independent numbers: three of each estimate if its components are alike.

        It is one if the noise is about one axis of the world or of the body.
        """
        sizes = (np.linalg.eigvalsh(frame.T @ frame) for frame in self.frames)
        alike = min(float(s.sum() ** 2 / max((s**2).sum(), 1e-300)) for s in sizes)
        return self.independent * max(alike, 1.0)

    @property
    def correlation_time(self) -> float:
        """Time in s after which errors have changed; 0 for white noise."""
        return 2 * self._correlation * self.seconds / max(len(self.frames[0]) - 1, 1)

    def find_fault(self, count: int) -> str:
        """Return why `count` parameters have no deviations: "few", "wanders", or ""."""
        if self.correlation_time > WANDERING * self.seconds > 0:
            return "wanders"
        return "few" if self.independent < PER_PARAMETER * count else ""

    @property
    def is_white(self) -> bool:
        """True if no correlation in time is significant, whatever the axes and sizes of errors."""
        return all(
            measure_correlation(average(frame, block)) <= WHITE
            for frame in self.frames
            for block in BLOCKS
            if block == 1 or len(frame) >= FEWEST * block
        )

    @property
    def has_shape_of_noise(self) -> bool:
        """True if errors are small, and distributed like those of a single source of noise."""
        square = float((self.frames[0] ** 2).sum(axis=1).mean())
        if square > LOUD**2:
            return False
        parts = [part for frame in self.frames for part in frame.T]
        return all(is_one_kind(part) for part in parts if float((part**2).mean()) > MINOR * square)

    def agrees_on(self, columns: Real) -> bool:
        """True if all estimates agree on parameters with derivatives (n, 3, p), up to noise.

        If half of them are late, the mean is a delay that none of them has.
        """
        squares = (columns**2).sum(axis=1)
        values = np.einsum("tij,ti->tj", columns, self.frames[0])
        shown = squares >= FAIR * squares.mean(axis=0)
        return all(
            is_one_kind(v[s] / q[s]) for v, q, s in zip(values.T, squares.T, shown.T, strict=True)
        )


def is_one_kind(values: Real) -> bool:
    """Return whether numbers are distributed like those of a single source of noise."""
    chance = ODD_SHAPE + SHAPE_CHANCE / np.sqrt(max(len(values), 1))
    return not len(values) or measure_distance(values) <= chance


def measure_distance(values: Real) -> float:
    """Return the largest distance of a distribution from the normal one of its mean and size."""
    spread = float(values.std())
    if not spread:
        return 1.0
    normal = ndtr((np.sort(values) - values.mean()) / spread)
    steps = np.arange(len(values) + 1) / len(values)
    return float(max((steps[1:] - normal).max(), (normal - steps[:-1]).max()))
