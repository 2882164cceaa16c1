"""Friction at the pivot and in the air, in proportion to the rates."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.state import State


@dataclass(frozen=True, slots=True)
class Friction:
    """Torque -axial omega_z on the axis and -transverse (omega_x, omega_y) across it.

    Parameters
    ----------
    axial, transverse : float
        In N m s, >= 0.

    Raises
    ------
    ValueError
        With the name of the field, what it got and what is allowed.
    """

    axial: float = 0.0
    transverse: float = 0.0

    def __post_init__(self) -> None:
        for name in ("axial", "transverse"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float | np.number):
                msg = f"friction.{name}: got {value!r}, allowed is a number"
                raise ValueError(msg)
            if not (math.isfinite(value) and value >= 0):
                msg = f"friction.{name}: got {value:g}, allowed is 0 or more (N m s)"
                raise ValueError(msg)
            object.__setattr__(self, name, float(value))

    def __bool__(self) -> bool:
        """Whether there is any."""
        return self.axial > 0 or self.transverse > 0

    def torque(self, state: State) -> NDArray[np.float64]:
        """Torque in the body frame, (..., 3), N m."""
        return np.asarray(
            state.angular_velocity * [-self.transverse, -self.transverse, -self.axial]
        )
