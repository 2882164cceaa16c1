"""Influences of rows on parameters, and the deviations that follow, for noise of any correlation.

Deviations are those of the sandwich (Newey and West 1987), with the scores of all estimates, an
autoregressive filter of first order before it and undone after it (Andrews and Monahan 1992),
Bartlett's kernel, and the bandwidth that is best for the correlations found (Newey and West 1994,
the lags as in Politis and White 2004).
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.residuals.correlation import find_covariances

QUIET = 50  # correlations end where a fiftieth of all lags in a row is uncorrelated


@dataclass(frozen=True, eq=False)
class Influences:
    """Changes of parameters (n, p) by each estimate."""

    values: Real
    free: int  # parameters that are fitted; the others do not change
    independent: float  # number of independent estimates

    def find_deviation(self, slope: Real) -> float:
        """Return the standard deviation of a combination (p,) of the parameters.

        Fitted parameters make the residuals smaller than the errors, and the variance itself is
        uncertain. Both effects are corrected, the second one as by Student's distribution.
        """
        return float(np.sqrt(sum_influences(self.values @ slope, self.free, self.independent)))


def find_influences(columns: Real, left: Real) -> Real:
    """Return the changes (n, p) of parameters by residuals (n, 3), with derivatives (n, 3, p)."""
    sizes = np.sqrt((columns**2).sum(axis=(0, 1))) + np.finfo(float).tiny
    columns = columns / sizes
    inverse = np.linalg.pinv(np.einsum("tij,tik->jk", columns, columns), hermitian=True)
    return np.asarray(np.einsum("tij,ti->tj", columns, left) @ inverse / sizes)


def sum_influences(values: Real, parameters: int, independent: float) -> float:
    """Return the variance of the sum of correlated numbers (n,), by how many are independent."""
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
