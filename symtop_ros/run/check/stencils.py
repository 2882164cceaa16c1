"""First derivatives of samples by central differences of order 8, with a bound of their error.

The weights are those of the polynomial through the samples (Fornberg 1988, for any steps), so that
a grid of whole nanoseconds, or one that a machine was late for, costs no digits. The bound is taken
from the same samples: the difference of orders 6 and 8 nearby. Order 8 errs less than order 6 by a
factor 0.22 (rate times step)^2 for each frequency, so that the bound holds up to 1.5 rad of each in
a step. If orders 4, 6 and 8 do not converge like a geometric series, there are higher frequencies,
such as harmonics of an oscillation, and no bound is known. NumPy only.
"""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from symtop_ros.base.arrays import Mask, Real

EPS = float(np.finfo(float).eps)
REACH = 4  # samples on each side of the one at which the derivative is taken
WIDTH = 2 * REACH + 1
# Samples on each side among which the largest difference of both orders is taken: a single
# difference may pass through 0 while the error does not, or may belong to a slow phase before a
# fast one.
AROUND = 4
MARGIN = REACH + AROUND  # samples at each end whose derivative has no bound
# Of the values of the samples in EPS: attitudes have 20 and angular velocities 10 (library.md).
ROUNDING = 32


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives at the samples that have eight others on each side."""

    values: Real  # (m, k)
    truncation: Real  # (m,), bound of the error of the polynomial, where the orders converge
    rounding: Real  # (m,), bound of what the rounding of the samples makes of it
    converges: Mask  # (m,), False if the samples are too far apart for the bound


def find_slopes(times: Real, values: Real) -> Slopes:
    """Return the derivatives of samples.

    Parameters
    ----------
    times : ndarray (n,)
        In s, increasing; n >= 17.
    values : ndarray (n, k)

    Returns
    -------
    Slopes
        For the samples 8 to n - 9.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.linspace(0.0, 1.6, 17)
    >>> found = find_slopes(times, np.sin(3 * times)[:, np.newaxis])
    >>> error = abs(found.values[0, 0] - 3 * np.cos(3 * times[8]))
    >>> bool(error < found.truncation[0] < 1e-4)
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
    fourth = (steps[:, :, 2:-2] * _weigh(nodes[:, 2:-2])[:, np.newaxis]).sum(axis=-1)
    last, before = (
        _spread(np.linalg.norm(each, axis=1)) for each in (eighth - sixth, sixth - fourth)
    )
    rounding = 2 * ROUNDING * EPS * np.abs(weights).sum(axis=-1) * sizes
    inner = slice(AROUND, -AROUND)
    eighth, rounding = eighth[inner], rounding[inner]
    return Slopes(eighth, last, rounding, (last <= before / 2) | (last <= rounding))


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
    """Return the largest of the sizes (m,) around each that has some on both sides."""
    return np.asarray(sliding_window_view(sizes, 2 * AROUND + 1).max(axis=-1))
