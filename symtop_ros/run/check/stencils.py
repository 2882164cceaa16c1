"""First derivatives of samples by central differences of order 8, with a bound of their error.

The weights are those of the polynomial through the samples (Fornberg 1988, for any steps), so that
a grid of whole nanoseconds, or one that a machine was late for, costs no digits. The bound is taken
from the same samples: differences of order 8 err less than those of order 6, by a factor
0.22 (rate times step)^2 for each frequency of the motion, so that the two differ by about the
error of order 6. NumPy only.
"""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from symtop_ros.base.arrays import Real

EPS = float(np.finfo(float).eps)
REACH = 4  # samples on each side of the one at which the derivative is taken
WIDTH = 2 * REACH + 1
# Samples on each side among which the largest difference of both orders is taken: alone it may pass
# through 0 where the error does not.
AROUND = 8
# Of the values of the samples in EPS: attitudes have 20 and angular velocities 10 (library.md).
ROUNDING = 32


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives at the samples that have four others on each side."""

    values: Real  # (m, k)
    truncation: Real  # (m,), bound of the error of the polynomial
    rounding: Real  # (m,), bound of what the rounding of the samples makes of it


def find_slopes(times: Real, values: Real) -> Slopes:
    """Return the derivatives of samples.

    Parameters
    ----------
    times : ndarray (n,)
        In s, increasing; n >= 9.
    values : ndarray (n, k)

    Returns
    -------
    Slopes
        For the samples 4 to n - 5.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.array([0.0, 0.1, 0.21, 0.3, 0.4, 0.52, 0.6, 0.7, 0.8])
    >>> found = find_slopes(times, np.stack([np.sin(times), times**7], axis=1))
    >>> error = np.abs(found.values - [np.cos(0.4), 7 * 0.4**6]).max()
    >>> bool(error < found.truncation[0] < 1e-5)
    True
    """
    middle = times[REACH:-REACH, np.newaxis]
    nodes = sliding_window_view(times, WIDTH) - middle
    # Minus the middle one: the weights of a constant then add up to 0 exactly.
    steps = sliding_window_view(values, WIDTH, axis=0) - values[REACH:-REACH, :, np.newaxis]
    weights = _weigh(nodes)
    eighth = (steps * weights[:, np.newaxis]).sum(axis=-1)
    sixth = (steps[:, :, 1:-1] * _weigh(nodes[:, 1:-1])[:, np.newaxis]).sum(axis=-1)
    sizes = sliding_window_view(np.linalg.norm(values, axis=1), WIDTH).max(axis=-1)
    return Slopes(
        eighth,
        _spread(np.linalg.norm(eighth - sixth, axis=1)),
        2 * ROUNDING * EPS * np.abs(weights).sum(axis=-1) * sizes,
    )


def _weigh(nodes: Real) -> Real:
    """Return the weights (m, p) of the derivative at the middle one of some nodes, which is 0."""
    count = nodes.shape[1]
    others = [k for k in range(count) if k != count // 2]
    weights = np.zeros_like(nodes)
    for j in others:
        rest = nodes[:, [k for k in others if k != j]]
        mine = nodes[:, j : j + 1]
        weights[:, j] = (-rest / (mine - rest)).prod(axis=1) / mine[:, 0]
    return weights


def _spread(sizes: Real) -> Real:
    """Return the largest of the sizes (m,) around each."""
    padded = np.pad(sizes, AROUND)
    return np.asarray(sliding_window_view(padded, 2 * AROUND + 1).max(axis=-1))
