"""A state to many digits."""

from typing import Any, NamedTuple

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
