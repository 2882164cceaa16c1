"""Least squares with the estimated noise: outliers, correlation and deviations.

The weights are those of the noise of each column. Correlated noise is modelled as an
autoregression, of the order that Hannan and Quinn's criterion chooses, because flicker, for
example, has another power at the frequency of the nutation than on average. Noise of any other
correlation is left to the sandwich of `truth/residuals`.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Real
from symtop_ros.truth.fit.model import Model
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.search import minimise
from symtop_ros.truth.residuals.influence import sum_influences
from symtop_ros.truth.residuals.residuals import Residuals
from symtop_ros.truth.residuals.spread import find_spread
from symtop_ros.truth.residuals.whitening import Noise, find_pacf, measure_noise

OUTLIER = 5.0  # deviations; a normal number is farther once in two million
ROUNDS = 8  # of weights and least squares
SETTLED = 1e-3  # of the deviations and correlations of noise
PRECISE = 1e-7  # of the sum of squares: a hundredth of a deviation of a parameter
FIXED = 12.0  # deviations of rounding: a column within about three steps (one step has 3.5)
DOUBLE = 1e-14  # smallest deviation, relative to the values: exact states leave rounding errors
LONG = 1e4  # rad, of the fastest phase in a record
# rounding errors count as noise if the part of them that is not averaged out is smaller
SLIGHT = 1e-3
PLACES = 16  # of the steps of rounding, from one to the next
NULL = 1e-16  # of the largest eigenvalue, to which a smaller one is raised


@dataclass(frozen=True, eq=False)
class Fit:
    """A motion that was fitted to a record.

    Attributes
    ----------
    model : Model
    x : ndarray (p,)
    noise : Noise
    others : tuple of Fit
        Other motions that fit as well.
    is_lone : bool
        True if only one of all searches found this motion, and its residuals are correlated.
    has_mirror : bool
        For a near camera, True if a camera below the pivot, with -p_psi, fits the record as well.
    """

    model: Model
    x: Real
    noise: Noise
    others: tuple["Fit", ...] = field(default=())
    is_lone: bool = False
    has_mirror: bool = False

    @cached_property
    def residuals(self) -> Real:
        """Residuals (n, r) of all rows."""
        return self.model.find_residuals(self.x)

    @cached_property
    def white(self) -> Real:
        """Residuals of the kept rows, whitened, in deviations."""
        return self.noise.whiten(self.residuals)

    @cached_property
    def columns(self) -> Real:
        """Derivatives (n, r, p) of the whitened residuals."""
        slopes = self.model.find_jacobian(self.x, central=True)
        return self.noise.whiten(slopes)

    @cached_property
    def remainder(self) -> Residuals:
        """The whitened residuals, for the tests of noise."""
        return Residuals((self.white, self.white), self.model.record.seconds)

    @cached_property
    def priors(self) -> Real:
        """Weights (p,) of parameters that are known beforehand."""
        found = np.zeros(len(self.x))
        for name, (_, deviation) in self.model.record.known.items():
            if name in self.model.place:
                found[self.model.place[name]] = deviation**-2.0
        return found

    @cached_property
    def sizes(self) -> Real:
        """Root of the diagonal (p,) of Fisher's matrix."""
        return find_sizes(self.columns, self.priors)

    @cached_property
    def spectrum(self) -> tuple[Real, Real]:
        """Eigenvalues (p,), growing, and vectors of Fisher's matrix of parameters times sizes."""
        return find_spectrum(self.columns, self.priors, self.sizes)

    @cached_property
    def covariance(self) -> Real:
        """Covariance (p, p) of the parameters, if the noise is white."""
        values, vectors = self.spectrum
        return np.asarray((vectors / values) @ vectors.T / np.outer(self.sizes, self.sizes))

    @cached_property
    def _influences(self) -> Real:
        scores = np.einsum("tij,ti->tj", self.columns, self.white)
        return np.asarray(scores @ self.covariance)

    @cached_property
    def _shifts(self) -> Real:
        """Changes (k, r, p) of the parameters if each column is rounded, for k places of the steps.

        In a slow motion, rounding errors are no noise: if a number stays within its last decimal,
        all rows have the same error. So the motion that was found is rounded, with steps at several
        places, because where they are is chance. Noise makes rounding errors independent: their
        mean is smaller by at least the factor exp(-2 (pi sigma/step)^2) (Widrow and Kollar,
        Quantization Noise, 2008).
        """
        rounding, fixed = find_rounding(self.model.record, self.white.shape[1])
        steps = np.where(rounding, np.sqrt(12) * rounding, np.inf)
        left = (self.residuals[self.noise.kept] ** 2).mean(axis=0)
        noise = np.where(fixed, 0.0, np.maximum(left - rounding**2, 0.0))
        stays = np.exp(-2 * np.pi**2 * noise / steps**2)
        sizes = np.where(rounding * (stays > SLIGHT), steps * stays, 0.0)
        if not sizes.any():
            return np.zeros((1, *self.columns.shape[1:]))
        places = self.model.show(self.x[np.newaxis])[0] / steps
        found = []
        for place in places + (np.arange(PLACES) + 0.5)[:, np.newaxis, np.newaxis] / PLACES:
            white = self.noise.whiten(sizes * (np.round(place) - place))
            found.append(np.einsum("tip,ti->ip", self.columns, white) @ self.covariance)
        return np.array(found)

    def find_deviation(self, slope: Real) -> float:
        """Return the deviation of a combination (p,), also for noise that is correlated."""
        free = self.remainder.independent
        robust = sum_influences(self._influences @ slope, len(self.x), free)
        by_known = float((self.covariance @ slope) ** 2 @ self.priors)
        by_rounding = float(((self._shifts @ slope) ** 2).mean(axis=0).sum())
        # the few slow swings of a record may happen to be small
        white = float(slope @ self.covariance @ slope)
        return float(np.sqrt(max(robust + by_known, white, by_rounding)))


def find_sizes(columns: Real, priors: Real) -> Real:
    """Return the root of the diagonal (p,) of Fisher's matrix of whitened derivatives (n, r, p)."""
    return np.asarray(np.sqrt((columns**2).sum(axis=(0, 1)) + priors) + 1e-300)


def find_spectrum(columns: Real, priors: Real, sizes: Real) -> tuple[Real, Real]:
    """Return eigenvalues (p,), growing, and vectors of Fisher's matrix in these sizes."""
    scaled = (columns / sizes).reshape(-1, len(sizes))
    normal = scaled.T @ scaled + np.diag(priors / sizes**2)
    values, vectors = np.linalg.eigh(normal)
    return np.maximum(values, NULL * values[-1]), vectors


def refine(model: Model, x: Real) -> Fit:
    """Return the least squares near a motion, weighted by the noise of its residuals."""
    noise = find_noise(model, x, lasts=False)
    for _ in range(ROUNDS):
        x = fit_weighted(model, x, noise)
        before, noise = noise, find_noise(model, x, lasts=True)
        if is_settled(before, noise):
            break
    return Fit(model, x, noise)


def is_settled(before: Noise, noise: Noise) -> bool:
    """Return True if two rounds found the same noise."""
    return (
        before.partial.shape == noise.partial.shape
        and bool((before.kept == noise.kept).all())
        and np.allclose(before.sigma, noise.sigma, rtol=SETTLED, atol=0.0)
        and np.allclose(before.partial, noise.partial, rtol=0.0, atol=SETTLED)
    )


def fit_weighted(model: Model, x: Real, noise: Noise) -> Real:
    """Return the least squares of whitened residuals."""

    def find(x: Real) -> Real:
        return noise.whiten(model.find_residuals(x))

    def derive(x: Real) -> Real:
        return noise.whiten(model.find_jacobian(x, central=is_long))

    # After many turns phases are known so much better than all else that forward differences would
    # lead along the valley by chance.
    is_long = model.find_phase(x) > LONG
    return minimise(model, x, find, derive, "linear", 60, PRECISE).x


def find_noise(model: Model, x: Real, lasts: bool) -> Noise:
    """Return the outliers, the correlation and the size of the residuals of parameters."""
    record, left = model.record, model.find_residuals(x)
    rounding, fixed = find_rounding(record, left.shape[1])
    least = np.maximum(rounding, DOUBLE * np.abs(record.values).max())
    floor = np.maximum(find_spread(left), least)
    good = np.asarray((np.abs(left) < OUTLIER * floor).all(axis=1))
    good |= not good.any()
    partial = np.zeros((0, left.shape[1]))
    if lasts:
        partial = np.where(fixed, 0.0, find_pacf(left, good, record.follows, len(x)))
    noise = measure_noise(left, good, record.follows, partial, len(x))
    sigma = np.maximum(noise.sigma, least)
    return replace(noise, sigma=np.where(fixed, sigma * np.sqrt(noise.kept.sum()), sigma))


def find_rounding(record: Record, width: int) -> tuple[Real, Mask]:
    """Return the deviation (r,) of rounding, and True (r,) for columns within a few steps of it.

    All rows of such a column have the same error, so they count as one row.
    """
    rounding = record.rounding
    if len(rounding) != width:  # residuals of attitudes are no differences of columns
        return np.zeros(width), np.zeros(width, dtype=bool)
    return rounding, np.ptp(record.values, axis=0) < FIXED * rounding
