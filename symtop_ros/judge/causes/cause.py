"""A cause of errors: changes of convention, parameters, and what a search has found."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from symtop_ros.arrays import Real, compose, invert
from symtop_ros.judge.causes.search import LEVELS
from symtop_ros.judge.compare import NONE, Offset
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import CLOCK, DELAY, DRIFT, SCALE, SPIN

PARAMETERS = {"delay": DELAY, "drift": DRIFT, "clock": CLOCK, "spin": SPIN, "scale": SCALE}
FLIP_WORLD = np.array([0.0, np.sqrt(0.5), np.sqrt(0.5), 0.0])  # east-north-up to north-east-down
FLIP_BODY = np.array([0.0, 1.0, 0.0, 0.0])  # forward-left-up to forward-right-down
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
    def kind(self) -> tuple[str, str, tuple[str, ...]]:
        """Its kind, without numbers."""
        return self.change, self.level, self.parameters


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


def measure_turns(offset: Offset) -> float:
    """Return the sum of both rotations in rad."""
    return float(sum(offset.angles))


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
