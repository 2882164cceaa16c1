"""Derivatives by differences at unequally distant nodes, and their errors.

A step that turns a phase by whole turns moves it to where it was: at equally distant nodes a fast
oscillation may look smooth, or like nothing. No step does so at all of these nodes.
"""

from typing import Any

import numpy as np

from symtop_ros.arrays import Real

ORDER = 10  # of the derivatives, and as many nodes
PAIRS = (1.0, 2.13, 2.88, 4.07, 5.0)
# In steps, from the nearest: on both sides of 0, and on one.
CENTRAL = np.array([sign * node for node in PAIRS for sign in (1, -1)])
FORWARD = np.array((*PAIRS, 6.11, 6.93, 8.05, 9.12, 10.0))
TINY = 1e-300  # added to divisors that may be zero
LEAST_ERROR = 1e-140  # whose square has an inverse


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

    What is left is rounding, as large as that of a value.
    """
    distances = nodes[:, :, None] - nodes[:, None]
    distances[:, range(ORDER), range(ORDER)] = nodes
    weights = 1 / distances.prod(axis=2)
    return np.asarray(weights / measure(weights)[:, None])


def measure(weights: Real) -> Real:
    """Return the rounding of a sum in units of that of a value; the one at 0 is rounded, too."""
    return np.asarray(np.sqrt(np.square(weights).sum(axis=1) + weights.sum(axis=1) ** 2))


def find_curvature(tenth: Real, eighth: Real, sixth: Real) -> Real:
    """Return about twice the error of derivatives of the tenth order by what they leave out.

    The differences between the orders fall by the same factor from each to the next.
    """
    near, far = np.abs(tenth - eighth), np.abs(eighth - sixth)
    return np.asarray(2 * near * (near / np.maximum(np.maximum(far, near), TINY)))


class Estimates:
    """Means of derivatives by several steps, (n, 2, 3, 9), and their errors.

    Each estimate counts by the inverse square of its error: next to the vertical no one step suits
    the phases and the small tilt. Where two contradict each other the shorter step is right.
    """

    def __init__(self, count: int) -> None:
        shape = count, 2, 3, 9
        self.derivatives, self._curved, self._rough, self._weights = np.zeros((4, *shape))
        self.errors, self._shortest = np.full((2, *shape), np.inf)

    def add(self, part: Any, steps: Real, new: Real, curved: Real, rough: Real) -> None:
        """Add estimates with errors by curvature, which they share, and by rounding."""
        changes, errors = new - self.derivatives[part], curved + rough
        weights, before = 1 / np.square(np.maximum(errors, LEAST_ERROR)), self._weights[part]
        is_shorter = steps < self._shortest[part]
        differ = np.abs(changes) > 2 * (errors + self.errors[part])
        weights = np.where(differ & ~is_shorter, 0.0, weights)
        before = np.where(differ & is_shorter, 0.0, before)
        share = weights / np.maximum(weights + before, TINY)
        curved = np.where(share > 0, curved, 0.0)
        self.derivatives[part] += share * changes
        self._curved[part] += share * (curved - self._curved[part])
        self._rough[part] = np.hypot((1 - share) * self._rough[part], share * rough)
        self._weights[part] = weights + before
        means = self._curved[part] + self._rough[part]
        self.errors[part] = np.where(weights + before > 0, means, np.inf)
        shortest = np.where(share > 0, steps, np.inf)
        self._shortest[part] = np.minimum(self._shortest[part], shortest)
