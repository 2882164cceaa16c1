"""Changes of convention, each with the function that undoes it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.causes.search import LEVELS
from symtop_ros.judge.estimates import Estimates
from symtop_ros.quaternions import compose, invert

FLIP_WORLD = np.array([0.0, np.sqrt(0.5), np.sqrt(0.5), 0.0])  # east-north-up to north-east-down
FLIP_BODY = np.array([0.0, 1.0, 0.0, 0.0])  # forward-left-up to forward-right-down
ALL = tuple(LEVELS)
Change = Callable[[Estimates], Estimates]


def _turn(change: Callable[[Real], Real]) -> Change:
    return lambda e: replace(e, orientations=change(e.orientations))


# Undoing each: its weight, and the rotations that may be free with it.
CHANGES: dict[str, tuple[float, tuple[str, ...], Change]] = {
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
