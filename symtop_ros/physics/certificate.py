"""Proved bounds of the errors of states: what the extra `reference` brings is imported here."""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from symtop_ros.base.missing import name_remedy
from symtop_ros.base.refusals import RefusedError, Words, refuse
from symtop_ros.physics.times import SECOND, ExactTimes
from symtop_ros.physics.values import validate_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from symtop_ros.physics.motion import Motion
    from symtop_ros.physics.state import State


@dataclass(frozen=True)
class Certificate:
    """Bounds of the errors of states that `Motion.at` gives, each with a proof.

    Attributes
    ----------
    attitude : float or ndarray (...)
        At least the angle of the rotation that would correct the orientation, in rad.
    angular_velocity : float or ndarray (...)
        At least the length of the error of the angular velocity, in rad/s.
    """

    attitude: Any
    angular_velocity: Any


def certify(motion: "Motion", t: "ArrayLike | ExactTimes") -> Certificate:
    """Return the bounds of the errors of a motion at times in s: see `Motion.certify`."""
    if motion.pushes:
        raise refuse("pushes", "none for a certificate: take a piece", motion.pushes)
    times = t if isinstance(t, ExactTimes) else validate_array("t", t, unit="s")
    states = motion.at(times.ravel())
    rows = np.array(_bound(motion, list_exactly(times), states)).reshape(-1, 2)
    attitude, rates = (column.reshape(times.shape) for column in rows.T)
    if times.shape:
        return Certificate(attitude, rates)
    return Certificate(float(attitude), float(rates))


def list_exactly(times: Any) -> list[Fraction]:
    """Return times in s as fractions: doubles are exact, and so are stamps."""
    if isinstance(times, ExactTimes):
        nanoseconds = np.ravel(times.nanoseconds).tolist()
        return [times.advance(n) / SECOND for n in nanoseconds]
    return list(map(Fraction, times.ravel().tolist()))


def _bound(motion: "Motion", times: list[Fraction], states: "State") -> list[tuple[float, float]]:
    """Return the bounds of the attitude and of the rates for each state."""
    try:
        from symtop_ros.physics.reference import Inputs, balls, proved
    except ModuleNotFoundError as error:
        remedy = name_remedy(error.name or "")
        raise RefusedError(f"a certificate needs {error.name}: {remedy}") from None
    inputs = Inputs.of(motion.top, motion.start)
    if motion.clamped:
        inputs = inputs.clamp()
    drive = motion.friction.coefficients, motion.applied_torque
    try:
        exact = proved.prove_states(inputs, times, 30, *drive)
    except balls.TooFewBitsError:
        farthest = Words(f"{float(max(map(abs, times))):g} s")
        raise refuse("t", f"one that {balls.MOST_BITS} bits can prove", farthest) from None
    rows = zip(exact, states.orientation.tolist(), states.angular_velocity.tolist(), strict=True)
    errors = (proved.bound_errors(*row) for row in rows)
    return [(_round_up(attitude), _round_up(rates)) for attitude, rates in errors]


def _round_up(ball: Any) -> float:
    """Return a double that no number of a ball exceeds."""
    return math.nextafter(float(ball.upper()), math.inf)
