"""Causes of errors: a change of convention, rotations of the frames, and parameters.

A mistake of convention is found by undoing it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose, invert
from symtop_ros.truth.judge.alignment import PARAMETERS, Alignment
from symtop_ros.truth.judge.compare import NONE, Offset
from symtop_ros.truth.judge.permutations import list_permutations
from symtop_ros.truth.judge.stamps import Steps
from symtop_ros.truth.judge.swing import Swing
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates

# Which rotations are free, with their columns of derivatives, and how much each counts when the
# simplest explanation is looked for.
LEVELS: dict[str, tuple[tuple[int, ...], float]] = {
    "none": ((), 0.0),
    "heading": ((2,), 1.0),
    "world": ((0, 1, 2), 2.5),
    "body": ((3, 4, 5), 2.5),
    "both": ((0, 1, 2, 3, 4, 5), 5.0),
}
# East-north-up to north-east-down, and forward-left-up to forward-right-down.
FLIP_WORLD, FLIP_BODY = np.array([[0.0, np.sqrt(0.5), np.sqrt(0.5), 0.0], [0.0, 1.0, 0.0, 0.0]])
ALL = tuple(LEVELS)
Undoing = Callable[[Estimates], Estimates]
SIGNIFICANT = 6.0  # deviations: thousands of values are tried


@dataclass(frozen=True, eq=False)
class Cause:
    """One explanation, and its residual."""

    change: str
    level: str  # which rotations are free
    parameters: tuple[str, ...]
    offset: Offset
    cost: float  # mean square of the distances of quaternions
    # standard deviations of the parameters, and of the angles (rad) of world and body; none if they
    # were not asked for, or cannot be given
    deviations: tuple[float, ...] = ()
    turn_deviations: tuple[float, ...] = ()
    # without deviations: changes of the parameters and angles with an effect as large as the
    # residual
    seen: tuple[float, ...] = ()
    turn_seen: float | None = None
    independent: float | None = (
        None  # number of independent estimates, if deviations were asked for
    )
    fault: str = ""  # why there are no deviations: "few", "wanders"
    correlation_time: float = 0.0  # s
    rms: float | None = None  # rad, of the angles that are left, if deviations were asked for

    @property
    def weight(self) -> float:
        """Number of assumptions that it makes; smaller is simpler."""
        return CHANGES[self.change][0] + LEVELS[self.level][1] + len(self.parameters)

    @property
    def residual(self) -> float:
        """Root mean square of the remaining angle in rad; estimated if it was not computed."""
        return float(np.sqrt(4 * self.cost)) if self.rms is None else self.rms

    @property
    def turns(self) -> float:
        """Sum of both rotations in rad."""
        return float(sum(self.offset.angles))

    @property
    def kind(self) -> tuple[str, str, tuple[str, ...]]:
        """Kind of the cause, without numbers."""
        return self.change, self.level, self.parameters

    @property
    def columns(self) -> list[int]:
        """Columns of the derivatives that are free."""
        return [*LEVELS[self.level][0], *(PARAMETERS[name] for name in self.parameters)]

    @property
    def count(self) -> int:
        """Number of parameters and components of rotations."""
        return len(self.columns)

    @property
    def is_significant(self) -> bool:
        """True if all parameters and rotations differ from zero by many deviations."""
        sizes = [abs(getattr(self.offset, name)) for name in self.parameters]
        pairs = [*zip(sizes, self.deviations, strict=True)] if self.deviations else []
        turned = zip(self.offset.angles, self.turn_deviations, strict=False)
        pairs += [(size, deviation) for size, deviation in turned if deviation]
        return all(size > SIGNIFICANT * deviation for size, deviation in pairs)


@dataclass(frozen=True, eq=False)
class Finding:
    """An explanation of the errors of estimates."""

    best: Cause
    others: tuple[Cause, ...] = ()  # as simple and as good
    hidden: tuple[str, ...] = ()
    explained: bool = True  # False: most of the error is left
    fault: str = ""  # why no cause is given: "few", "wanders"
    # a cause that gains more than chance does, but leaves more than noise: it explains a part
    candidate: Cause | None = None
    still: bool = False  # True: the estimates do not move, and the top does
    aliases: tuple[Cause, ...] = ()  # the same with other delays, which are as good
    period: float | None = None  # s; delays that differ by it are as good, with `repeated`
    repeated: Offset = NONE
    repeats: int = 1  # number of periods between `best` and `repeated`
    heading_step: float | None = None  # rad; the heading grows by it, and no other rotation
    nearest: Cause | None = None  # the cause with the smallest residual, if none is named
    # largest part of the root mean square that a cause explains, if none is named
    share: float = 0.0
    same: Cause | None = None  # rotations that are the same as the delay in a steady motion
    # rates (rad/s) of `precession` and `spin`, by which an unknown delay turns world and body
    turning: Mapping[str, float] | None = None
    steps: Steps | None = None  # of stamps, which explain the rest
    swing: Swing | None = None  # the strongest line of the residuals, unless all is explained

    @property
    def said(self) -> Cause:
        """The cause that sentences and keys describe: the named one, or else the candidate."""
        return self.candidate or self.best


def set_parameter(offset: Offset, name: str, value: float) -> Offset:
    """Return an offset with a parameter; without a name, the same."""
    changed: dict[str, Any] = {name: value} if name else {}
    return replace(offset, **changed)


def _turn(change: Callable[[Real], Real]) -> Undoing:
    return lambda e: replace(e, orientations=change(e.orientations))


# Undoing each: its weight, and the rotations that may be free with it.
CONVENTIONS: dict[str, tuple[float, tuple[str, ...], Undoing]] = {
    "": (0.0, ALL, lambda e: e),
    "order": (1.0, ALL, _turn(lambda q: q[:, [3, 0, 1, 2]])),
    "conjugate": (1.0, ALL, _turn(invert)),
    # These are the same as rotations of both frames, so few rotations are free with them.
    "conjugate_order": (1.0, ALL[:3], _turn(lambda q: invert(q[:, [3, 0, 1, 2]]))),
    "frame": (1.0, ALL[:3], lambda e: replace(e, of_sensor=not e.of_sensor)),
    "ned": (1.0, ALL[:2], _turn(lambda q: compose(FLIP_WORLD, q))),
    "frd": (1.0, ALL[:2], _turn(lambda q: compose(q, FLIP_BODY))),
    "ned_frd": (1.0, ALL[:2], _turn(lambda q: compose(compose(FLIP_WORLD, q), FLIP_BODY))),
}
# A half turn of one frame is simpler than mixed columns that are the same.
PERMUTED = {each.name: each for each in list_permutations()}
CHANGES = CONVENTIONS | {name: (1.5, ALL[:2], _turn(each.undo)) for name, each in PERMUTED.items()}


class Fits(dict[str, Alignment]):
    """Fits of the estimates after a change is undone, computed when they are needed."""

    def __init__(self, estimates: Estimates, truth: Truth) -> None:
        super().__init__()
        self._estimates, self._truth = estimates, truth

    def __missing__(self, change: str) -> Alignment:
        """Return the fit of a change."""
        self[change] = Alignment(CHANGES[change][2](self._estimates), self._truth)
        return self[change]
