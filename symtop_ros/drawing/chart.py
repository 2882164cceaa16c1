"""Charts of the effective potential and of the cubic f(u): a box, and what is placed in it."""

from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import EffectivePotential, Motion

WIDTH, HEIGHT = 2.0, 1.0  # of the box in scene units; y points down
TILTS = np.linspace(1e-4, np.pi - 1e-4, 4001)
# The height above the energy line up to which the curve is drawn: in depths of the well, and at
# least this share of Mgl, for regular precession has no depth.
ABOVE, LEAST = 1.0, 0.02


@dataclass(frozen=True, slots=True)
class Chart:
    """A box of the scene that shows a range of x and of y."""

    # smallest and largest x, then smallest and largest y
    left: float
    right: float
    bottom: float
    top: float

    def place(self, x: Real | float, y: Real | float) -> Real:
        """Return points (n, 2) of the scene; what lies outside is moved to the edge."""
        across = (np.asarray(x, dtype=float) - self.left) / (self.right - self.left)
        up = (np.asarray(y, dtype=float) - self.bottom) / (self.top - self.bottom)
        points = np.broadcast_arrays(WIDTH * across.clip(0, 1), -HEIGHT * up.clip(0, 1))
        return np.stack(points, axis=-1)

    def cut(self, x: Real, y: Real) -> list[Real]:
        """Return the parts of a curve that lie inside, as strips of the scene."""
        inside = (x >= self.left) & (x <= self.right) & (y >= self.bottom) & (y <= self.top)
        borders = np.flatnonzero(np.diff(inside)) + 1
        parts = np.split(np.arange(len(x)), borders)
        return [self.place(x[part], y[part]) for part in parts if inside[part[0]] and len(part) > 1]

    def frame(self) -> Real:
        """Return the edges of the box."""
        return np.array([(0, -HEIGHT), (0, 0), (WIDTH, 0)], dtype=float)


def frame_potential(motion: Motion, potential: EffectivePotential) -> Chart:
    """Return the box for the potential of a motion: the well, and what is near it."""
    low, high = motion.turning_angles
    heights = potential.at(TILTS)
    bottom = float(min(heights.min(), potential.energy))
    depth = potential.energy - bottom
    top = potential.energy + max(ABOVE * depth, LEAST * max(abs(motion.top.Mgl), abs(depth), 1e-12))
    near = TILTS[heights <= top]
    left, right = (near.min(), near.max()) if len(near) else (low, high)
    margin = 0.04 * max(right - left, 0.1)
    return Chart(
        max(0.0, min(left, low) - margin),
        min(np.pi, max(right, high) + margin),
        bottom - 0.08 * (top - bottom),
        top,
    )


def frame_cubic(motion: Motion, potential: EffectivePotential) -> Chart:
    """Return the box for the cubic: all heights u, and the third root if it is near."""
    u2, u1 = (float(np.cos(angle)) for angle in motion.turning_angles)
    third = potential.find_third_root(*motion.turning_angles)
    largest = float(potential.cubic(np.linspace(u1, u2, 101)).max())
    size = max(largest, 1e-3 * float(np.abs(potential.cubic(np.linspace(-1, 1, 101))).max()), 1e-12)
    ends = [-1.0, 1.0, third] if abs(third) < 3 else [-1.0, 1.0]
    return Chart(min(ends) - 0.1, max(ends) + 0.1, -size, 1.4 * size)
