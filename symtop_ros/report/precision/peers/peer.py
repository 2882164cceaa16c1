"""What all that is measured have in common."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Friction, State, Top

Real = NDArray[np.float64]
Solve = Callable[[float], Real]  # t in s -> orientation (w, x, y, z), from the start each time
TOLERANCES = tuple(10.0**-k for k in range(4, 14))


@dataclass(frozen=True)
class Task:
    """A top that starts moving at t = 0."""

    top: Top
    start: State
    friction: Friction


@dataclass(frozen=True)
class Peer:
    """A way to compute a motion.

    Attributes
    ----------
    name : str
        As in tables and plots.
    settings : tuple of float
        Tolerances, or steps in s, from coarse to fine; the package's own engines have one.
    prepare : callable
        Builds a model for a task and a setting: compiling and loading are done here.
    friction : {"no", "also", "only"}
        Whether its model has friction along and across the axis.
    """

    name: str
    settings: tuple[float, ...]
    prepare: Callable[[Task, float], Solve]
    friction: Literal["no", "also", "only"] = "no"


def steps(t: float, step: float) -> int:
    """Return the number of steps to t; times are multiples of them."""
    return round(t / step)


def start_of(task: Task) -> list[float]:
    """Orientation (w, x, y, z) and body angular velocity at the start, seven numbers."""
    return [*task.start.orientation.tolist(), *task.start.angular_velocity.tolist()]
