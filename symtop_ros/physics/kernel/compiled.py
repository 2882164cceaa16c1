"""A motion in the kernel: its states and its constant properties."""

from fractions import Fraction
from typing import Any, get_args

from symtop_ros.arrays import Quaternion, Real, Vector
from symtop_ros.physics.exact.kind import Kind, Rates
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction

# States in one call of the kernel, some ms: Python sees signals, such as Ctrl-C, between two calls.
STATES = 2**16
KINDS: tuple[Kind, ...] = get_args(Kind)  # in the order of `symtop_kind`
TOO_FAST = 9  # of `symtop_status`
# Of a factor and of the parts of an elapsed time, in `symtop_clock`.
SMALLEST, LARGEST, PARTS = 1e-100, 1e100, 4

Clock = tuple[float, tuple[float, ...]]


class CompiledMotion:
    """A motion as the kernel computes it, bit for bit as Python does.

    Times of more than 1e15 turns are not served: their phases need the digits of Python's numbers.
    """

    def __init__(
        self,
        kernel: Any,
        moments: Vector,
        orientation: Quaternion,
        omega: Vector,
        friction: Friction,
        torque: Vector,
    ) -> None:
        coefficients = friction.axial, friction.transverse
        self._motion = kernel.Motion(moments, orientation, omega, coefficients, torque)

    def at(self, t: float) -> tuple[float, ...] | None:
        """Return quaternion and angular velocity at a time in s, or None if it is too far."""
        state: tuple[float, ...] | None = self._motion.at(t)
        return state

    def fill(self, times: Real | ExactTimes, orientation: Real, omega: Real) -> int:
        """Write the states under gravity at times (n,), up to the first that is too far.

        Returns the number of states written.
        """
        for first in range(0, len(orientation), STATES):
            part = slice(first, first + STATES)
            some = times.select(part) if isinstance(times, ExactTimes) else times[part]
            written, _ = self.fill_some(some, orientation[part], omega[part], 0.0)
            if written < len(orientation[part]):
                return first + written
        return len(orientation)

    def fill_some(
        self, times: Real | ExactTimes, orientation: Real, omega: Real, most_steps: float
    ) -> tuple[int, int]:
        """Write the states at times (n,) in one call; return how many, and the kernel's status."""
        result: tuple[int, int] = (0, 0)
        if not isinstance(times, ExactTimes):
            result = self._motion.fill(times, orientation, omega, most_steps)
        elif clock := _find_clock(times):
            result = self._motion.fill_stamps(
                times.nanoseconds, clock, orientation, omega, most_steps
            )
        return result

    def reach(self, t: float, most_steps: float) -> tuple[float, bool]:
        """Integrate towards a time in s; return the time reached, and if it is too fast there."""
        reached, status = self._motion.reach(t, most_steps)
        return reached, status == TOO_FAST

    @property
    def kind(self) -> Kind:
        """Name of the motion."""
        code: int = self._motion.kind()
        return KINDS[code]

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        smallest, largest = self._motion.turning_angles()
        return smallest, largest

    @property
    def rates(self) -> Rates:
        """Nutation period, mean rates, and whether the spin reverses."""
        period, precession, spin, turns, reverses = self._motion.rates()
        return Rates(period, precession, spin, turns, bool(reverses))


def _find_clock(times: ExactTimes) -> Clock | None:
    """Return factor and elapsed time as doubles, or None if these are too many or too large."""
    parts, left = [0.0] * PARTS, times.elapsed
    for place in range(PARTS):
        if not left:
            break
        parts[place] = float(left)
        left -= Fraction(parts[place])
    numbers = (times.factor, *parts)
    if left or any(each and not SMALLEST <= abs(each) <= LARGEST for each in numbers):
        return None
    return times.factor, tuple(parts)
