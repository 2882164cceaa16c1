"""Verdicts on many states or tops: the fields of a verdict as arrays, and no sentence."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top
from symtop_ros.physics.values import refuse, validate_array

if TYPE_CHECKING:
    from symtop_ros.physics.rule.verdict import Verdict


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


def are_many(top: Top, state: State, factor: ArrayLike) -> bool:
    """Return True if one of the arguments is an array."""
    return bool(top.shape) or state.orientation.ndim > 1 or np.ndim(factor) > 0


def judge_each(
    top: Top, state: State, factor: ArrayLike, judge: Callable[[Top, State, float], "Verdict"]
) -> Verdicts:
    """Return the verdicts on tops, states and factors that are broadcast together."""
    factors = validate_array("factor", factor)
    shapes = top.shape, state.orientation.shape[:-1], factors.shape
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        listed = ", ".join(map(str, shapes))
        raise refuse("top, state and factor", "of shapes that fit together", listed) from None
    moments = [np.broadcast_to(each, shape) for each in top.moments]
    q, omega = (np.broadcast_to(part, (*shape, part.shape[-1])) for part in state.parts)
    factors = np.broadcast_to(factors, shape)
    return _collect(
        shape,
        [
            judge(
                Top(*(float(each[n]) for each in moments)),
                State(q[n], omega[n]),
                float(factors[n]),
            )
            for n in np.ndindex(shape)
        ],
    )


def _collect(shape: tuple[int, ...], verdicts: "list[Verdict]") -> Verdicts:
    rates = np.full((2, len(verdicts)), np.nan)
    for n, verdict in enumerate(verdicts):
        rates[: len(verdict.regular_rates), n] = verdict.regular_rates
    angles = np.array([verdict.turning_angles for verdict in verdicts]).reshape(-1, 2).T
    holds = [verdict.rule_holds for verdict in verdicts]
    (low, high), (slow, fast) = angles.reshape(2, *shape), rates.reshape(2, *shape)
    return Verdicts(
        direction=np.array([verdict.direction for verdict in verdicts], np.str_).reshape(shape),
        turning_angles=(low, high),
        regular_rates=(slow, fast),
        rule_applies=np.array([each is not None for each in holds], np.bool_).reshape(shape),
        rule_holds=np.array([each is True for each in holds], np.bool_).reshape(shape),
    )
