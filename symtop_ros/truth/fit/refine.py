"""Least squares with the noise that is found: outliers left out, lasting noise whitened, deviations.

The weights are those of the noise of each column. Noise that lasts is taken as an autoregression of
first order, which loses little of what a record shows; whatever noise it is not is left to the
sandwich of `truth/judge/noise.py`, so that deviations are those of noise of any correlation.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Real
from symtop_ros.truth.fit.model import Model
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.search import find_spread, minimise
from symtop_ros.truth.judge.noise import Remainder, sum_influences

OUTLIER = 5.0  # deviations; a normal number is farther once in two million
ROUNDS = 8  # of weights and least squares
MANY = 0.02  # part of the rows; with more outliers there are too few neighbours
LASTS = 2.5  # deviations of a correlation of neighbours by chance
MOST_LASTING = 0.995
SETTLED = 1e-7  # of the scale of a parameter
NULL = 1e-16  # of the largest eigenvalue, to which a smaller one is raised


@dataclass(frozen=True, eq=False)
class Noise:
    """The noise of a record.

    Attributes
    ----------
    kept : ndarray (n,)
        True for rows that are no outliers and, if noise lasts, follow one that is none.
    sigma : ndarray (r,)
        Deviations of what is new in each row.
    lasting : ndarray (r,)
        Correlation of neighbours.
    outliers : int
    """

    kept: Mask
    sigma: Real
    lasting: Real
    outliers: int

    def whiten(self, rows: Real, record: Record) -> Real:
        """Return what is new in rows (n, r, ...), in deviations."""
        shape = (-1, *[1] * (rows.ndim - 2))
        lasting = self.lasting.reshape(shape)
        new = rows.copy()
        follows = record.follows
        new[1:][follows[1:]] -= (lasting * rows[:-1])[follows[1:]]
        new[~follows] *= np.sqrt(1 - lasting**2)
        return np.asarray(new / self.sigma.reshape(shape))


@dataclass(frozen=True, eq=False)
class Fit:
    """A motion that was fitted to a record.

    Attributes
    ----------
    model : Model
    x : ndarray (p,)
    noise : Noise
    others : tuple of ndarray (p,)
        Other motions that fit as well.
    """

    model: Model
    x: Real
    noise: Noise
    others: tuple[Real, ...] = field(default=())

    @cached_property
    def residuals(self) -> Real:
        """Residuals (n, r) of all rows."""
        return self.model.find_residuals(self.x)

    @cached_property
    def white(self) -> Real:
        """Residuals of the kept rows, whitened, in deviations."""
        return self.noise.whiten(self.residuals, self.model.record)[self.noise.kept]

    @cached_property
    def columns(self) -> Real:
        """Derivatives of these, (n, r, p)."""
        slopes = self.model.find_jacobian(self.x, central=True)
        return self.noise.whiten(slopes, self.model.record)[self.noise.kept]

    @cached_property
    def remainder(self) -> Remainder:
        """The whitened residuals, for the tests of noise."""
        return Remainder((self.white, self.white), self.model.record.seconds)

    @cached_property
    def priors(self) -> Real:
        """Weights (p,) of what is known."""
        found = np.zeros(len(self.x))
        for name, (_, deviation) in self.model.record.known.items():
            if name in self.model.place:
                found[self.model.place[name]] = deviation**-2.0
        return found

    @cached_property
    def sizes(self) -> Real:
        """Root of the diagonal (p,) of Fisher's matrix."""
        return np.asarray(np.sqrt((self.columns**2).sum(axis=(0, 1)) + self.priors) + 1e-300)

    @cached_property
    def spectrum(self) -> tuple[Real, Real]:
        """Eigenvalues (p,), growing, and vectors of Fisher's matrix of parameters times sizes."""
        scaled = (self.columns / self.sizes).reshape(-1, len(self.x))
        normal = scaled.T @ scaled + np.diag(self.priors / self.sizes**2)
        values, vectors = np.linalg.eigh(normal)
        return np.maximum(values, NULL * values[-1]), vectors

    @cached_property
    def covariance(self) -> Real:
        """Covariance (p, p) of the parameters, if the noise is white."""
        values, vectors = self.spectrum
        return np.asarray((vectors / values) @ vectors.T / np.outer(self.sizes, self.sizes))

    @cached_property
    def _influences(self) -> Real:
        scores = np.einsum("tij,ti->tj", self.columns, self.white)
        return np.asarray(scores @ self.covariance)

    def find_deviation(self, slope: Real) -> float:
        """Return the deviation of a combination (p,) of parameters, for noise of any correlation."""
        free = self.remainder.independent
        robust = sum_influences(self._influences @ slope, len(self.x), free)
        by_known = float((self.covariance @ slope) ** 2 @ self.priors)
        return float(np.sqrt(robust + by_known))


def refine(model: Model, x: Real) -> Fit:
    """Return the fit with the weights of its own noise, from a motion that is near it."""
    noise = None
    for number in range(ROUNDS):
        noise = find_noise(model, x, lasts=number > 0)
        moved, x = x, fit_weighted(model, x, noise)
        if number > 1 and (np.abs(x - moved) < SETTLED * model.find_scales(x)).all():
            break
    return Fit(model, x, find_noise(model, x, lasts=True))


def fit_weighted(model: Model, x: Real, noise: Noise) -> Real:
    """Return the least squares of whitened residuals."""
    record = model.record

    def find(x: Real) -> Real:
        return noise.whiten(model.find_residuals(x), record)[noise.kept]

    def derive(x: Real) -> Real:
        return noise.whiten(model.find_jacobian(x), record)[noise.kept]

    return minimise(model, x, find, derive, "linear", 60).x


def find_noise(model: Model, x: Real, lasts: bool) -> Noise:
    """Return outliers, correlation and size of what parameters leave."""
    record, left = model.record, model.find_residuals(x)
    good = (np.abs(left) < OUTLIER * find_spread(left)).all(axis=1)
    outliers = int((~good).sum())
    pairs = good[1:] & good[:-1] & record.follows[1:]
    lasting = np.zeros(left.shape[1])
    if lasts and outliers < MANY * len(record) and pairs.any():
        lasting = find_lasting(left, pairs, good)
    is_kept = good & np.append(True, good[:-1] | ~record.follows[1:]) if lasting.any() else good
    if not is_kept.any():
        is_kept = np.ones(len(record), dtype=bool)
    new = Noise(is_kept, np.ones(len(lasting)), lasting, outliers).whiten(left, record)
    free = max(int(is_kept.sum()) - len(x) / left.shape[1], 1.0)
    sigma = np.sqrt((new[is_kept] ** 2).sum(axis=0) / free) + 1e-300
    return Noise(is_kept, sigma, lasting, outliers)


def find_lasting(left: Real, pairs: Mask, good: Mask) -> Real:
    """Return the correlation of neighbours in each column; zero where it may be chance.

    On average it is found too small (Kendall 1954).
    """
    count = len(left)
    products = (left[1:] * left[:-1] * pairs[:, np.newaxis]).sum(axis=0)
    found = products / np.maximum((left**2 * good[:, np.newaxis]).sum(axis=0), 1e-300)
    raised = np.minimum(found + (1 + 3 * found) / count, MOST_LASTING)
    return np.where(found > LASTS / np.sqrt(count), raised, 0.0)
