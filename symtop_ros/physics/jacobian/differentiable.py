"""The protocol of a motion that can be differentiated."""

from typing import Protocol

from symtop_ros.base.arrays import Real, Vector
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction, Top


class Differentiable(Protocol):
    """A motion, as `Motion` is one."""

    @property
    def top(self) -> Top:
        """The top."""

    @property
    def start(self) -> State:
        """The state at t = 0."""

    @property
    def friction(self) -> Friction:
        """Friction."""

    @property
    def applied_torque(self) -> Vector:
        """Torque in N m, world frame."""

    @property
    def is_driven(self) -> bool:
        """True if friction or an applied torque acts."""

    @property
    def _packed_start(self) -> bytes:
        """The start as the kernel takes it."""

    @property
    def turning_angles(self) -> tuple[float, float]:
        """The smallest and the largest theta in rad."""

    def at(self, t: Real | ExactTimes) -> State:
        """Return the states at times."""
