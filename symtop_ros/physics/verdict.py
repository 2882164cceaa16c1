"""The consequences of a state or a kick: direction, turning angles, Perry's rule, as records."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from symtop_ros.physics.exact.kind import Kind
from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.perry import (
    Direction,
    PrecessionChange,
    Reason,
    Rule,
    Subject,
    TiltAcceleration,
    VerticalCase,
    find_precession,
    name_subject,
)
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top, validate_one
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    START_ROUNDING,
    refuse,
    validate_number,
)
from symtop_ros.wording import write

# Turning angles that differ by less are reported as equal: next to a pole, or where two roots of
# the cubic nearly meet, an angle is the square root of a quantity that is known to EPS.
SAME_ANGLE = 1e-7  # rad
Fact = Literal["rises", "falls", "highest_higher", "highest_lower", "lowest_higher", "lowest_lower"]


@dataclass(frozen=True, slots=True)
class Average:
    """Mean precession of a motion, and its approximation for a fast top.

    Attributes
    ----------
    rate : float
        Mean phi' in rad/s.
    turns : float
        Turns of the precession in a nutation.
    speed : {"fast", "slow"}
        "fast" if the approximation is meant for this top: p_psi^2 > 4 Ix |Mgl|, Mgl not 0.
    fast_top_rate : float
        Mgl/p_psi in rad/s.
    spin_reverses : bool
        True if psi' changes sign in each nutation.
    """

    rate: float
    turns: float
    speed: Literal["fast", "slow"]
    fast_top_rate: float
    spin_reverses: bool


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
class Verdict:
    """The motion that follows from a state, and Perry's rule for a kick at this state.

    `str` of it is its text.

    Attributes
    ----------
    subject : {"top", "axis"}
        "axis" for Mgl < 0: the direction of the centre of mass is then the opposite.
    direction : {"rises", "falls", "stays"}
        Direction of the axis from this state on, without the kick: by theta', or by theta'' if
        theta' = 0.
    turning_angles : (float, float)
        Smallest and largest theta in rad from this state on, without the kick.
    regular_rates : tuple of float
        Rates of regular precession in rad/s at this tilt and at the held spin rate or momentum.
    rule_holds : bool or None
        True if Perry's rule holds for the axis; None if it says nothing. For Mgl < 0 the rule is
        the opposite for the centre of mass, which lies on the other side of the pivot.
    reason : Reason
        The reason: theta'' with the kick and without it.
    average : Average or None
        Mean precession and its fast-top approximation; None if the mean precession is undefined.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, perrys_rule
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> verdict = perrys_rule(top, State.from_euler(theta=0.5, phi_dot=9.0, psi_dot=200.0))
    >>> print(verdict)  # doctest: +NORMALIZE_WHITESPACE
    The top rises: theta will stay between 0.439 and 0.500 rad. Perry's rule holds: hurried from
    9.00 to 12.60 rad/s, theta'' would be -110 instead of -48 rad/s^2 (9.00 rad/s lies between
    the regular rates 6.50 and 69.82 rad/s). On average phi' is 6.42 rad/s, 0.157 turns in a
    nutation (slow precession of a fast top: Mgl/p_psi = 5.72 rad/s).
    """

    subject: Subject
    direction: Direction
    turning_angles: tuple[float, float]
    regular_rates: tuple[float, ...]
    rule_holds: bool | None
    reason: Reason
    average: Average | None

    def __str__(self) -> str:
        """Return direction, turning angles, reason and averages, in sentences."""
        return write("verdict", self)


@dataclass(frozen=True, slots=True)
class KickVerdict:
    """What a kick changed, and the motion that follows.

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


def perrys_rule(top: Top, state: State, factor: float = 1.4, hold: Hold = "spin_rate") -> Verdict:
    """Return the motion that follows from a state, and Perry's rule for a kick at this state.

    Parameters
    ----------
    top : Top
    state : State
        One state, before the kick.
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
    Hurrying regular precession raises the top at the slow rate and lowers it at the fast rate:

    >>> from symtop_ros.physics import State, Top, perrys_rule, regular_precession_rates
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> for rate in regular_precession_rates(top, theta=0.5, psi_dot=200.0):
    ...     state = State.from_euler(theta=0.5, phi_dot=rate, psi_dot=200.0)
    ...     print(perrys_rule(top, state).rule_holds)
    True
    False
    """
    validate_one(top)
    factor, hold = validate_number("factor", factor), validate_hold(hold)
    motion = Motion(top, state)
    if state.is_vertical:
        reason = Reason(_classify_vertical(top, state), None, name_subject(top.Mgl))
        rates: tuple[float, ...] = ()
    else:
        kick = _plan_change(TiltAcceleration.of(top, state, hold), find_precession(state), factor)
        reason, rates = kick.explain(is_done=False), kick.tilt.quadratic.roots
    return Verdict(
        subject=name_subject(top.Mgl),
        direction=_find_direction(top, state),
        turning_angles=motion.turning_angles,
        regular_rates=rates,
        rule_holds=None if reason.rule is None else reason.rule == "holds",
        reason=reason,
        average=_find_average(motion),
    )


def _plan_change(tilt: TiltAcceleration, rate: float, factor: float) -> PrecessionChange:
    if abs(factor * rate) > LARGEST_ANGULAR_VELOCITY:
        condition = f"such that phi' stays within {LARGEST_ANGULAR_VELOCITY:g} rad/s"
        raise refuse("factor", condition, factor)
    return PrecessionChange(tilt, rate, factor * rate, factor)


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
    subject, direction = name_subject(top.Mgl), _find_direction(top, after)
    kick = None if before.is_vertical else PrecessionChange.between(top, before, after, hold)
    if kick is None:
        reason = Reason(_classify_vertical(top, after), None, subject)
    else:
        reason = kick.explain(is_done=True)
    highest, lowest = _compare(Motion(top, before).turning_angles, motion.turning_angles)
    return KickVerdict(
        axis="vertical" if kick is None else "tilted",
        hold=hold,
        factor=None if kick is None else kick.factor,
        before=reason.before,
        after=reason.after,
        motion=motion.kind,
        subject=subject,
        direction=direction,
        turning_angles=motion.turning_angles,
        driven=motion.is_driven,
        reason=reason,
        highest=highest,
        lowest=lowest,
        contradiction=_find_contradiction(reason, kick, direction, highest, lowest),
        average=None if motion.is_driven else _find_average(motion),
    )


def _find_average(motion: Motion) -> Average | None:
    """Return mean precession and its approximation; None if the mean is undefined."""
    turns = motion.precession_per_nutation
    if not math.isfinite(turns):
        return None
    top, omega_z = motion.top, float(motion.start.angular_velocity[2])
    # The approximation is for p_psi^2 >> 4 Ix |Mgl|; below that number it is not even a guess.
    fast = top.Mgl and abs(omega_z) > 2 * math.sqrt(top.Ix) * math.sqrt(abs(top.Mgl)) / top.Iz
    return Average(
        motion.mean_precession_rate,
        turns,
        "fast" if fast else "slow",
        motion.fast_top_precession_rate,
        motion.spin_reverses,
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
    reason: Reason,
    kick: PrecessionChange | None,
    direction: Direction,
    highest: Lift,
    lowest: Lift,
) -> Contradiction | None:
    """Return the facts that are contrary to the direction in which theta'' changed."""
    expected = kick.expected_direction if kick else None
    if expected is None or reason.rule is None:
        return None
    facts: list[Fact] = []
    if direction not in (expected, "stays"):
        facts.append("falls" if expected == "rises" else "rises")
    if highest.kind == ("lower" if expected == "rises" else "higher"):
        facts.append("highest_lower" if expected == "rises" else "highest_higher")
    if lowest.kind == ("lower" if expected == "rises" else "higher"):
        facts.append("lowest_lower" if expected == "rises" else "lowest_higher")
    return Contradiction(reason.rule, reason.subject, tuple(facts)) if facts else None


def _find_direction(top: Top, state: State) -> Direction:
    """Return the direction of the axis from a state on."""
    moving = float(np.hypot(*state.angular_velocity[:2]))
    if state.is_vertical:  # a moving axis leaves the upper pole downwards, the lower one upwards
        upright = state.vertical[2] > 0
        return "stays" if moving == 0 else "falls" if upright else "rises"
    change = float(state.euler_rates.theta)
    if abs(change) <= START_ROUNDING * float(abs(state.angular_velocity).max()):
        change = TiltAcceleration.of(top, state, "spin_rate").at(state.euler_rates.phi)
    if change == 0:
        return "stays"
    return "rises" if change < 0 else "falls"


def _classify_vertical(top: Top, state: State) -> VerticalCase:
    """Return why the rule says nothing about an axis on the vertical."""
    if any(state.angular_velocity[:2]):
        return "undefined"
    return "stable" if top.sleeping_is_stable(state) else "unstable"
