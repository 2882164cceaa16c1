"""States under gravity from the kernel."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Quaternion, Real, Vector
from symtop_ros.physics.exact.phases import Phases
from symtop_ros.physics.times import ExactTimes

# States in one call of the kernel, some ms: Python sees signals, such as Ctrl-C, between two calls.
STATES = 2**16
AT_START = 2  # other times: 1 in the first instants, else 0

Attitude = tuple[float, float, float, float, float, float]


class CompiledMotion:
    """The states of a `ClosedFormMotion`, bit for bit.

    Times of more than 1e15 turns are not served: their phases need the digits of Python's numbers.
    Exact times are: Python's integers reduce their phases to one turn for the kernel.
    """

    def __init__(
        self,
        kernel: Any,
        arguments: tuple[Vector, Quaternion, Vector],
        is_turned_over: bool,
    ) -> None:
        self._motion = kernel.ClosedForm(*arguments, is_turned_over)

    def at(self, t: float) -> Attitude | None:
        """Return w, x, y, z, omega_x and omega_y at a time in s, or None if it is too far."""
        state: Attitude | None = self._motion.at(t)
        return state

    def fill(self, times: Real | ExactTimes, orientation: Real, omega: Real) -> NDArray[np.intp]:
        """Write the states at times in s or exact times; return the places that are too far."""
        if isinstance(times, ExactTimes):
            return self._fill_exact(times, orientation, omega)
        far, times = np.empty(times.size, np.bool_), np.ascontiguousarray(times)
        for first in range(0, times.size, STATES):
            part = slice(first, first + STATES)
            self._motion.fill(times[part], orientation[part], omega[part], far[part])
        return np.flatnonzero(far)

    def _fill_exact(self, times: ExactTimes, orientation: Real, omega: Real) -> NDArray[np.intp]:
        first_end, phases, half_turn = self._phases
        rough = times.rough_seconds
        # Far phases need all digits of the rates, in which the kernel and Python differ.
        far = np.flatnonzero(np.abs(rough) >= phases.farthest)
        if far.size:
            return np.arange(rough.size)
        places = np.where(rough == 0, AT_START, np.abs(rough) <= first_end).astype(np.uint8)
        turns = np.array([phase.turns for phase in (*phases.at(times), *half_turn.at(times))])
        self._motion.fill_phases(times.seconds, places, turns, orientation, omega)
        return far

    @cached_property
    def _phases(self) -> tuple[float, Phases, Phases]:
        first_end, (exponent, steps), (half_exponent, half_step) = self._motion.steps()
        return (
            first_end,
            Phases.from_steps(exponent, _read_steps(steps)),
            Phases.from_steps(half_exponent, _read_steps(half_step)),
        )


def _read_steps(steps: bytes) -> list[int]:
    """Return integers of 256 bits with sign."""
    return [
        int.from_bytes(steps[first : first + 32], "little", signed=True)
        for first in range(0, len(steps), 32)
    ]
