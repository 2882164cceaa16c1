"""The consequences of a state: direction, turning angles and Perry's rule, as a record."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.kicks import Hold, validate_hold
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.precession import stack_rates
from symtop_ros.physics.rule.perry import (
    Direction,
    Reason,
    Subject,
    TiltAcceleration,
    VerticalCase,
    explain_change,
    find_precession,
    name_subject,
)
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    START_ROUNDING,
    fit_shapes,
    refuse,
    validate_array,
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


@dataclass(frozen=True, eq=False)
class Verdicts:
    """The motions that follow from many states, and Perry's rule for a kick at each.

    Attributes
    ----------
    direction : ndarray (...) of str
        "rises", "falls" or "stays", as in `Verdict`.
    turning_angles : two ndarray (...)
        Smallest and largest theta in rad.
    regular_rates : two ndarray (...)
        Slow and fast rate of regular precession in rad/s; nan for a rate that there is not.
    rule_applies : ndarray (...) of bool
        False where Perry's rule says nothing.
    rule_holds : ndarray (...) of bool
        True where it holds.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, perrys_rule
    >>> tops = Top(Ix=0.000228, Iz=0.0000572, Mgl=[0.068, 0.2])
    >>> verdicts = perrys_rule(tops, State.from_euler(theta=0.5, phi_dot=9.0, psi_dot=200.0))
    >>> verdicts.direction.tolist(), verdicts.rule_holds.tolist()
    (['rises', 'falls'], [True, True])
    """

    direction: NDArray[np.str_]
    turning_angles: tuple[Real, Real]
    regular_rates: tuple[Real, Real]
    rule_applies: NDArray[np.bool_]
    rule_holds: NDArray[np.bool_]


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
    if top.shape or state.orientation.ndim > 1 or np.ndim(factor):
        return _judge_each(top, state, validate_array("factor", factor), hold)
    return _judge(top, state, validate_number("factor", factor), hold)


def _judge_each(top: Top, state: State, factors: Real, hold: Hold) -> Verdicts:
    """Return the verdicts on tops, states and factors that are broadcast together."""
    shapes = top.shape, state.orientation.shape[:-1], factors.shape
    shape = fit_shapes("top, state and factor", *shapes)
    moments = [np.broadcast_to(each, shape) for each in top.moments]
    q, omega = (np.broadcast_to(part, (*shape, part.shape[-1])) for part in state.parts)
    factors = np.broadcast_to(factors, shape)
    verdicts = [
        _judge(
            Top(*(float(each[n]) for each in moments)),
            State(q[n], omega[n]),
            float(factors[n]),
            hold,
        )
        for n in np.ndindex(shape)
    ]
    angles = np.array([verdict.turning_angles for verdict in verdicts]).reshape(-1, 2).T
    low, high = angles.reshape(2, *shape)
    holds = [verdict.rule_holds for verdict in verdicts]
    return Verdicts(
        direction=np.array([verdict.direction for verdict in verdicts], np.str_).reshape(shape),
        turning_angles=(low, high),
        regular_rates=stack_rates([verdict.regular_rates for verdict in verdicts], shape),
        rule_applies=np.array([each is not None for each in holds], np.bool_).reshape(shape),
        rule_holds=np.array([each is True for each in holds], np.bool_).reshape(shape),
    )


def _judge(top: Top, state: State, factor: float, hold: Hold) -> Verdict:
    motion = Motion(top, state)
    rates: tuple[float, ...] = ()
    if state.is_vertical:
        reason = explain_vertical(top, state)
    else:
        rate, tilt = find_precession(state), TiltAcceleration.of(top, state, hold)
        if abs(factor * rate) > LARGEST_ANGULAR_VELOCITY:
            condition = f"such that phi' stays within {LARGEST_ANGULAR_VELOCITY:g} rad/s"
            raise refuse("factor", condition, factor)
        reason = explain_change(tilt, rate, factor * rate, factor, is_done=False)
        rates = tilt.quadratic.roots
    return Verdict(
        subject=reason.subject,
        direction=find_direction(top, state),
        turning_angles=motion.turning_angles,
        regular_rates=rates,
        rule_holds=None if reason.rule is None else reason.rule == "holds",
        reason=reason,
        average=find_average(motion),
    )


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


def explain_vertical(top: Top, state: State) -> Reason:
    """Return why the rule says nothing about an axis on the vertical."""
    kind: VerticalCase = "stable" if top.sleeping_is_stable(state) else "unstable"
    if any(state.angular_velocity[:2]):
        kind = "undefined"
    return Reason(kind, None, name_subject(top.Mgl))
