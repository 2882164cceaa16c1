"""Perry's rule: "Hurry on the precession, and the body rises in opposition to gravity".

One definition, that of docs/article.md, is used for a state, a kick and a map. The kicked top is
compared with the same top not kicked: phi' is multiplied by a factor while the spin rate or the
spin momentum is held.

- factor > 1 (hurried): the rule holds if theta'' is lower with the kick.
- 0 <= factor < 1 (delayed): the rule holds if theta'' is higher with the kick.
- The rule says nothing (None) if phi' = 0, if the factor is 1 or negative, about an angular
  impulse that changes theta' or the spin momentum, if theta'' is the same with the kick as without
  it, for Mgl = 0, where there is no weight to rise, and on the vertical, where phi' is undefined.

These words mean the axis. The height of the centre of mass is cos(theta) times an arm of the sign
of Mgl, so for Mgl < 0 it moves the other way, and the answers name both.

At a root of regular precession theta'' is 0 without the kick, so the hurried axis rises if and only
if the rule holds there. This is the article's case. With two distinct roots s (slow) and f (fast)
of a p^2 - b p + Mgl = 0, Ix theta''/sin(theta) after a kick by k is

    (k - 1) Mgl (k s/f - 1)  from the slow root,    (k - 1) a f^2 (k - s/f)  from the fast one.

Slow and fast are meant with that held which the kick holds. Since |s| < |f|, a small hurry on that
slow root raises the centre of mass of every top, and lowers the axis if and only if Mgl < 0. A
hurry on the fast root raises the centre of mass if and only if Mgl a < 0, where a = (Ix - Iz)
cos(theta) if the spin rate is held and Ix cos(theta) if the spin momentum is. docs/derivation.md
has the derivation. Elsewhere the axis may move up although the rule fails, and the reverse: the
rule is about theta'' at the instant of the kick. The answer to a kick has three parts: at this
instant, from now on, and compared with no kick. The formulas are in the kernel
(`kernel/rule/tilt.hpp` and `verdict.hpp`).
"""

import math
from dataclasses import dataclass
from typing import Literal

from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import (
    DIRECTIONS,
    EFFECTS,
    HOLDS,
    KINDS,
    LIFT_KINDS,
    PLACE_KINDS,
    REASON_KINDS,
    RULES,
    SUBJECTS,
    AverageRecord,
    Direction,
    Effect,
    Hold,
    Kind,
    LiftKind,
    PlaceKind,
    ReasonKind,
    Rule,
    Subject,
    VerdictRecord,
)
from symtop_ros.physics.kicks import validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.rule.cause import Cause, read_cause
from symtop_ros.physics.rule.means import MeanChange, read_means
from symtop_ros.physics.state import State
from symtop_ros.physics.values import validate_one
from symtop_ros.words import write

VERTICAL = REASON_KINDS.index("undefined")  # from here on the axis is on the vertical


@dataclass(frozen=True, slots=True)
class Place:
    """Place of a precession rate among the rates of regular precession.

    Attributes
    ----------
    kind : str
        "slow" or "fast": it is one of two; "between" or "outside" two; "only": it is the only one;
        "above" or "below" the only one; "none": no rate is regular; "every": every rate is. A
        double root is the only one. If two rates have the same size, both are slow.
    rate : float
        The rate in rad/s.
    regular_rates : (float, float)
        Rates of regular precession in rad/s, the slow one first; nan for one that there is not.
    held : {"spin_rate", "spin_momentum"}
        The quantity at which these rates are regular: that which the kick holds.
    """

    kind: PlaceKind
    rate: float
    regular_rates: tuple[float, float]
    held: Hold = "spin_rate"


@dataclass(frozen=True, slots=True)
class Reason:
    """Why Perry's rule holds, fails or says nothing, with its numbers.

    Attributes
    ----------
    kind : str
        "hurried" or "delayed" for a kick, "if_hurried" or "if_delayed" for a kick that a verdict
        considers. All others are cases in which the rule says nothing.
    rule : {"holds", "fails"} or None
        The rule for the axis; None if it says nothing.
    subject : {"top", "axis"}
        "axis" for Mgl < 0: the rule is then the opposite for the centre of mass.
    before, after : float or None
        phi' without the kick and with it, in rad/s; None on the vertical.
    theta_ddot_without, theta_ddot : float or None
        theta'' without the kick and with it, in rad/s^2; None on the vertical.
    effect : {"up", "down"} or None
        "up": the kick lowers theta'', which stays positive: it acts upwards, and not enough to lift
        the axis. "down": it raises theta'', which stays negative. None if theta'' with the kick is
        zero or has the sign of its change, and if the rule says nothing.
    place : Place or None
        Place of phi' with a kick, or of the present phi' for a verdict; None on the vertical.
    disturbed_to : float or None
        Tilt in rad that the axis reaches after the least disturbance, if it rests on the vertical
        and is unstable there.
    """

    kind: ReasonKind
    rule: Rule | None
    subject: Subject
    before: float | None = None
    after: float | None = None
    theta_ddot_without: float | None = None
    theta_ddot: float | None = None
    effect: Effect | None = None
    place: Place | None = None
    disturbed_to: float | None = None

    def __str__(self) -> str:
        """Return the sentence on Perry's rule."""
        return write("reason", self)


@dataclass(frozen=True, slots=True)
class Average:
    """Mean precession of a motion, and its approximation for a fast top.

    Attributes
    ----------
    rate : float
        Mean phi' in rad/s.
    precession_period : float or None
        Time of one turn at that rate in s; None if it is 0.
    turns : float
        Turns of the precession in a nutation.
    speed : {"fast", "slow"}
        "fast" if the approximation is meant for this top, p_psi^2 > 4 Ix |Mgl| and Mgl not 0, the
        mean is within 30 % of it, and the top spins faster than it precesses, in the mean.
    fast_top_rate : float
        Mgl/p_psi in rad/s.
    spin_reverses : bool
        True if psi' changes sign in each nutation.
    """

    rate: float
    precession_period: float | None
    turns: float
    speed: Literal["fast", "slow"]
    fast_top_rate: float
    spin_reverses: bool


@dataclass(frozen=True, slots=True)
class Lift:
    """Rise of a turning point by a kick: what became higher or lower, and by how much (rad)."""

    kind: LiftKind
    amount: float


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
    means : MeanChange or None
        The means, compared with no kick; None if they are undefined, and for a driven motion.
    average : Average or None
        As in `Verdict`; None for a driven motion too.
    cause : Cause
        As in `Verdict`, after the kick.
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
    means: MeanChange | None
    average: Average | None
    cause: Cause

    def __str__(self) -> str:
        """Return what holds at this instant, from now on, and compared with no kick."""
        return write("kick", self)


def kick_verdict(motion: Motion, before: State[float], hold: Hold | None) -> KickVerdict:
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
    At this instant: precession 6.50 -> 9.10 rad/s, spin rate held; the axis moves up. Perry's rule
    holds: hurried, theta'' is -49.7 instead of 0 rad/s^2 (9.10 rad/s lies between the rates of
    regular precession, 6.50 and 69.82 rad/s, at this spin rate). From now on: theta will stay
    between 0.437 and 0.500 rad. On average phi' is 6.41 rad/s (one turn in 0.98 s), 0.157 turns per
    nutation (slow precession of a fast top: Mgl/p_psi = 5.72 rad/s). Compared with no kick: the
    highest point is 0.063 rad higher, the lowest point is unchanged, and the mean height rises
    (mean of cos(theta): 0.892 instead of 0.878). The kick is along the mean precession (6.50 rad/s
    without the kick).
    """
    validate_one(motion, "motion")
    held = HOLDS.index(hold if hold is None else validate_hold(hold))
    found = bindings.judge_kick(motion._pack_with("before", before), motion._packed_start, held)
    reason = read_reason(found, hold)
    low, high = found.turning_angles
    return KickVerdict(
        axis="vertical" if reason.before is None else "tilted",
        hold=hold,
        factor=None if math.isnan(found.factor) else found.factor,
        before=reason.before,
        after=reason.after,
        motion=KINDS[found.motion],
        subject=SUBJECTS[found.subject],
        direction=DIRECTIONS[found.direction],
        turning_angles=(low, high),
        driven=motion.is_driven,
        reason=reason,
        highest=Lift(LIFT_KINDS[found.highest.kind], found.highest.amount),
        lowest=Lift(LIFT_KINDS[found.lowest.kind], found.lowest.amount),
        means=read_means(found.means, SUBJECTS[found.subject]),
        average=read_average(found.average),
        cause=read_cause(found.cause, SUBJECTS[found.subject]),
    )


def read_reason(verdict: VerdictRecord, hold: Hold | None) -> Reason:
    """Return the reason from the kernel's record of a verdict.

    `hold` is None for an angular impulse: a push along the precession holds the spin momentum, and
    after any other the kernel finds the rates at the spin rate that it left.
    """
    found = verdict.reason
    kind, rule, subject = REASON_KINDS[found.kind], RULES[found.rule], SUBJECTS[verdict.subject]
    if found.kind >= VERTICAL:
        reach = verdict.disturbed_to
        return Reason(kind, rule, subject, disturbed_to=None if math.isnan(reach) else reach)
    slow, fast = found.place.regular_rates
    held = hold or ("spin_rate" if kind == "angular_impulse" else "spin_momentum")
    return Reason(
        kind,
        rule,
        subject,
        found.before,
        found.after,
        found.theta_ddot_without,
        found.theta_ddot,
        EFFECTS[found.effect],
        Place(PLACE_KINDS[found.place.kind], found.place.rate, (slow, fast), held),
    )


def read_average(found: AverageRecord) -> Average | None:
    """Return mean precession and its approximation; None if the mean is undefined."""
    if not math.isfinite(found.turns):
        return None
    return Average(
        found.rate,
        found.precession_period if found.rate else None,
        found.turns,
        "fast" if found.is_fast else "slow",
        found.fast_top_rate,
        bool(found.spin_reverses),
    )
