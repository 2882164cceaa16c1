"""The consequences of a state: direction, turning angles and Perry's rule, as a record."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.arrays import Real
from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.rule.perry import (
    Direction,
    PrecessionChange,
    Reason,
    Subject,
    TiltAcceleration,
    VerticalCase,
    find_precession,
    name_subject,
)
from symtop_ros.physics.rule.verdicts import Verdicts, are_many, judge_each
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    START_ROUNDING,
    refuse,
    validate_number,
)
from symtop_ros.wording import write


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


@overload
def perrys_rule(
    top: Top, state: State, factor: float = 1.4, hold: Hold = "spin_rate"
) -> Verdict: ...


@overload
def perrys_rule(
    top: Top, state: State, factor: Sequence[float] | Real, hold: Hold = "spin_rate"
) -> Verdicts: ...


def perrys_rule(
    top: Top, state: State, factor: ArrayLike = 1.4, hold: Hold = "spin_rate"
) -> Verdict | Verdicts:
    """Return the motion that follows from a state, and Perry's rule for a kick at this state.

    Parameters
    ----------
    top : Top
        One top, or many of shape (...).
    state : State
        One state before the kick, or many of shape (...).
    factor : float or array_like (...)
        The kick multiplies phi' by it. Tops, states and factors are broadcast together.
    hold : {"spin_rate", "spin_momentum"}
        The quantity that the kick holds, as in `set_precession_rate`.

    Returns
    -------
    Verdict or Verdicts
        A record; if an argument is an array, a record of arrays (...), without a sentence.

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
    hold = validate_hold(hold)
    if are_many(top, state, factor):
        return judge_each(top, state, factor, partial(_judge, hold))
    return _judge(hold, top, state, validate_number("factor", factor))


def _judge(hold: Hold, top: Top, state: State, factor: float) -> Verdict:
    motion = Motion(top, state)
    if state.is_vertical:
        reason = Reason(classify_vertical(top, state), None, name_subject(top.Mgl))
        rates: tuple[float, ...] = ()
    else:
        kick = _plan_change(TiltAcceleration.of(top, state, hold), find_precession(state), factor)
        reason, rates = kick.explain(is_done=False), kick.tilt.quadratic.roots
    return Verdict(
        subject=name_subject(top.Mgl),
        direction=find_direction(top, state),
        turning_angles=motion.turning_angles,
        regular_rates=rates,
        rule_holds=None if reason.rule is None else reason.rule == "holds",
        reason=reason,
        average=find_average(motion),
    )


def _plan_change(tilt: TiltAcceleration, rate: float, factor: float) -> PrecessionChange:
    if abs(factor * rate) > LARGEST_ANGULAR_VELOCITY:
        condition = f"such that phi' stays within {LARGEST_ANGULAR_VELOCITY:g} rad/s"
        raise refuse("factor", condition, factor)
    return PrecessionChange(tilt, rate, factor * rate, factor)


def find_average(motion: Motion) -> Average | None:
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


def find_direction(top: Top, state: State) -> Direction:
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


def classify_vertical(top: Top, state: State) -> VerticalCase:
    """Return why the rule says nothing about an axis on the vertical."""
    if any(state.angular_velocity[:2]):
        return "undefined"
    return "stable" if top.sleeping_is_stable(state) else "unstable"
