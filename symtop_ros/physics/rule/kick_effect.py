"""The consequences of a kick: what it changed, and Perry's rule for it, as a record."""

from dataclasses import dataclass
from typing import Literal

from symtop_ros.physics.exact.kind import Kind
from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.rule.perry import (
    Direction,
    Reason,
    Rule,
    Subject,
    explain_change,
    find_change,
)
from symtop_ros.physics.rule.verdict import (
    Average,
    explain_vertical,
    find_average,
    find_direction,
)
from symtop_ros.physics.state import State
from symtop_ros.physics.top import validate_one
from symtop_ros.wording import write

# Turning angles that differ by less are reported as equal: next to a pole, or where two roots of
# the cubic nearly meet, an angle is the square root of a quantity that is known to EPS.
SAME_ANGLE = 1e-7  # rad
Fact = Literal["rises", "falls", "highest_higher", "highest_lower", "lowest_higher", "lowest_lower"]


@dataclass(frozen=True, slots=True)
class Lift:
    """Rise of a turning point by a kick: what became higher or lower, and by how much (rad)."""

    kind: Literal["higher", "lower", "unchanged"]
    amount: float


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Facts after a kick that are contrary to the direction in which theta'' changed."""

    rule: Rule
    subject: Subject
    facts: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class KickVerdict:
    """Changes by a kick, and the motion that follows.

    `str` of it is the answer to the kick.

    Attributes
    ----------
    axis : {"tilted", "vertical"}
        "vertical" if phi' was undefined before the kick.
    hold : {"spin_rate", "spin_momentum"} or None
        The quantity that the kick held; None for an angular impulse.
    factor, before, after : float or None
        phi' in rad/s before the kick and after it, and their ratio; None if undefined.
    motion : str
        Kind of the motion after the kick.
    subject, direction, turning_angles
        As in `Verdict`, after the kick.
    driven : bool
        True under friction or an applied torque. Turning angles are those without them.
    reason : Reason
        Perry's rule for the kick.
    highest, lowest : Lift
        Rise of the highest and of the lowest point, compared with no kick.
    contradiction : Contradiction or None
        Facts that are contrary to the change of theta''; None if there are none.
    average : Average or None
        As in `Verdict`; None for a driven motion too.
    """

    axis: Literal["tilted", "vertical"]
    hold: Hold | None
    factor: float | None
    before: float | None
    after: float | None
    motion: Kind
    subject: Subject
    direction: Direction
    turning_angles: tuple[float, float]
    driven: bool
    reason: Reason
    highest: Lift
    lowest: Lift
    contradiction: Contradiction | None
    average: Average | None

    def __str__(self) -> str:
        """Return the change, its consequences and Perry's rule, in sentences."""
        return write("kick", self)


def kick_verdict(motion: Motion, before: State, hold: Hold | None) -> KickVerdict:
    """Return what a kick changed: its consequences, and Perry's rule.

    Parameters
    ----------
    motion : Motion
        The motion after the kick; it starts from the kicked state.
    before : State
        The state at the instant of the kick, without it.
    hold : {"spin_rate", "spin_momentum"} or None
        The quantity that the kick held; None for an angular impulse.

    Raises
    ------
    ValueError
        If `hold` is refused.

    Examples
    --------
    >>> from symtop_ros.physics import (
    ...     Motion, State, Top, hurry, kick_verdict, regular_precession_rates
    ... )
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> slow, _ = regular_precession_rates(top, theta=0.5, psi_dot=200.0)
    >>> before = State.from_euler(theta=0.5, phi_dot=slow, psi_dot=200.0)
    >>> answer = kick_verdict(Motion(top, hurry(before)), before, "spin_rate")
    >>> print(answer)  # doctest: +NORMALIZE_WHITESPACE
    Precession 6.50 -> 9.10 rad/s. The top rises: theta will stay between 0.437 and 0.500 rad.
    Perry's rule holds: hurried, theta'' is -49.7 instead of 0 rad/s^2 (9.10 rad/s lies between the
    regular rates 6.50 and 69.82 rad/s). Compared with no kick, the highest point is 0.063 rad
    higher and the lowest point unchanged. On average phi' is 6.41 rad/s, 0.157 turns in a nutation
    (slow precession of a fast top: Mgl/p_psi = 5.72 rad/s).
    """
    validate_one(motion, "motion")
    top, after = motion.top, motion.start
    if hold is not None:
        hold = validate_hold(hold)
    direction = find_direction(top, after)
    if before.is_vertical:
        factor, reason = None, explain_vertical(top, after)
    else:
        tilt, was, now, factor = find_change(top, before, after, hold)
        reason = explain_change(tilt, was, now, factor, is_done=True)
    highest, lowest = _compare(Motion(top, before).turning_angles, motion.turning_angles)
    return KickVerdict(
        axis="vertical" if before.is_vertical else "tilted",
        hold=hold,
        factor=factor,
        before=reason.before,
        after=reason.after,
        motion=motion.kind,
        subject=reason.subject,
        direction=direction,
        turning_angles=motion.turning_angles,
        driven=motion.is_driven,
        reason=reason,
        highest=highest,
        lowest=lowest,
        contradiction=_find_contradiction(reason, direction, highest, lowest),
        average=None if motion.is_driven else find_average(motion),
    )


def _compare(before: tuple[float, float], after: tuple[float, float]) -> list[Lift]:
    """Return the rise of the highest and of the lowest point, where rounding does not hide it."""
    lifts = []
    for was, now in zip(before, after, strict=True):
        change = was - now if abs(was - now) > SAME_ANGLE else 0.0
        kind: Literal["higher", "lower"] = "higher" if change > 0 else "lower"
        lifts.append(Lift(kind if change else "unchanged", abs(change)))
    return lifts


def _find_contradiction(
    reason: Reason, direction: Direction, highest: Lift, lowest: Lift
) -> Contradiction | None:
    """Return the facts that are contrary to the direction in which theta'' changed."""
    if reason.rule is None:
        return None
    is_raised = (reason.rule == "holds") == (reason.kind == "hurried")
    facts: list[Fact] = []
    if direction == ("falls" if is_raised else "rises"):
        facts.append(direction)
    if highest.kind == ("lower" if is_raised else "higher"):
        facts.append("highest_lower" if is_raised else "highest_higher")
    if lowest.kind == ("lower" if is_raised else "higher"):
        facts.append("lowest_lower" if is_raised else "lowest_higher")
    return Contradiction(reason.rule, reason.subject, tuple(facts)) if facts else None
