"""The top and its friction: moments of inertia, gravity, and what follows from a state."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from symtop_ros.arrays import Real, Vector
from symtop_ros.physics.state import State
from symtop_ros.physics.values import EPS, LARGEST_MOMENT, SMALLEST_MOMENT, refuse, validate_number


@dataclass(frozen=True, slots=True)
class Top:
    """A heavy symmetric top with a fixed pivot.

    Parameters
    ----------
    Ix : float
        Transverse moment of inertia about the pivot, in kg m^2; 1e-100 to 1e100.
    Iz : float
        Axial moment of inertia, in kg m^2; 1e-100 <= Iz <= 2 Ix, as for every rigid body.
    Mgl : float
        Weight times the distance of the centre of mass from the pivot, in J, at most 1e100 in size.
        It is positive if the centre of mass is on the +z side of the body; it may be negative or
        zero.

    Raises
    ------
    ValueError
        If a value is not a finite number or out of range.

    Examples
    --------
    >>> from symtop_ros.physics import Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> round(top.critical_spin, 2)
    137.68
    """

    Ix: float
    Iz: float
    Mgl: float

    def __post_init__(self) -> None:
        for name, unit in (("Ix", "kg m^2"), ("Iz", "kg m^2"), ("Mgl", "J")):
            object.__setattr__(self, name, validate_number(name, getattr(self, name), unit))
        if self.Ix <= 0:
            raise refuse("Ix", "> 0 kg m^2", self.Ix)
        if not 0 < self.Iz <= 2 * self.Ix:
            raise refuse("Iz", f"> 0 and <= 2 Ix = {2 * self.Ix:g} kg m^2", self.Iz)
        for name in ("Ix", "Iz"):
            if not SMALLEST_MOMENT <= getattr(self, name) <= LARGEST_MOMENT:
                condition = f"{SMALLEST_MOMENT:g} to {LARGEST_MOMENT:g} kg m^2"
                raise refuse(name, condition, getattr(self, name))
        if abs(self.Mgl) > LARGEST_MOMENT:
            raise refuse("Mgl", f"at most {LARGEST_MOMENT:g} J in size", self.Mgl)

    @property
    def moments(self) -> Vector:
        """(Ix, Iz, Mgl)."""
        return self.Ix, self.Iz, self.Mgl

    @property
    def critical_spin(self) -> float:
        """Smallest |omega_z| in rad/s at which sleeping upright is stable; 0 for Mgl <= 0.

        Sleeping upright is stable if and only if p_psi^2 >= 4 Ix Mgl (Goldstein, section 5.7).
        """
        return 2 * math.sqrt(self.Ix) * math.sqrt(max(self.Mgl, 0.0)) / self.Iz

    def sleeping_is_stable(self, state: State) -> bool:
        """Return True if an axis at rest on the vertical stays near it after a small kick.

        A centre of mass above the pivot needs p_psi^2 >= 4 Ix |Mgl|; below the pivot the axis is
        always stable.

        Parameters
        ----------
        state : State
            One state, with a vertical axis.
        """
        weight = self.Mgl if state.vertical[2] > 0 else -self.Mgl
        if weight <= 0:
            return True
        # Roots, not squares: those would overflow. The critical spin itself is stable, whichever
        # way its double is rounded.
        least = 2 * math.sqrt(self.Ix) * math.sqrt(weight)
        return abs(float(self.axial_momentum(state))) >= (1 - 8 * EPS) * least

    def body_angular_momentum(self, state: State) -> Real:
        """Return the angular momentum about the pivot in the body frame, (..., 3), in N m s."""
        return np.asarray(state.angular_velocity * [self.Ix, self.Ix, self.Iz])

    def angular_momentum(self, state: State) -> Real:
        """Return the angular momentum about the pivot in the world frame, (..., 3), in N m s."""
        return state.to_world(self.body_angular_momentum(state))

    def gravity_torque(self, state: State) -> Real:
        """Return the torque of gravity about the pivot in the world frame, (..., 3), in N m.

        It is Mgl sin(theta) (cos phi, sin phi, 0), along the line of nodes.
        """
        torque = np.zeros_like(state.angular_velocity)
        axis = state.to_world([0.0, 0.0, self.Mgl])
        torque[..., 0], torque[..., 1] = -axis[..., 1], axis[..., 0]
        return torque

    def energy(self, state: State) -> Any:
        """Return the kinetic and potential energy, (...), in J; the potential is Mgl cos(theta)."""
        omega = state.angular_velocity
        kinetic = (self.body_angular_momentum(state) * omega).sum(axis=-1) / 2
        return kinetic + self.Mgl * state.vertical[..., 2]

    def axial_momentum(self, state: State) -> Any:
        """Return L_z = p_psi = Iz omega_z, (...), in N m s; constant without friction."""
        return self.Iz * state.angular_velocity[..., 2]

    def vertical_momentum(self, state: State) -> Any:
        """Return L_z' = p_phi = L . z', (...), in N m s; constant without friction."""
        return (self.body_angular_momentum(state) * state.vertical).sum(axis=-1)


@dataclass(frozen=True, slots=True)
class Friction:
    """Friction in proportion to the angular velocity, at the pivot and in the air.

    The torque in the body frame is -axial omega_z along the axis and
    -transverse (omega_x, omega_y) across it. A friction is true if a coefficient is not zero.

    Parameters
    ----------
    axial, transverse : float
        Coefficients in N m s, >= 0.

    Raises
    ------
    ValueError
        If a coefficient is not a finite number >= 0.

    Examples
    --------
    >>> from symtop_ros.physics import Friction, State
    >>> Friction(axial=0.25, transverse=0.5).torque(State((1, 0, 0, 0), (1, 0, 8))).tolist()
    [-0.5, -0.0, -2.0]
    >>> bool(Friction())
    False
    """

    axial: float = 0.0
    transverse: float = 0.0

    def __post_init__(self) -> None:
        for name in ("axial", "transverse"):
            value = validate_number(f"friction.{name}", getattr(self, name), "N m s")
            if value < 0:
                raise refuse(f"friction.{name}", ">= 0 N m s", value)
            object.__setattr__(self, name, value)

    def __bool__(self) -> bool:
        """Return True if a coefficient is not zero."""
        return self.axial > 0 or self.transverse > 0

    def torque(self, state: State) -> Real:
        """Return the torque of friction in the body frame, (..., 3), in N m."""
        return np.asarray(
            state.angular_velocity * [-self.transverse, -self.transverse, -self.axial]
        )
