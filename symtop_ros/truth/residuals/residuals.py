"""Noise in what an explanation leaves: its kind, the number of independent estimates, deviations.

Errors of filters are correlated in time and differ along axes. So nothing here assumes white or
isotropic noise: deviations are those of the sandwich (Newey and West 1987), with the scores of all
estimates, an autoregressive filter of first order before it and undone after it (Andrews and
Monahan 1992), Bartlett's kernel, and the bandwidth that is best for the correlations found (Newey
and West 1994, the lags as in Politis and White 2004).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr

from symtop_ros.base.arrays import Real

PER_PARAMETER = 10  # independent estimates for each parameter, at least
# Noise makes the squares smaller by chance: by less than this, in units of the variance of one
# independent number, of the thousands of values that are tried.
CHANCE = 36.0
WANDERING = 0.1  # part of the run; a longer correlation time is no noise
# Ten squares of normal numbers add up to more than 40 once in 50 000 times.
LAGS, WHITE = 10, 40.0
BLOCKS = (1, 8, 64)  # estimates in a mean
FEWEST = 50  # means that a test needs
LOUD = 0.3  # rad; noise of an attitude is smaller
# The distance of the distribution of noise from the normal one (Kolmogorov) is 0.06 if it is
# uniform and 0.07 if it has the tails of Laplace; that of two values is at least 0.34. Samples of
# normal numbers reach 0.15 + 1/sqrt(n) once in 300 times if n = 30, and never if n = 300.
ODD_SHAPE, SHAPE_CHANCE = 0.15, 1.0
FAIR = 0.25  # part of the mean square of derivatives, below which they show little
MINOR = 0.01  # part of the mean square, below which a component is not looked at
QUIET = 50  # a fiftieth of all lags without a correlation: there are no more


@dataclass(frozen=True, eq=False)
class Residuals:
    """The rotation vectors that an explanation leaves, at stamps in order."""

    frames: tuple[Real, Real]  # in the world and in the frame of the body, (n, 3) each, in rad
    seconds: float  # from the first to the last stamp

    @cached_property
    def _correlation(self) -> float:
        """Sum of the squares of the correlations over all lags, in the frame that has more.

        The squares, as correlations that swing cancel. Chance adds at most 1/n to each.
        """
        return max(_sum_squares(each) for each in self.frames)

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
        """Return why there are no deviations of so many parameters: "few", "wanders", or ""."""
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
        """True if errors are small, and distributed as those of one kind of noise may be."""
        square = float((self.frames[0] ** 2).sum(axis=1).mean())
        if square > LOUD**2:
            return False
        parts = [part for frame in self.frames for part in frame.T]
        return all(is_one_kind(part) for part in parts if float((part**2).mean()) > MINOR * square)

    def agrees_on(self, columns: Real) -> bool:
        """True if all estimates agree on parameters with derivatives (n, 3, p), but for noise.

        If half of them are late, the mean is a delay that none of them has.
        """
        squares = (columns**2).sum(axis=1)
        values = np.einsum("tij,ti->tj", columns, self.frames[0])
        shown = squares >= FAIR * squares.mean(axis=0)
        return all(
            is_one_kind(v[s] / q[s]) for v, q, s in zip(values.T, squares.T, shown.T, strict=True)
        )


def is_one_kind(values: Real) -> bool:
    """Return whether numbers are distributed as those of one kind of noise may be."""
    chance = ODD_SHAPE + SHAPE_CHANCE / np.sqrt(max(len(values), 1))
    return not len(values) or measure_distance(values) <= chance


def average(values: Real, block: int) -> Real:
    """Return the means of blocks of rows."""
    count = len(values) // block
    return np.asarray(values[: count * block].reshape(count, block, -1).mean(axis=1))


def measure_correlation(left: Real) -> float:
    """Return the sum of squares of the correlations at the first lags, in deviations.

    A product of two independent errors has the mean zero, so that its own mean square is the
    variance, whatever the covariance is and however it changes (Lobato 2001).
    """
    products = [
        (left[lag:] * left[:-lag]).sum(axis=1) for lag in range(1, min(LAGS, len(left) // 4) + 1)
    ]
    return sum(float(each.sum() ** 2 / max((each**2).sum(), 1e-300)) for each in products)


def measure_distance(values: Real) -> float:
    """Return the largest distance of a distribution from the normal one of its mean and size."""
    spread = float(values.std())
    if not spread:
        return 1.0
    normal = ndtr((np.sort(values) - values.mean()) / spread)
    steps = np.arange(len(values) + 1) / len(values)
    return float(max((steps[1:] - normal).max(), (normal - steps[:-1]).max()))


def find_covariances(values: Real) -> Real:
    """Return the autocovariances of rows (n, m) at lags (n,), summed over columns."""
    count = len(values)
    size = 1 << (2 * count - 1).bit_length()  # zeros keep the ends apart
    spectrum = np.fft.rfft(values, size, axis=0)
    power = (spectrum.real**2 + spectrum.imag**2).sum(axis=1)
    return np.asarray(np.fft.irfft(power, size)[:count] / count)


def _sum_squares(left: Real) -> float:
    covariances = find_covariances(left)
    if not covariances[0]:
        return 0.0
    count = len(left)
    chance = (1 - np.arange(1, count) / count) / count
    return max(float(((covariances[1:] / covariances[0]) ** 2 - chance).sum()), 0.0)


@dataclass(frozen=True, eq=False)
class Influences:
    """Changes of parameters (n, p) by each estimate."""

    values: Real
    free: int  # parameters that are fitted; the others do not change
    independent: float  # number of estimates that are

    def find_deviation(self, slope: Real) -> float:
        """Return the standard deviation of a combination (p,) of the parameters.

        The parameters make what is left smaller than the errors, and the variance is itself
        uncertain: both are made good for, the latter as by Student's distribution.
        """
        return float(np.sqrt(sum_influences(self.values @ slope, self.free, self.independent)))


def find_influences(columns: Real, left: Real) -> Real:
    """Return the changes (n, p) of parameters with derivatives (n, 3, p) by what is left (n, 3)."""
    sizes = np.sqrt((columns**2).sum(axis=(0, 1))) + np.finfo(float).tiny
    columns = columns / sizes
    inverse = np.linalg.pinv(np.einsum("tij,tik->jk", columns, columns), hermitian=True)
    return np.asarray(np.einsum("tij,ti->tj", columns, left) @ inverse / sizes)


def sum_influences(values: Real, parameters: int, independent: float) -> float:
    """Return the variance of the sum of correlated numbers (n,), of which so many are free."""
    square = float(values @ values)
    if not square:
        return 0.0
    variance = max(_filter_and_sum(values, parameters), len(values) * sum_lags(values))
    # The logarithm of the variance has a deviation of 2/sqrt(N), as that of N/2 squares.
    free = min(independent, len(values) * square / variance)
    return variance * _exceed(free, parameters) * _exceed(free, 4)


def _exceed(free: float, count: int) -> float:
    return free / max(free - count, 1.0)


def _filter_and_sum(values: Real, parameters: int) -> float:
    """Return the variance by an autoregression of first order and what it leaves."""
    count = len(values)
    slope = float(values[1:] @ values[:-1]) / float(values @ values)
    if slope > 0:  # which is too small on average (Kendall 1954), the more after a fit
        slope += (2 * slope + parameters * (1 + slope)) / count
    slope = min(slope, 1 - 1 / count)
    return count * sum_lags(values[1:] - slope * values[:-1]) / (1 - slope) ** 2


def sum_lags(values: Real) -> float:
    """Return the sum of autocovariances over all lags: the variance of a sum, for each number.

    The larger of two estimates: Bartlett's kernel falls short of correlations that decay slowly,
    and the flat kernel, which finds the bandwidth, may fall below zero.
    """
    covariances = find_covariances(values[:, np.newaxis])
    flat, moment = _sum_flat(covariances)
    ratio = moment / flat if flat > 0 else 0.0
    width = min(1.1447 * (ratio**2 * len(values)) ** (1 / 3), len(values) / 4)
    lags = np.arange(1, int(width) + 1)
    bartlett = covariances[0] + 2 * (1 - lags / (width + 1)) @ covariances[lags]
    return max(float(bartlett), flat)


def _sum_flat(covariances: Real) -> tuple[float, float]:
    """Return the sum of autocovariances and of their products with the lag, by a flat kernel."""
    count = len(covariances)
    chance = 2 * np.sqrt(np.log10(max(count, 2)) / count) * covariances[0]
    quiet = np.abs(covariances[1:]) < chance
    run = max(5, count // QUIET)
    calm = np.convolve(quiet, np.ones(run, dtype=int), "valid") == run
    last = int(np.argmax(calm)) if calm.any() else count // 4
    most = min(2 * max(last, 1), count // 2)
    lags = np.arange(1, most + 1)
    kept = 2 * np.clip(2 * (1 - lags / most), 0.0, 1.0) * covariances[lags]
    return float(covariances[0] + kept.sum()), float(lags @ kept)
