"""Why the axis moves as it does, as a record of the kernel's verdict."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from symtop_ros.physics.kernel.records import (
    EXPLANATIONS,
    PACES,
    PARTS,
    TURNS,
    CauseRecord,
    Explanation,
    Pace,
    Part,
    Subject,
    Turn,
)
from symtop_ros.words import write

COLOURED = re.compile(r"\[([^|\]]*)\|[^\]]*\]")  # a word that the page draws in the arrow's colour


@dataclass(frozen=True, slots=True)
class Cause:
    """Why the axis moves as it does under gravity alone, as far as it can be said.

    `str` of it is empty if nothing can be said. All numbers are None for a driven motion. Angles
    are in rad; where there are three, they are the one now, the least and the most in a nutation.

    Attributes
    ----------
    explanation : str or None
        The first of these that is true of the whole motion. "fixed", "free": Mgl = 0, and the axle
        is along L or turns about it. "upright": the axle rests on the vertical. "steady": the
        torque turns L as fast as the axle goes round. "plane": L is along the torque. "no_spin":
        L is perpendicular to the axle. "about_momentum": L stays within 10 degrees of the
        vertical, and the axle goes round it. "with_momentum": L stays within 30 degrees of the
        line of the axle, and the axle goes round with it, further in a nutation than it nods.
        "circles": the axle goes round L, at least four times as fast as the torque turns L; in
        loops, and if it nods further than it advances. "swings": the torque comes more than 30
        degrees from perpendicular to L, whose size changes by more than 5 %.
    turn : {"faster", "slower", "rests", "vertical", "against"} or None
        phi' compared with the rate at which gravity's torque would turn L, if the axis leaves its
        tilt with theta' = 0: the weight rises if phi' is faster, and falls in the other cases.
        "vertical": L is vertical, and the axis goes round it without a torque.
    pace : {"speeds", "slows"} or None
        Change of |phi'| on the way to the next turning angle. None if it is at most 5 %, or if
        |phi'| both grows and falls on this way.
    torque_share : float or None
        The share of gravity's torque that it takes to turn L as fast as the axle goes round now.
    rate_about_momentum : float or None
        |L|/Ix in rad/s, at which the axle turns about L now.
    torque_from_perpendicular : (float, float) or None
        Angle between the torque and the plane perpendicular to L: now, and the most in a nutation.
    momentum_from_axle, omega_from_axle : (float, float, float) or None
        Angles of L and of omega from the line of the axle.
    momentum_from_vertical : (float, float, float) or None
        Angle of L from the line of the vertical.
    constant : tuple of str
        What does not change, of "size" (of L), "direction" (of L) and "tilt".
    subject : {"top", "axis"}
        "axis" for Mgl < 0: the axle then rises when the weight falls.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, perrys_rule
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> cause = perrys_rule(top, State.from_euler(theta=0.5, psi_dot=200.0)).cause
    >>> cause.explanation, cause.turn, cause.pace
    ('with_momentum', 'rests', 'speeds')
    >>> print(cause)  # doctest: +NORMALIZE_WHITESPACE
    Gravity's torque turns the angular momentum round. L stays near the axle, so the axle goes round
    as well. The torque is perpendicular to L to within 0.064 rad. L stays within 0.14 rad of the
    line of the axle, and the angular velocity omega within 0.037 rad. The axle does not go round,
    so all of gravity's torque accelerates the axle downwards. On its way the axle goes round faster
    and faster.
    """

    explanation: Explanation | None
    turn: Turn | None
    pace: Pace | None
    torque_share: float | None
    rate_about_momentum: float | None
    torque_from_perpendicular: tuple[float, float] | None
    momentum_from_axle: tuple[float, float, float] | None
    omega_from_axle: tuple[float, float, float] | None
    momentum_from_vertical: tuple[float, float, float] | None
    constant: tuple[Part, ...]
    subject: Subject

    def __str__(self) -> str:
        """Return what can be said, in sentences."""
        return COLOURED.sub(r"\1", write("cause", self)).strip()


def read_cause(found: CauseRecord, subject: Subject) -> Cause:
    """Return the cause from the kernel's record of a verdict."""
    rate = _keep(found.rate_about_momentum)
    said = EXPLANATIONS[found.explanation], TURNS[found.turn], PACES[found.pace]
    constant = tuple(part for place, part in enumerate(PARTS) if found.constant >> place & 1)
    if rate is None:
        return Cause(*said, None, None, None, None, None, None, constant, subject)
    now, most = found.torque_from_perpendicular
    return Cause(
        *said,
        _keep(found.torque_share),
        rate,
        (now, most),
        _read_three(found.momentum_from_axle),
        _read_three(found.omega_from_axle),
        _read_three(found.momentum_from_vertical),
        constant,
        subject,
    )


def _read_three(angles: Iterable[float]) -> tuple[float, float, float]:
    now, least, most = angles
    return now, least, most


def _keep(number: float) -> float | None:
    return None if math.isnan(number) else number
