"""Means of the derivatives that several steps have given."""

from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics.jacobian.differences import Difference
from symtop_ros.physics.jacobian.nodes import TINY

LEAST_ERROR = 1e-140  # whose square has an inverse


class Estimates:
    """Means of derivatives by several steps, (n, 2, 3, 9), and their errors.

    Each estimate counts by the inverse square of its error: next to the vertical no one step suits
    the phases and the small tilt. Where two contradict each other the shorter step is right.
    """

    def __init__(self, count: int) -> None:
        shape = count, 2, 3, 9
        self.derivatives, self._curved, self._rough, self._weights = np.zeros((4, *shape))
        self.errors, self._shortest = np.full((2, *shape), np.inf)

    def add(self, part: Any, steps: Real, new: Difference) -> None:
        """Add estimates with errors by curvature, which they share, and by rounding."""
        curved, rough = new.curved, new.rough
        changes = new.derivatives - self.derivatives[part]
        errors = curved + rough
        weights = 1 / np.square(np.maximum(errors, LEAST_ERROR))
        before = self._weights[part]
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
        self._shortest[part] = np.minimum(self._shortest[part], np.where(share > 0, steps, np.inf))
