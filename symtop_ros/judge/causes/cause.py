"""A cause of errors: changes of convention, parameters, and what a search has found."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from symtop_ros.arrays import Real, compose, invert
from symtop_ros.judge.compare import NONE, Offset
from symtop_ros.judge.estimates import Estimates

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


@dataclass(frozen=True, eq=False)
class Cause:
    """One explanation, and what it leaves."""

    change: str
    level: str  # which rotations are free
    parameters: tuple[str, ...]
    offset: Offset
    cost: float  # mean square of the distances of quaternions
    # standard deviations of the parameters and of the rotations (rad), if what is left is noise;
    # none if they were not asked for
    deviations: tuple[float, ...] = ()
    turn_deviation: float = 0.0

    @property
    def weight(self) -> float:
        """Number of assumptions that it makes; smaller is simpler."""
        return CHANGES[self.change][0] + LEVELS[self.level][1] + len(self.parameters)

    @property
    def residual(self) -> float:
        """Root mean square of the angle that is left in rad."""
        return float(np.sqrt(4 * self.cost))

    @property
    def turns(self) -> float:
        """Sum of both rotations in rad."""
        return float(sum(self.offset.angles))

    @property
    def kind(self) -> tuple[str, str, tuple[str, ...]]:
        """Its kind, without numbers."""
        return self.change, self.level, self.parameters


NO_CAUSE = Cause("", "none", (), NONE, 0.0)


@dataclass(frozen=True, eq=False)
class Finding:
    """An explanation of the errors of estimates."""

    best: Cause
    others: tuple[Cause, ...] = ()  # as simple and as good
    hidden: tuple[str, ...] = ()
    explained: bool = True  # False: most of the error is left
    still: bool = False  # True: the estimates do not move, and the top does
    period: float | None = None  # s; delays that differ by it are as good, with `repeated`
    repeated: Offset = NONE


def set_parameter(offset: Offset, name: str, value: float) -> Offset:
    """Return an offset with a parameter; without a name, the same."""
    changed: dict[str, Any] = {name: value} if name else {}
    return replace(offset, **changed)


def _turn(change: Callable[[Real], Real]) -> Undoing:
    return lambda e: replace(e, orientations=change(e.orientations))


# Undoing each: its weight, and the rotations that may be free with it.
CHANGES: dict[str, tuple[float, tuple[str, ...], Undoing]] = {
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
