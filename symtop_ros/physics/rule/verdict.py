"""The consequences of a state: direction, turning angles and Perry's rule, as a record."""

import math
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.base.arrays import Real, split
from symtop_ros.base.one_or_many import Many
from symtop_ros.base.refusals import refuse
from symtop_ros.physics.arguments import NO_FRICTION, NO_TORQUE, list_starts
from symtop_ros.physics.kernel import bindings, records
from symtop_ros.physics.kernel.records import (
    DIRECTIONS,
    LIFT_KINDS,
    SENSES,
    SUBJECTS,
    Direction,
    Hold,
    Subject,
    VerdictRecord,
)
from symtop_ros.physics.kicks import HOLDS, validate_hold
from symtop_ros.physics.rule.cause import Cause, read_cause
from symtop_ros.physics.rule.means import MeanChange, read_means
from symtop_ros.physics.rule.perry import VERTICAL, Average, Reason, read_average, read_reason
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import (
    LARGEST_ANGULAR_VELOCITY,
    fit_shapes,
    validate_array,
    validate_number,
)
from symtop_ros.words import write


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
        theta' = 0. A change of less than 1e-7 rad counts as "stays".
    turning_angles : (float, float)
        Smallest and largest theta in rad from this state on, without the kick.
    regular_rates : (float, float)
        Slow and fast rate of regular precession in rad/s, at this tilt and at the spin rate or spin
        momentum that the kick holds; nan for a rate that does not exist, and on the vertical.
    rule_holds : bool or None
        True if Perry's rule holds for the axis; None if it says nothing. For Mgl < 0 the rule is
        the opposite for the centre of mass, which lies on the other side of the pivot.
    reason : Reason
        The reason: theta'' with the kick and without it.
    average : Average or None
        Mean precession and its fast-top approximation; None if the mean precession is undefined.
    means : MeanChange or None
        Means of the motion with the kick that is considered, compared with no kick: the sense of
        the kick against the mean precession, and the mean height. None if they are undefined, and
        for a kick that changes nothing.
    cause : Cause
        Why the axis moves as it does.

    Examples
    --------
    >>> from symtop_ros.physics import State, Top, perrys_rule
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> verdict = perrys_rule(top, State.from_euler(theta=0.5, phi_dot=9.0, psi_dot=200.0))
    >>> print(verdict)  # doctest: +NORMALIZE_WHITESPACE
    At this instant: the axis moves up. Perry's rule holds: hurried from 9.00 to 12.60 rad/s,
    theta'' would be -110 instead of -48 rad/s^2 (9.00 rad/s lies between the rates of regular
    precession, 6.50 and 69.82 rad/s, at this spin rate). From now on: theta will stay between 0.439
    and 0.500 rad. On average phi' is 6.42 rad/s (one turn in 0.979 s), 0.157 turns per nutation
    (slow precession of a fast top: Mgl/p_psi = 5.72 rad/s). Such a kick would be along the mean
    precession, and the mean height would rise (mean of cos(theta): 0.908 instead of 0.891).
    """

    subject: Subject
    direction: Direction
    turning_angles: tuple[float, float]
    regular_rates: tuple[float, float]
    rule_holds: bool | None
    reason: Reason
    average: Average | None
    means: MeanChange | None
    cause: Cause

    def __str__(self) -> str:
        """Return what holds at this instant, from now on, and in the mean, in sentences."""
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
        Slow and fast rate of regular precession in rad/s; nan for a rate that does not exist.
    rule_applies : ndarray (...) of bool
        False where Perry's rule says nothing.
    rule_holds : ndarray (...) of bool
        True where it holds.
    sense : ndarray (...) of str
        "along" or "against" the mean precession, "" where nothing is said, as in `MeanChange`.
    mean_height : ndarray (...) of str
        Change of the mean height of the axis: "higher", "lower" or "unchanged"; "" where the means
        are undefined.

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
    sense: NDArray[np.str_]
    mean_height: NDArray[np.str_]


@overload
def perrys_rule(
    top: Top[float], state: State[float], factor: float = 1.4, hold: Hold = "spin_rate"
) -> Verdict: ...


@overload
def perrys_rule(
    top: Top[Real], state: State, factor: ArrayLike = 1.4, hold: Hold = "spin_rate"
) -> Verdicts: ...


@overload
def perrys_rule(
    top: Top, state: State[Real], factor: ArrayLike = 1.4, hold: Hold = "spin_rate"
) -> Verdicts: ...


@overload
def perrys_rule(top: Top, state: State, factor: Many, hold: Hold = "spin_rate") -> Verdicts: ...


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
    factor = validate_number("factor", factor)
    found: Any = _judge(top, state, np.array([factor]), (), hold)
    return _read(VerdictRecord.from_buffer(found.view(np.uint8)), hold)


def _judge(
    top: Top, state: State, factors: Real, shape: tuple[int, ...], hold: Hold
) -> NDArray[Any]:
    """Return the kernel's verdicts (n,) on tops and states of a shape, and on factors (n,)."""
    starts = list_starts(top, state, NO_FRICTION, NO_TORQUE, shape)
    verdicts, status = bindings.judge(starts, factors, HOLDS.index(hold))
    if status == records.BAD_KICK:
        raise refuse(
            "factor",
            f"such that phi' stays within {LARGEST_ANGULAR_VELOCITY:g} rad/s",
            float(factors[len(verdicts)]),
        )
    bindings.demand(status)
    return verdicts


def _read(found: VerdictRecord, hold: Hold) -> Verdict:
    reason = read_reason(found, hold)
    low, high = found.turning_angles
    return Verdict(
        subject=SUBJECTS[found.subject],
        direction=DIRECTIONS[found.direction],
        turning_angles=(low, high),
        regular_rates=reason.place.regular_rates if reason.place else (math.nan, math.nan),
        rule_holds=None if reason.rule is None else reason.rule == "holds",
        reason=reason,
        average=read_average(found.average),
        means=read_means(found.means, SUBJECTS[found.subject]),
        cause=read_cause(found.cause, SUBJECTS[found.subject]),
    )


def _judge_each(top: Top, state: State, factors: Real, hold: Hold) -> Verdicts:
    """Return the verdicts on tops, states and factors that are broadcast together."""
    shape = fit_shapes(
        "top, state and factor", top.shape, state.orientation.shape[:-1], factors.shape
    )
    spread = np.array(np.broadcast_to(factors, shape)).reshape(-1)
    found = _judge(top, state, spread, shape, hold).reshape(shape)
    reasons = found["reason"]
    is_tilted = (reasons["kind"] < VERTICAL)[..., None]
    slow, fast = split(np.where(is_tilted, reasons["place"]["regular_rates"], np.nan))
    low, high = split(found["turning_angles"])
    means = found["means"]
    has_means = ~np.isnan(means["cosines"][..., 0])
    return Verdicts(
        direction=np.take(DIRECTIONS, found["direction"]),
        turning_angles=(low.copy(), high.copy()),
        regular_rates=(slow.copy(), fast.copy()),
        rule_applies=reasons["rule"] != 0,
        rule_holds=reasons["rule"] == 1,
        sense=np.take([name or "" for name in SENSES], means["sense"]),
        mean_height=np.where(has_means, np.take(LIFT_KINDS, means["height"]), ""),
    )
