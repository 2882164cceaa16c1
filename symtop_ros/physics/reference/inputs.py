"""What a motion starts from, as exact fractions, and what it comes to, as numbers of mpmath."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from symtop_ros.physics.state import State
    from symtop_ros.physics.top import Top

Number = Any  # of mpmath: mpf or mpc


class ExactState(NamedTuple):
    """A state in numbers of mpmath.

    Attributes
    ----------
    orientation : tuple of mpf
        Unit quaternion (w, x, y, z), body to world.
    angular_velocity : tuple of mpf
        Angular velocity in the body frame, in rad/s.
    """

    orientation: tuple[Number, ...]
    angular_velocity: tuple[Number, ...]


class Inputs(NamedTuple):
    """A top and its start. A double is a fraction, so nothing is rounded here."""

    Ix: Fraction
    Iz: Fraction
    Mgl: Fraction
    orientation: tuple[Fraction, ...]  # of any norm but zero
    angular_velocity: tuple[Fraction, ...]

    @classmethod
    def of(cls, top: Top, start: State) -> Inputs:
        """Return the numbers that a top and a state were given."""
        q, omega = start.given_orientation, start.angular_velocity
        return cls.exact(*top.moments, q.tolist(), omega.tolist())

    @classmethod
    def exact(cls, Ix: Any, Iz: Any, Mgl: Any, orientation: Any, angular_velocity: Any) -> Inputs:
        """Return doubles, integers or fractions as fractions."""
        q, omega = (tuple(map(Fraction, each)) for each in (orientation, angular_velocity))
        return cls(Fraction(Ix), Fraction(Iz), Fraction(Mgl), q, omega)
