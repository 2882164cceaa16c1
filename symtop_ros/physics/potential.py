"""The effective potential and the cubic f(u): where a motion is allowed, from its constants.

Torque and accelerations say how a motion begins. Its constants say between which angles it stays:
theta where E' >= U_eff(theta), or u = cos(theta) where f(u) >= 0 (Goldstein, Classical Mechanics,
section 5.7).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.base.deprecation import OldName
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import validate_array, validate_number, validate_one


@dataclass(frozen=True, slots=True)
class EffectivePotential:
    """The effective potential in which theta moves like a point mass.

    Attributes
    ----------
    top : Top
    vertical_momentum, axial_momentum : float
        p_phi = L_z' and p_psi = L_z in N m s.
    energy : float
        E' = E - p_psi^2/(2 Iz) in J: the energy without that of the spin, which is constant.

    Examples
    --------
    >>> from symtop_ros.physics import EffectivePotential, Motion, State, Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> start = State.from_euler(theta=0.5, psi_dot=200.0)
    >>> potential = EffectivePotential.from_state(top, start)
    >>> low, high = Motion(top, start).turning_angles
    >>> bool(abs(potential.at(high) - potential.energy) < 1e-15 * top.Mgl)
    True
    """

    top: Top[float]
    vertical_momentum: float
    axial_momentum: float
    energy: float

    of = OldName("from_state")

    @classmethod
    def from_state(cls, top: Top[float], state: State[float]) -> "EffectivePotential":
        """Return the potential for the constants of motion of one state."""
        validate_one(top)
        validate_one(state, "state")
        wx, wy, _ = state.angular_velocity.tolist()
        # Without the energy of the spin from the start: as a difference it would lose digits.
        energy = top.Ix * (wx * wx + wy * wy) / 2 + top.Mgl * float(state.vertical[2])
        momenta = float(top.vertical_momentum(state)), float(top.axial_momentum(state))
        return cls(top, *momenta, energy)

    @bindings.compute_soundly
    def at(self, theta: ArrayLike) -> Real:
        """Return U_eff = (p_phi - p_psi cos(theta))^2/(2 Ix sin^2(theta)) + Mgl cos(theta) in J.

        Parameters
        ----------
        theta : array_like (...)
            Tilt in rad. On the vertical the potential is infinite, or Mgl cos(theta) if
            p_phi = p_psi cos(theta) there.

        Examples
        --------
        >>> import math
        >>> from symtop_ros.physics import EffectivePotential, Top
        >>> potential = EffectivePotential(Top(2.0, 1.0, 3.0), 2.0, 0.0, 1.0)
        >>> potential.at([math.pi / 2, 0.0]).tolist()
        [1.0000000000000002, inf]
        """
        theta = validate_array("theta", theta, unit="rad")
        turning = self._rate(np.cos(theta), 2 * np.sin(theta / 2) ** 2)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            share = np.where(turning == 0, 0.0, turning / np.sin(theta))
            return np.asarray(self.top.Ix * share * share / 2 + self.top.Mgl * np.cos(theta))

    @bindings.compute_soundly
    def cubic(self, u: ArrayLike) -> Real:
        """Return f(u) = (1 - u^2)(alpha - beta u) - (b - a u)^2 = (du/dt)^2 in 1/s^2.

        Parameters
        ----------
        u : array_like (...)
            cos(theta). Beyond -1 and 1 it has no meaning, but the third root lies there.

        Examples
        --------
        >>> from symtop_ros.physics import EffectivePotential, Top
        >>> potential = EffectivePotential(Top(2.0, 1.0, 3.0), 2.0, 0.0, 1.0)
        >>> potential.cubic(0.0).item()
        0.0
        """
        u = validate_array("u", u)
        left = 2 * (self.energy - self.top.Mgl * u) / self.top.Ix  # alpha - beta u
        rate = self._rate(u, 1 - u)
        return np.asarray((1 - u) * (1 + u) * left - rate * rate)

    @bindings.compute_soundly
    def find_third_root(self, low: float, high: float) -> float:
        """Return the root of the cubic that is not the cosine of a turning angle.

        The sum of the roots is (alpha + a^2)/beta (Vieta); it is infinite for Mgl = 0.

        Parameters
        ----------
        low, high : float
            Turning angles in rad.

        Examples
        --------
        >>> import math
        >>> from symtop_ros.physics import EffectivePotential, Top
        >>> EffectivePotential(Top(2.0, 1.0, 3.0), 0.0, 0.0, 3.0).find_third_root(0.0, math.pi)
        1.0
        """
        low, high = validate_number("low", low, "rad"), validate_number("high", high, "rad")
        if self.top.Mgl == 0:
            return np.inf
        a = self.axial_momentum / self.top.Ix
        total = (self.energy + self.top.Ix * a * a / 2) / self.top.Mgl
        return float(total - np.cos(low) - np.cos(high))

    def _rate(self, u: Real, one_minus_u: Real) -> Real:
        """Return b - a u = sin^2(theta) phi' in rad/s.

        From b - a and 1 - u: near the upper pole both terms of b - a u would cancel.
        """
        b_minus_a = (self.vertical_momentum - self.axial_momentum) / self.top.Ix
        return np.asarray(b_minus_a + self.axial_momentum / self.top.Ix * one_minus_u)
