"""Effects of a hand that holds the precession: Perry's clamped vertical axis."""

import math
from dataclasses import dataclass

from symtop_ros.physics.arguments import NO_FRICTION, NO_TORQUE, pack_start
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import HELD_KINDS, SUBJECTS, HeldKind, Subject
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import validate_one
from symtop_ros.words import write


@dataclass(frozen=True, slots=True)
class ClampVerdict:
    """The motion of the axis while its precession is held, and without the clamp.

    `str` of it is the sentence.

    Attributes
    ----------
    kind : {"falls", "swings", "rises", "turns", "rests"}
        "falls": it starts at rest, and the weight falls to its lowest place. "swings": it moves,
        and the weight comes to its lowest place. "rises": it moves up with exactly the energy to
        come to rest at the highest place. "turns" and "rests": Mgl = 0, and theta' is constant, or
        0.
    subject : {"top", "axis"}
        "axis" for Mgl < 0: the axle then rises when the weight falls.
    theta : float
        Tilt in rad where the clamp takes hold.
    rate : float
        |theta'| there in rad/s.
    lowest_in : float or None
        Time in s until the weight is lowest; None if it never is.
    angles_without : (float, float)
        Turning angles in rad of the motion that is not held.
    """

    kind: HeldKind
    subject: Subject
    theta: float
    rate: float
    lowest_in: float | None
    angles_without: tuple[float, float]

    def __str__(self) -> str:
        """Return the verdict as a sentence."""
        return write("clamp", self)


def clamp_verdict(top: Top[float], before: State[float]) -> ClampVerdict:
    """Return what follows if a hand holds the precession of a state.

    Parameters
    ----------
    top : Top
        One top, without friction and applied torque.
    before : State
        One state, before the hand stops phi'.

    Returns
    -------
    ClampVerdict

    Raises
    ------
    ValueError
        If an argument is refused, or if the axis is vertical.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, clamp_verdict
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> print(clamp_verdict(top, State.from_euler(theta=0.5, psi_dot=200.0)))
    ... # doctest: +NORMALIZE_WHITESPACE
    Clamped, the axle falls as if the top did not spin, from theta = 0.500 rad to its lowest point
    in 0.163 s. Without the clamp theta would stay between 0.500 and 0.664 rad.
    """
    validate_one(top, "top")
    validate_one(before, "before", "state")
    found = bindings.judge_clamp(pack_start(top, before, NO_FRICTION, NO_TORQUE))
    low, high = found.angles_without
    return ClampVerdict(
        HELD_KINDS[found.kind],
        SUBJECTS[found.subject],
        found.theta,
        found.rate,
        None if math.isnan(found.lowest_in) else found.lowest_in,
        (low, high),
    )
