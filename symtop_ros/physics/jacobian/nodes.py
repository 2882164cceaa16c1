"""Derivatives by differences: the weights of values at unequally distant nodes, and what they lack.

Nodes are counted in steps from the middle. A step that turns a phase by whole turns moves it to
where it was: at equally distant nodes a fast oscillation may look smooth, or like nothing. No step
does so at all of these nodes.
"""

import numpy as np

from symtop_ros.base.arrays import Real

ORDER = 10  # of the derivatives, and as many nodes
PAIRS = (1.0, 2.13, 2.88, 4.07, 5.0)
# In steps, from the nearest: on both sides of 0, and on one.
CENTRAL = np.array([sign * node for node in PAIRS for sign in (1, -1)])
FORWARD = np.array((*PAIRS, 6.11, 6.93, 8.05, 9.12, 10.0))
FARTHEST_OF_PAIRS = 6  # steps, with some to spare
TINY = 1e-300  # added to divisors that may be zero


def weigh(nodes: Real, count: int) -> Real:
    """Return weights of the derivatives at 0 by the first nodes of each row, (c, 10).

    They are those of values less the one at 0.
    """
    near = nodes[:, :count]
    ratios = near[:, None] / (near[:, None] - near[:, :, None] + np.diag(near[0]))
    ratios[:, range(count), range(count)] = 1
    weights = np.zeros_like(nodes)
    weights[:, :count] = ratios.prod(axis=2) / near
    return weights


def weigh_difference(nodes: Real) -> Real:
    """Return weights of the tenth difference, in which all that is smooth cancels, (c, 10).

    The rest is rounding, as large as that of a value.
    """
    distances = nodes[:, :, None] - nodes[:, None]
    distances[:, range(ORDER), range(ORDER)] = nodes
    weights = 1 / distances.prod(axis=2)
    return np.asarray(weights / measure_rounding(weights)[:, None])


def measure_rounding(weights: Real) -> Real:
    """Return the rounding of a sum in units of that of a value; the one at 0 is rounded, too."""
    return np.asarray(np.sqrt(np.square(weights).sum(axis=1) + weights.sum(axis=1) ** 2))


def find_curvature(tenth: Real, eighth: Real, sixth: Real) -> Real:
    """Return about twice the error of derivatives of the tenth order by what they leave out.

    The differences between the orders fall by the same factor from each to the next.
    """
    near, far = np.abs(tenth - eighth), np.abs(eighth - sixth)
    return np.asarray(2 * near * (near / np.maximum(np.maximum(far, near), TINY)))
