"""Noise that lasts from row to row: an autoregression, and what is new in each row.

The order is the one that Hannan and Quinn's criterion chooses: flicker has another power at a
nutation than on average. `truth/fit` and the judge whiten by it. Noise of any other correlation is
left to the sandwich of `noise.py`.
"""

from dataclasses import dataclass, replace

import numpy as np

from symtop_ros.base.arrays import Mask, Real

ORDERS = 12  # of an autoregression, at most
PER_ORDER = 20  # rows for each order
ALIKE = 0.1  # of the largest deviation of components


@dataclass(frozen=True, eq=False)
class Noise:
    """The noise of rows in the order of time.

    Attributes
    ----------
    kept : ndarray (n,)
        True for rows that are no outliers and, if noise lasts, follow enough that are none.
    sigma : ndarray (r,)
        Deviations of what is new in each row.
    lasting : ndarray (q, r)
        Coefficients of the autoregression, of the row before first; q = 0 for white noise.
    outliers : int
    """

    kept: Mask
    sigma: Real
    lasting: Real
    outliers: int

    def whiten(self, rows: Real) -> Real:
        """Return what is new in the kept rows (n, r, ...), in deviations."""
        shape = (-1, *[1] * (rows.ndim - 2))
        new = rows.copy()
        for lag, each in enumerate(self.lasting, 1):
            new[lag:] -= each.reshape(shape) * rows[:-lag]
        return np.asarray((new / self.sigma.reshape(shape))[self.kept])


def find_noise(left: Real, follows: Mask, parameters: int) -> Noise:
    """Return the noise of what so many parameters leave (n, r), without outliers."""
    good = np.ones(len(left), dtype=bool)
    lasting = find_lasting(left, good, follows, parameters)
    noise = measure_noise(left, good, follows, lasting, parameters)
    # Components that hardly have any noise are not trusted more than this.
    return replace(noise, sigma=np.maximum(noise.sigma, ALIKE * noise.sigma.max()))


def measure_noise(left: Real, good: Mask, follows: Mask, lasting: Real, parameters: int) -> Noise:
    """Return the noise with an autoregression, if there are rows with enough before them."""
    kept = good & find_runs(good, follows, len(lasting))
    if not kept.any():
        kept, lasting = np.ones(len(left), dtype=bool), lasting[:0]
    new = Noise(kept, np.ones(left.shape[1]), lasting, int((~good).sum())).whiten(left)
    free = max(len(new) - parameters / left.shape[1], 1.0)
    return Noise(kept, np.sqrt((new**2).sum(axis=0) / free), lasting, int((~good).sum()))


def find_runs(good: Mask, follows: Mask, length: int) -> Mask:
    """Return True (n,) for rows that follow so many good ones, each a step after the other."""
    found = np.ones(len(good), dtype=bool)
    for lag in range(1, length + 1):
        found[:lag] = False
        found[lag:] &= good[:-lag] & _link(follows, lag)
    return found


def _link(follows: Mask, lag: int) -> Mask:
    """Return True (n - lag,) for rows that come after `lag` steps without a gap."""
    count = np.concatenate([[0], np.cumsum(~follows)])
    return np.asarray(count[lag + 1 :] == count[1:-lag])


def find_lasting(left: Real, good: Mask, follows: Mask, parameters: int) -> Real:
    """Return the coefficients (q, r) of autoregressions of one order for all columns.

    A fit takes the share p/(n r) of the power of noise away; it is given back to the correlations.
    """
    most = min(ORDERS, len(left) // PER_ORDER)
    covariances = find_lag_covariances(left, good, follows, most)
    total = covariances[0] + 2 * covariances[1:].sum(axis=0)
    share = parameters / (len(left) * left.shape[1])
    covariances = covariances + share * np.maximum(total, covariances[0])
    fits = [solve_order(covariances, order) for order in range(most + 1)]
    loglog = np.log(np.log(max(len(left), 16)))
    cost = [
        len(left) * np.log(new / covariances[0]).sum() + 2 * order * left.shape[1] * loglog
        for order, (_, new) in enumerate(fits)
    ]
    return fits[int(np.argmin(cost))][0]


def find_lag_covariances(left: Real, good: Mask, follows: Mask, most: int) -> Real:
    """Return the covariances (most + 1, r) of good rows at lags without a gap."""
    found = [(left[good] ** 2).mean(axis=0) + 1e-300]
    for lag in range(1, most + 1):
        pairs = good[lag:] & good[:-lag] & _link(follows, lag)
        products = (left[lag:] * left[:-lag])[pairs]
        found.append(products.sum(axis=0) / max(len(products) + lag, 1))
    return np.array(found)


def solve_order(covariances: Real, order: int) -> tuple[Real, Real]:
    """Return coefficients (q, r) and the variance (r,) of what is new, by Yule and Walker."""
    places = np.abs(np.subtract.outer(np.arange(order), np.arange(order)))
    slopes = np.zeros((order, covariances.shape[1]))
    for column, own in enumerate(covariances.T):
        slopes[:, column] = np.linalg.lstsq(own[places], own[1 : order + 1], rcond=None)[0]
    new = covariances[0] - (slopes * covariances[1 : order + 1]).sum(axis=0)
    return slopes, np.maximum(new, 1e-6 * covariances[0])
