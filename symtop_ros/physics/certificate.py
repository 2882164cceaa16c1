"""Proved bounds of the errors of states; needs the extra `reference`."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Generic

import numpy as np

from symtop_ros.base.arrays import Vector
from symtop_ros.base.missing import name_remedy
from symtop_ros.base.one_or_many import N
from symtop_ros.base.refusals import RefusedError, Words, refuse
from symtop_ros.physics.state import State
from symtop_ros.physics.times import SECOND, ExactTimes
from symtop_ros.physics.top import Top

Drive = tuple[tuple[float, float], Vector]  # coefficients of friction, and a torque in N m


@dataclass(frozen=True)
class Certificate(Generic[N]):
    """Proved bounds of the errors of the states that `Motion.at` returns.

    Attributes
    ----------
    attitude : float or ndarray (...)
        Upper bound of the angle of the rotation that would correct the orientation, in rad.
    angular_velocity : float or ndarray (...)
        Upper bound of the length of the error of the angular velocity, in rad/s.
    """

    attitude: N
    angular_velocity: N


def certify(
    top: Top, start: State, drive: Drive, clamped: bool, times: Any, states: State
) -> Certificate:
    """Return the bounds of the errors of states at times in s, an array or exact times.

    They are compared with the motion from a start: see `Motion.certify`.
    """
    rows = [*_bound(top, start, drive, clamped, list_exactly(times), states)]
    attitude, rates = (column.reshape(times.shape) for column in np.reshape(rows, (-1, 2)).T)
    if times.shape:
        return Certificate(attitude, rates)
    return Certificate(float(attitude), float(rates))


def list_exactly(times: Any) -> list[Fraction]:
    """Return times in s as fractions: doubles are exact, and so are stamps."""
    if isinstance(times, ExactTimes):
        nanoseconds = np.ravel(times.nanoseconds).tolist()
        return [times.advance(n) / SECOND for n in nanoseconds]
    return list(map(Fraction, times.ravel().tolist()))


def _bound(
    top: Top, start: State, drive: Drive, clamped: bool, times: list[Fraction], states: State
) -> Iterator[tuple[float, float]]:
    """Yield the bounds of the attitude and of the rates of each state."""
    try:
        from symtop_ros.physics.reference import balls, proved
        from symtop_ros.physics.reference.series import Inputs
    except ModuleNotFoundError as error:
        remedy = name_remedy(error.name or "")
        raise RefusedError(f"a certificate needs {error.name}: {remedy}") from None
    inputs = Inputs.of(top, start)
    try:
        exact = proved.prove_states(inputs.clamp() if clamped else inputs, times, 30, *drive)
    except balls.TooFewBitsError:
        farthest = Words(f"{float(max(map(abs, times))):g} s")
        raise refuse("t", f"one that {balls.MOST_BITS} bits can prove", farthest) from None
    for row in zip(
        exact, states.orientation.tolist(), states.angular_velocity.tolist(), strict=True
    ):
        attitude, rates = proved.bound_errors(*row)
        yield _round_up(attitude), _round_up(rates)


def _round_up(ball: Any) -> float:
    """Return a double that no number of a ball exceeds."""
    return math.nextafter(float(ball.upper()), math.inf)
