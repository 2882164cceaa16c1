"""The consequences of a kick, or of many: what it changed, and Perry's rule, as a record."""

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.arguments import NO_FRICTION, NO_TORQUE, pack_start
from symtop_ros.physics.kernel import door
from symtop_ros.physics.kicks import HOLDS, Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.precession import spread_tops
from symtop_ros.physics.rule.perry import (
    DIRECTIONS,
    RULES,
    SUBJECTS,
    Average,
    Direction,
    Reason,
    Rule,
    Subject,
    read_average,
    read_reason,
)
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top, validate_one
from symtop_ros.physics.values import validate_array, validate_number, validate_rate
from symtop_ros.wording import write

LiftKind = Literal["unchanged", "higher", "lower"]
Fact = Literal["rises", "falls", "highest_higher", "highest_lower", "lowest_higher", "lowest_lower"]
LIFTS: tuple[LiftKind, ...] = get_args(LiftKind)  # in the order of `symtop_lift_kind`
FACTS: tuple[Fact, ...] = get_args(Fact)  # the bits of `symtop_fact`


@dataclass(frozen=True, slots=True)
class Lift:
    """Rise of a turning point by a kick: what became higher or lower, and by how much (rad)."""

    kind: LiftKind
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
    motion: door.Kind
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
    regular rates 6.50 and 69.82 rad/s at this spin rate). Compared with no kick, the highest point
    is 0.063 rad higher and the lowest point unchanged. On average phi' is 6.41 rad/s, 0.157 turns
    per nutation (slow precession of a fast top: Mgl/p_psi = 5.72 rad/s).
    """
    validate_one(motion, "motion")
    held = len(HOLDS) if hold is None else HOLDS.index(validate_hold(hold))
    alone = pack_start(motion.top, before, NO_FRICTION, NO_TORQUE)
    found = door.judge_kick(alone, motion.packed_start, held)
    reason, (low, high) = read_reason(found, hold), found.turning_angles
    return KickVerdict(
        axis="vertical" if before.is_vertical else "tilted",
        hold=hold,
        factor=None if math.isnan(found.factor) else found.factor,
        before=reason.before,
        after=reason.after,
        motion=door.KINDS[found.motion],
        subject=SUBJECTS[found.subject],
        direction=DIRECTIONS[found.direction],
        turning_angles=(low, high),
        driven=motion.is_driven,
        reason=reason,
        highest=Lift(LIFTS[found.highest.kind], found.highest.amount),
        lowest=Lift(LIFTS[found.lowest.kind], found.lowest.amount),
        contradiction=_read_contradiction(found.contrary_facts, reason),
        average=read_average(found.average),
    )


def _read_contradiction(bits: int, reason: Reason) -> Contradiction | None:
    facts = tuple(fact for place, fact in enumerate(FACTS) if bits >> place & 1)
    return Contradiction(reason.rule, reason.subject, facts) if facts and reason.rule else None


@dataclass(frozen=True, eq=False)
class HurryEffect:
    """Tops with theta' = 0, compared with the same tops hurried.

    Attributes
    ----------
    before, after : ndarray (2, ...)
        Turning angles without the kick and with it, smallest theta first, in rad.
    rule_applies : ndarray (...) of bool
        False where Perry's rule says nothing: for phi' = 0, on the vertical, for a factor that is 1
        or negative, and where theta'' is the same with the kick as without it.
    rule_holds : ndarray (...) of bool
        True where Perry's rule holds, as defined in `perrys_rule`.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> effect = compare_hurried(top, theta=0.5, phi_dot=9.0, psi_dot=200.0)
    >>> bool(effect.rise > 0)
    True
    """

    before: Real
    after: Real
    rule_applies: NDArray[np.bool_]
    rule_holds: NDArray[np.bool_]

    @property
    def rise(self) -> Real:
        """Rise of the highest point, (...), in rad; negative where it is lower with the kick."""
        return np.asarray(self.before[0] - self.after[0])

    @property
    def fall(self) -> Real:
        """Fall of the lowest point, (...), in rad; negative where it is higher with the kick."""
        return np.asarray(self.after[1] - self.before[1])


def compare_hurried(
    top: Top,
    theta: ArrayLike,
    phi_dot: ArrayLike,
    psi_dot: ArrayLike,
    factor: float = 1.4,
    hold: Hold = "spin_rate",
) -> HurryEffect:
    """Return the effect of hurrying the precession by a factor, for many tops at once.

    Parameters
    ----------
    top : Top
        One top, or many of a shape that fits the other arguments.
    theta, phi_dot, psi_dot : array_like, broadcast to (...)
        Tilt in rad, precession and spin rate in rad/s; theta' is 0.
    factor : float
        The kick multiplies phi' by it.
    hold : {"spin_rate", "spin_momentum"}
        The quantity that the kick holds, as in `set_precession_rate`.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Top, compare_hurried
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> compare_hurried(top, 0.5, [6.5, 69.8], 200.0).rule_holds.tolist()
    [True, False]
    """
    factor, held = validate_number("factor", factor), HOLDS.index(validate_hold(hold))
    given = (
        validate_array("theta", theta, unit="rad"),
        validate_rate("phi_dot", phi_dot),
        validate_rate("psi_dot", psi_dot),
    )
    validate_rate("factor * phi_dot", float(np.max(np.abs(given[1]), initial=0.0)) * factor)
    shape, (tops, tilts, phi_dots, psi_dots) = spread_tops(top, *given)
    angles, rules = door.compare_hurried(tops, tilts, phi_dots, psi_dots, factor, held)
    before, after = (np.sort([tilts, each], axis=0).reshape(2, *shape) for each in angles.T)
    rules = rules.reshape(shape)
    return HurryEffect(before, after, rules != RULES.index(None), rules == RULES.index("holds"))
