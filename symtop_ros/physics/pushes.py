"""A series of equal pushes on the axle.

The kernel computes their times, and the motion between them (`kernel/functions/pushes.hpp`).
"""

import math
from dataclasses import astuple, dataclass
from struct import pack

from symtop_ros.base.refusals import refuse, require
from symtop_ros.physics.times import SECOND
from symtop_ros.physics.values import validate_number

MOST_PUSHES = 1000  # of a series
PUSH_RATES = (0.01, 1000.0)  # per s


@dataclass(frozen=True)
class Pushes:
    """Horizontal pushes on the axle, each in the direction of increasing phi at its time.

    The first one is at t = 0. The others are at multiples of 1/rate, rounded to whole nanoseconds.

    Parameters
    ----------
    impulse : float
        Angular impulse of each push in N m s, as in `push_axle`.
    rate : float
        Pushes in a second, 0.01 to 1000.
    number : int
        Number of pushes, including the first one; 1 to 1000.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, Pushes, State, Top, push_axle
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> start = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
    >>> pushes = Pushes(impulse=0.00005, rate=20.0, number=20)
    >>> pushed = Motion(top, push_axle(top, start, pushes.impulse), pushes=pushes)
    >>> low, high = pushed.piece_at(1.0).motion.turning_angles
    >>> round(low, 3), round(high, 3)
    (0.384, 0.397)
    """

    impulse: float
    rate: float
    number: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "impulse", validate_number("impulse", self.impulse, "N m s"))
        object.__setattr__(self, "rate", validate_number("rate", self.rate, "1/s"))
        slowest, fastest = PUSH_RATES
        is_within = slowest <= self.rate <= fastest
        require(is_within, "rate", f"{slowest:g} to {fastest:g} 1/s", self.rate)
        number = validate_number("number", self.number)
        if not (number.is_integer() and 1 <= number <= MOST_PUSHES):
            raise refuse("number", f"a whole number of 1 to {MOST_PUSHES}", self.number)
        object.__setattr__(self, "number", int(number))

    @property
    def last_time(self) -> int:
        """Time from the first to the last push in ns, rounded as in the kernel."""
        return math.floor((self.number - 1) * float(SECOND) / self.rate + 0.5)

    @property
    def packed(self) -> bytes:
        """The numbers as bytes, in the layout of the kernel's struct `symtop_pushes`."""
        return pack("3d", *astuple(self))
