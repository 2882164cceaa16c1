"""Correlated noise: its prediction from earlier rows, and the whitened remainder.

The order of an autoregression is the one that Hannan and Quinn's criterion chooses. Flicker, whose
power goes with 1/f, has no order: its slowest part would be taken for a tenth of its size. It is
predicted as fractional noise (Granger and Joyeux 1980; Hosking 1981), if that is more likely. The
first rows after a gap are predicted from the rows since the gap. The fit and the judge whiten by
it. Noise of any other correlation is left to the sandwich of `influence.py`.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Real

ORDERS = 12  # of an autoregression, at most
PER_ORDER = 20  # rows for each order
# Twice the logarithm of a ratio of likelihoods, for each column. In 150 to 500 rows of flicker an
# autoregression is ahead by up to 19, as a few rows hardly show what is slow, and in those of one
# that keeps 0.8 from row to row by 17 to 90. If neither is clear, the slower one is taken.
CLEAR = 20.0
POWERS = np.linspace(0.05, 0.49, 12)  # d of fractional noise, whose power goes with f^(-2 d)
LONGEST, PER_LAG = 64, 4  # rows by which it is predicted, at most, and rows for each
LARGEST = 0.9999  # partial autocorrelation
# Deviation of a column whose residuals are all zero, because an exact solution fits it to the last
# bit: its logarithm must be finite.
TINY = 1e-150
ALIKE = 0.1  # of the largest deviation of components


@dataclass(frozen=True, eq=False)
class Noise:
    """The noise of rows in the order of time.

    Attributes
    ----------
    kept : ndarray (n,)
        True for rows that are no outliers.
    before : ndarray (n,)
        Number of rows before each, without a gap or an outlier, at most q.
    sigma : ndarray (r,)
        Deviations of what is new in each row, if there are q before it.
    partial : ndarray (q, r)
        Partial autocorrelations at each lag; q = 0 for white noise.
    outliers : int
    """

    kept: Mask
    before: Places
    sigma: Real
    partial: Real
    outliers: int

    @cached_property
    def predictors(self) -> tuple[Real, Real]:
        """Coefficients (q + 1, q, r) by up to q rows before, and deviations (q + 1, r) in sigma."""
        return find_predictors(self.partial)

    @property
    def is_flicker(self) -> bool:
        """True if it is predicted as fractional noise, by more rows than an autoregression has."""
        return len(self.partial) > ORDERS

    def whiten(self, rows: Real) -> Real:
        """Return the whitened kept rows (n, r, ...), in deviations."""
        shape = (-1, rows.shape[1], *[1] * (rows.ndim - 2))
        slopes, deviations = self.predictors
        new = rows.copy()
        for lag in range(1, len(self.partial) + 1):
            new[lag:] -= slopes[self.before[lag:], lag - 1].reshape(shape) * rows[:-lag]
        size = self.sigma * deviations[self.before[self.kept]]
        return np.asarray(new[self.kept] / size.reshape(shape))


def find_predictors(partial: Real) -> tuple[Real, Real]:
    """Return the predictors of all orders, by Durbin and Levinson's recursion."""
    count, width = partial.shape
    slopes, variances = np.zeros((count + 1, count, width)), np.ones((count + 1, width))
    for order in range(1, count + 1):
        own, last = partial[order - 1], slopes[order - 1, : order - 1]
        slopes[order, : order - 1] = last - own * last[::-1]
        slopes[order, order - 1] = own
        variances[order] = variances[order - 1] * (1 - own**2)
    return slopes, np.sqrt(variances / variances[-1])


def find_noise(left: Real, follows: Mask, parameters: int) -> Noise:
    """Return the noise of residuals (n, r) after a fit of some parameters, without outliers."""
    good = np.ones(len(left), dtype=bool)
    partial = find_pacf(left, good, follows, parameters)
    noise = measure_noise(left, good, follows, partial, parameters)
    # Components that hardly have any noise are not trusted more than this.
    return replace(noise, sigma=np.maximum(noise.sigma, ALIKE * noise.sigma.max()))


def measure_noise(left: Real, good: Mask, follows: Mask, partial: Real, parameters: int) -> Noise:
    """Return the noise with given partial autocorrelations."""
    if not good.any():
        good, partial = np.ones(len(left), dtype=bool), partial[:0]
    before = count_before(good, follows, len(partial))
    noise = Noise(good, before, np.ones(left.shape[1]), partial, int((~good).sum()))
    new = noise.whiten(left)
    free = max(len(new) - parameters / left.shape[1], 1.0)
    return replace(noise, sigma=np.sqrt((new**2).sum(axis=0) / free) + TINY)


def count_before(good: Mask, follows: Mask, most: int) -> Places:
    """Return how many good rows, each a step after the other, come before each row, (n,)."""
    places = np.arange(len(good))
    begins = np.append(True, ~(good[:-1] & follows[1:]))
    count = places - np.maximum.accumulate(np.where(begins, places, 0))
    return np.minimum(count, most)


def _link(follows: Mask, lag: int) -> Mask:
    """Return True (n - lag,) for rows that come after `lag` steps without a gap."""
    count = np.concatenate([[0], np.cumsum(~follows)])
    return np.asarray(count[lag + 1 :] == count[1:-lag])


def find_pacf(left: Real, good: Mask, follows: Mask, parameters: int) -> Real:
    """Return the partial autocorrelations (q, r) of the noise that is most likely.

    A fit takes the share p/(n r) of the power of noise away; it is given back to the correlations.
    """
    most = min(ORDERS, len(left) // PER_ORDER)
    covariances = find_lag_covariances(left, good, follows, most)
    total = covariances[0] + 2 * covariances[1:].sum(axis=0)
    share = parameters / (len(left) * left.shape[1])
    covariances = covariances + share * np.maximum(total, covariances[0])
    partial = find_partials(covariances)
    lost = np.log(np.cumprod(np.append(np.ones((1, left.shape[1])), 1 - partial**2, axis=0), 0))
    orders = np.arange(most + 1) * left.shape[1]
    loglog = np.log(np.log(max(len(left), 16)))
    order = int(np.argmin(len(left) * lost.sum(axis=1) + 2 * orders * loglog))
    partial = partial[:order]
    if not order or len(left) // PER_LAG <= ORDERS:
        return partial
    flicker = find_flicker(left, good, follows)
    own, other = (
        measure_likelihood(measure_noise(left, good, follows, each, parameters), left) - cost
        for each, cost in ((partial, 2 * orders[order] * loglog), (flicker, 2 * orders[1] * loglog))
    )
    return partial if own > other + CLEAR * left.shape[1] else flicker


def find_partials(covariances: Real) -> Real:
    """Return the partial autocorrelations (q, r) of covariances (q + 1, r)."""
    count, width = len(covariances) - 1, covariances.shape[1]
    partial, slopes, new = np.zeros((count, width)), np.zeros((count, width)), covariances[0]
    for order in range(1, count + 1):
        last = slopes[: order - 1].copy()
        seen = (last * covariances[order - 1 : 0 : -1]).sum(axis=0)
        own = np.clip((covariances[order] - seen) / new, -LARGEST, LARGEST)
        slopes[: order - 1] = last - own * last[::-1]
        slopes[order - 1] = partial[order - 1] = own
        new = new * (1 - own**2)
    return partial


def find_flicker(left: Real, good: Mask, follows: Mask) -> Real:
    """Return the partial autocorrelations d/(k - d) of the fractional noise that is most likely."""
    most = min(LONGEST, len(left) // PER_LAG)
    lags = np.arange(1, most + 1)[:, np.newaxis]
    tried = np.multiply.outer(POWERS, np.ones(left.shape[1]))
    likely = []
    for powers in tried:
        noise = measure_noise(left, good, follows, powers / (lags - powers), 0)
        likely.append(_measure_columns(noise, left))
    best = POWERS[np.argmax(likely, axis=0)]
    return np.asarray(best / (lags - best))


def measure_likelihood(noise: Noise, left: Real) -> float:
    """Return twice the logarithm of the likelihood of normal noise, up to a constant."""
    return float(_measure_columns(noise, left).sum())


def _measure_columns(noise: Noise, left: Real) -> Real:
    new = noise.whiten(left)
    sizes = np.log(noise.sigma * noise.predictors[1][noise.before[noise.kept]])
    return np.asarray(-(new**2).sum(axis=0) - 2 * sizes.sum(axis=0))


def find_lag_covariances(left: Real, good: Mask, follows: Mask, most: int) -> Real:
    """Return the covariances (most + 1, r) of good rows at lags without a gap."""
    found = [(left[good] ** 2).mean(axis=0) + 1e-300]
    for lag in range(1, most + 1):
        pairs = good[lag:] & good[:-lag] & _link(follows, lag)
        products = (left[lag:] * left[:-lag])[pairs]
        found.append(products.sum(axis=0) / max(len(products) + lag, 1))
    return np.array(found)
