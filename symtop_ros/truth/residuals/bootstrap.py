"""The gain of a fit by chance, from a block bootstrap of its residuals.

Correlated errors are not independent, and a fit may follow them. Blocks of rows that are longer
than the correlation are drawn with replacement (Kuensch, The jackknife and the bootstrap for
general stationary observations, 1989), each with a sign by chance, and the fit is made again.
"""

import numpy as np

from symtop_ros.base.arrays import Real

DRAWS = 200
LENGTH = 2.0  # of a block, in rows for each independent one
FEWEST = 8  # blocks


def draw_gains(columns: Real, left: Real, independent: float) -> Real:
    """Return ratios (draws,): squares of noise that a fit explains, to squares that it leaves.

    Parameters
    ----------
    columns : ndarray (n, r, p)
        Derivatives of the rows by the parameters.
    left : ndarray (n, r)
        Residuals of the fit.
    independent : float
        Number of independent rows.

    Notes
    -----
    The fit has taken the share p/(r n) of the noise away; it is given back.
    """
    count, width, parameters = columns.shape
    basis = np.linalg.qr(columns.reshape(-1, parameters))[0].reshape(columns.shape)
    length = int(min(max(LENGTH * count / independent, 1), max(count // FEWEST, 1)))
    random = np.random.default_rng(0)
    blocks = -(-count // length)
    begins = random.integers(0, count - length + 1, (DRAWS, blocks))
    signs = random.choice((-1.0, 1.0), (DRAWS, blocks))
    places = (begins[:, :, np.newaxis] + np.arange(length)).reshape(DRAWS, -1)[:, :count]
    drawn = left[places] * np.repeat(signs, length, axis=1)[:, :count, np.newaxis]
    squares = (drawn**2).sum(axis=(1, 2))
    gains = (np.einsum("nrp,dnr->dp", basis, drawn) ** 2).sum(axis=1)
    free = max(independent * width, parameters + 1.0)
    return np.asarray(gains / np.maximum(squares - gains, 1e-300) * free / (free - parameters))
