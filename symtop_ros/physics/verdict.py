"""The consequences of a state or a kick in words: direction, turning angles, Perry's rule."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.perry import (
    NOTHING,
    Direction,
    PrecessionChange,
    TiltAcceleration,
    find_precession,
    format_rate,
)
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top, validate_one
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    START_ROUNDING,
    refuse,
    validate_number,
)

# Turning angles that differ by less are reported as equal: next to a pole, or where two roots of
# the cubic nearly meet, an angle is the square root of a quantity that is known to EPS.
SAME_ANGLE = 1e-7  # rad
OPPOSITE: dict[Direction, Direction] = {"rises": "falls", "falls": "rises", "stays": "stays"}


@dataclass(frozen=True, slots=True)
class Verdict:
    """The motion that follows from a state, and Perry's rule for a kick at this state.

    Attributes
    ----------
    subject : str
        The top with its direction, in words; for Mgl < 0 the axis and the centre of mass apart.
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
    reason : str
        The reason, in a sentence: theta'' with the kick and without it.
    average : str
        Mean precession and its fast-top approximation, and a spin that reverses, in sentences;
        empty if the mean precession is undefined.

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

    subject: str
    direction: Direction
    turning_angles: tuple[float, float]
    regular_rates: tuple[float, ...]
    rule_holds: bool | None
    reason: str
    average: str

    def __str__(self) -> str:
        """Return direction, turning angles, reason and averages, in sentences."""
        where = f"{self.subject}: {_describe_range(self.turning_angles)}."
        return " ".join(filter(None, (where, self.reason, self.average)))


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
    direction = _find_direction(top, state)
    subject = _describe_direction(top, direction)
    if state.is_vertical:
        reason = f"{NOTHING}: {_describe_vertical(top, state)}."
        return Verdict(
            subject, direction, motion.turning_angles, (), None, reason, _describe_average(motion)
        )
    tilt, rate = TiltAcceleration.of(top, state, hold), find_precession(state)
    if abs(factor * rate) > LARGEST_ANGULAR_VELOCITY:
        condition = f"such that phi' stays within {LARGEST_ANGULAR_VELOCITY:g} rad/s"
        raise refuse("factor", condition, factor)
    kick = PrecessionChange(tilt, rate, factor * rate, factor)
    rates = f" from {format_rate(rate)} to {format_rate(kick.after)} rad/s, theta'' would be"
    reason = kick.explain(rates, tilt.describe_place(rate))
    return Verdict(
        subject,
        direction,
        motion.turning_angles,
        tilt.quadratic.roots,
        kick.rule_holds,
        reason,
        _describe_average(motion),
    )


def kick_verdict(motion: Motion, before: State, hold: Hold | None) -> str:
    """Return the answer to a kick: the change, its consequences, and Perry's rule.

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
    expected: Direction | None = None
    holds: bool | None = None
    if before.is_vertical:
        change = f"Kick on the vertical (motion: {motion.kind})."
        rule = f"{NOTHING}: {_describe_vertical(top, after)}."
    else:
        kick = PrecessionChange.between(top, before, after, hold)
        change = f"Precession {format_rate(kick.before)} -> {format_rate(kick.after)} rad/s."
        rule = kick.explain(", theta'' is", kick.tilt.describe_place(kick.after))
        expected, holds = kick.expected_direction, kick.rule_holds
    facts = _Facts(
        top, _find_direction(top, after), Motion(top, before).turning_angles, motion.turning_angles
    )
    sentences = [change, facts.describe_motion(motion.is_driven), rule, facts.describe_lift()]
    contradictions = " and ".join(facts.contradictions(expected))
    if contradictions:
        verb = "holds" if holds else "fails"
        sentences.append(f"Although Perry's rule {verb}, {contradictions}.")
    if not motion.is_driven:
        sentences += filter(None, [_describe_average(motion)])
    return " ".join(sentences)


def _describe_average(motion: Motion) -> str:
    """Return sentences on the mean precession, its approximation, and a spin that reverses."""
    turns = motion.precession_per_nutation
    if not math.isfinite(turns):
        return ""
    rate, fast = motion.mean_precession_rate, motion.fast_top_precession_rate
    sentence = f"On average phi' is {format_rate(rate)} rad/s, {turns:.3f} turns in a nutation"
    top, omega_z = motion.top, float(motion.start.angular_velocity[2])
    # The approximation is for p_psi^2 >> 4 Ix |Mgl|; below that number it is not even a guess.
    if top.Mgl and abs(omega_z) > 2 * math.sqrt(top.Ix) * math.sqrt(abs(top.Mgl)) / top.Iz:
        sentence += f" (slow precession of a fast top: Mgl/p_psi = {format_rate(fast)} rad/s)"
    return f"{sentence}." + (" psi' changes sign in each nutation." if motion.spin_reverses else "")


@dataclass(frozen=True, slots=True)
class _Facts:
    """Direction after a kick, and the turning angles without it and with it, in rad."""

    top: Top
    direction: Direction
    before: tuple[float, float]
    after: tuple[float, float]

    def describe_motion(self, is_driven: bool) -> str:
        """Return the sentence on direction and turning angles."""
        condition = "without friction and applied torque " if is_driven else ""
        subject = _describe_direction(self.top, self.direction)
        return f"{subject}: {condition}{_describe_range(self.after)}."

    def describe_lift(self) -> str:
        """Return the sentence on the highest and the lowest point."""
        highest, lowest = map(_describe_lift, self._lifts)
        name = "highest point of the axis" if self.top.Mgl < 0 else "highest point"
        return f"Compared with no kick, the {name} is {highest} and the lowest point {lowest}."

    def contradictions(self, expected: Direction | None) -> Iterator[str]:
        """Yield the facts that are contrary to the direction in which theta'' changes."""
        if expected is None:
            return
        if self.direction not in (expected, "stays"):
            name = "axis" if self.top.Mgl < 0 else "top"
            yield f"the {name} {self.direction}"
        sign = 1 if expected == "rises" else -1
        for name, lift in zip(("highest", "lowest"), self._lifts, strict=True):
            if sign * lift < 0:
                yield f"the {name} point is {'higher' if lift > 0 else 'lower'}"

    @property
    def _lifts(self) -> tuple[float, float]:
        """Rise of the highest and of the lowest point in rad; 0 if rounding hides it."""
        highest, lowest = (
            was - now if abs(was - now) > SAME_ANGLE else 0.0
            for was, now in zip(self.before, self.after, strict=True)
        )
        return highest, lowest


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


def _describe_direction(top: Top, direction: Direction) -> str:
    if top.Mgl >= 0:
        return f"The top {direction}"
    return f"The axis {direction} (and the centre of mass {OPPOSITE[direction]})"


def _describe_vertical(top: Top, state: State) -> str:
    if any(state.angular_velocity[:2]):
        return "the precession rate is undefined on the vertical"
    stability = "stable" if top.sleeping_is_stable(state) else "unstable"
    return f"the axis sleeps on the vertical, where it is {stability}"


def _describe_range(angles: tuple[float, float]) -> str:
    low, high = (f"{angle:.3f}" for angle in angles)
    if low == high:
        return f"theta will stay at {low} rad"
    return f"theta will stay between {low} and {high} rad"


def _describe_lift(lift: float) -> str:
    if lift == 0:
        return "unchanged"
    return f"{abs(lift):.3g} rad {'higher' if lift > 0 else 'lower'}"
