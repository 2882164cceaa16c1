"""Correlations of residuals in time (Priestley, Spectral Analysis and Time Series, 1981)."""

import numpy as np

from symtop_ros.base.arrays import Real

LAGS = 10  # at which rows are tried to be white


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


def find_covariances(values: Real) -> Real:
    """Return the autocovariances of rows (n, m) at lags (n,), summed over columns."""
    count = len(values)
    size = 1 << (2 * count - 1).bit_length()  # zeros keep the ends apart
    spectrum = np.fft.rfft(values, size, axis=0)
    power = (spectrum.real**2 + spectrum.imag**2).sum(axis=1)
    return np.asarray(np.fft.irfft(power, size)[:count] / count)


def sum_correlations(left: Real) -> float:
    """Return the sum of squares of the correlations over all lags, less what chance adds."""
    covariances = find_covariances(left)
    if not covariances[0]:
        return 0.0
    count = len(left)
    chance = (1 - np.arange(1, count) / count) / count
    return max(float(((covariances[1:] / covariances[0]) ** 2 - chance).sum()), 0.0)
