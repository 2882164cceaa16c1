"""The top: its moments of inertia, its gravity moment, and what follows from a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.state import State

Real = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Top:
    """A heavy symmetric top with a fixed pivot.

    Parameters
    ----------
    Ix : float
        Moment of inertia across the axis, about the pivot, in kg m^2; > 0.
    Iz : float
        Moment of inertia about the axis, in kg m^2; 0 < Iz <= 2 Ix, as for every rigid body.
    Mgl : float
        Weight times the distance of the centre of mass from the pivot, in J; positive where the
        centre of mass is on the +z side, negative or zero allowed.

    Raises
    ------
    ValueError
        With the name of the field, what it got and what is allowed.
    """

    Ix: float
    Iz: float
    Mgl: float

    def __post_init__(self) -> None:
        for name in ("Ix", "Iz", "Mgl"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int | float | np.number):
                msg = f"{name}: got {value!r}, allowed is a number"
                raise ValueError(msg)
            if not math.isfinite(value):
                msg = f"{name}: got {value}, allowed is a finite number"
                raise ValueError(msg)
            object.__setattr__(self, name, float(value))
        if self.Ix <= 0:
            msg = f"Ix: got {self.Ix:g}, allowed is Ix > 0 (kg m^2)"
            raise ValueError(msg)
        if not 0 < self.Iz <= 2 * self.Ix:
            msg = f"Iz: got {self.Iz:g}, allowed is 0 < Iz <= 2 Ix = {2 * self.Ix:g} (kg m^2)"
            raise ValueError(msg)

    @property
    def moments(self) -> tuple[float, float, float]:
        """(Ix, Iz, Mgl)."""
        return self.Ix, self.Iz, self.Mgl

    @property
    def critical_spin(self) -> float:
        """Smallest |omega_z| (rad/s) at which the upright sleeping top is stable; 0 if Mgl <= 0.

        Sleeping upright is stable iff p_psi^2 >= 4 Ix Mgl.
        """
        return 2 * math.sqrt(self.Ix) * math.sqrt(max(self.Mgl, 0.0)) / self.Iz

    def sleeping_is_stable(self, state: State) -> bool:
        """Whether an axis at rest on the vertical survives a small push.

        The weight above the pivot needs p_psi^2 >= 4 Ix Mgl (upright; hanging with -Mgl).
        """
        weight = self.Mgl if state.vertical[2] > 0 else -self.Mgl
        return float(self.axial_momentum(state)) ** 2 >= 4 * self.Ix * weight

    def body_angular_momentum(self, state: State) -> Real:
        """Angular momentum about the pivot in the body frame, (..., 3), N m s."""
        return np.asarray(state.angular_velocity * [self.Ix, self.Ix, self.Iz])

    def angular_momentum(self, state: State) -> Real:
        """Angular momentum about the pivot in the world frame, (..., 3), N m s."""
        return state.to_world(self.body_angular_momentum(state))

    def torque(self, state: State) -> Real:
        """Gravity's torque about the pivot in the world frame, (..., 3), N m.

        Mgl z' x axis, reversed: Mgl sin(theta) (cos phi, sin phi, 0), along the line of nodes.
        """
        torque = np.zeros_like(state.angular_velocity)
        axis = state.to_world([0.0, 0.0, self.Mgl])
        torque[..., 0], torque[..., 1] = -axis[..., 1], axis[..., 0]
        return torque

    def energy(self, state: State) -> Any:
        """Kinetic and potential energy, (...), J; the potential is Mgl cos(theta)."""
        omega = state.angular_velocity
        kinetic = (self.body_angular_momentum(state) * omega).sum(axis=-1) / 2
        return kinetic + self.Mgl * state.vertical[..., 2]

    def axial_momentum(self, state: State) -> Any:
        """L_z = p_psi = Iz omega_z, (...), N m s; constant without friction."""
        return self.Iz * state.angular_velocity[..., 2]

    def vertical_momentum(self, state: State) -> Any:
        """L_z' = p_phi = L . z', (...), N m s; constant without friction."""
        return (self.body_angular_momentum(state) * state.vertical).sum(axis=-1)
