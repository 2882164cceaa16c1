"""A motion in the kernel: its states and its constant properties."""

from fractions import Fraction
from typing import Any, get_args

import numpy as np

from symtop_ros.arrays import Quaternion, Real, Vector
from symtop_ros.physics.exact.kind import Kind, Rates
from symtop_ros.physics.times import ExactTimes, refuse_too_fast, to_rough_seconds
from symtop_ros.physics.top import Friction

# States and steps in one call of the kernel, some ms: Python sees signals, such as Ctrl-C, between
# two calls.
STATES, STEPS = 2**16, 256.0
KINDS: tuple[Kind, ...] = get_args(Kind)  # in the order of `symtop_kind`
TOO_FAR, TOO_FAST = 8, 9  # of `symtop_status`
# Of a factor and of the parts of an elapsed time, in `symtop_clock`.
SMALLEST, LARGEST, PARTS = 1e-100, 1e100, 4

Clock = tuple[float, tuple[float, ...]]


class CompiledMotion:
    """A motion as the kernel computes it: under gravity bit for bit as Python does.

    Times of more than 1e15 turns are not served: their phases need the digits of Python's numbers.
    Driven motions are computed in sums of two doubles, with the same bits everywhere.
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
        """Write the states at times (n,), up to the first that is too far; return their number.

        The times of a driven motion are sorted from the start on, in one direction.
        """
        first = 0
        while first < len(orientation):
            part = slice(first, first + STATES)
            written, status = self._fill_part(times[part], orientation[part], omega[part])
            first += written
            if status == TOO_FAR:
                break
            if status == TOO_FAST:
                t = float(to_rough_seconds(times)[first])
                raise refuse_too_fast(t, self.reach(t, 0))
        return first

    def _fill_part(
        self, times: Real | ExactTimes, orientation: Real, omega: Real
    ) -> tuple[int, int]:
        """Write the states at times (n,) in one call; return how many, and the kernel's status."""
        result: tuple[int, int] = (0, TOO_FAR)
        if not isinstance(times, ExactTimes):
            result = self._motion.fill(times, orientation, omega, STEPS)
        elif clock := _find_clock(times):
            stamps = times.nanoseconds
            result = self._motion.fill_stamps(stamps, clock, orientation, omega, STEPS)
        return result

    def compute_states(self, times: Real | ExactTimes) -> tuple[Real, Real]:
        """Return orientations (n, 4) and angular velocities (n, 3) of a driven motion."""
        count = times.shape[0]
        orientation, omega = np.empty((count, 4)), np.empty((count, 3))
        if self.fill(times, orientation, omega) < count and isinstance(times, ExactTimes):
            self.fill(times.seconds, orientation, omega)  # the elapsed time has too many digits
        return orientation, omega

    def reach(self, t: float, steps: float) -> float:
        """Integrate towards a time in a limited number of steps, or to where it is too fast."""
        while True:
            reached, status = self._motion.reach(t, min(steps, STEPS))
            steps -= STEPS
            if status == TOO_FAST or reached == t or steps <= 0:
                return float(reached)

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
