"""The axis of a rotation that was found, in words that help a user to correct it.

Mounts and conventions of axes differ by rotations that take the axes to each other: by a quarter or
a half of a turn about an axis, by a half about the diagonal of two axes, or by a third about the
diagonal of three. A rotation that agrees with one of these 23 within its deviation is called by its
name.
"""

import math
from itertools import product
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert

# Deviations of three numbers, whose root of the sum of squares is larger in one case of a thousand.
TELLING = 4.0
EXACT = 1e-6  # rad; of a rotation without a deviation
DECIMALS = 3  # of an axis without a deviation, and at most
AXES = "xyz"


def _list_axes() -> list[tuple[tuple[int, ...], int]]:
    """Return the axes of the 23 rotations in whole numbers, each with its degrees."""
    found = []
    for axis in product((1, 0, -1), repeat=3):
        count = sum(map(abs, axis))
        if count and next(each for each in axis if each) > 0:
            degrees = {1: (90, 180, -90), 2: (180,), 3: (120, -120)}[count]
            found += [(axis, each) for each in degrees]
    return found


TURNS = _list_axes()


def describe_axis(q: Real, deviation: float | None) -> dict[str, Any]:
    """Return the axis of a rotation (4,), as a record for a sentence.

    `deviation` is that of its angle in rad. The axis is not said where the angle may be zero.
    """
    vector = find_rotation_vectors(q).tolist()
    angle = math.hypot(*vector)
    room = TELLING * deviation if deviation else EXACT
    if angle <= room:
        return {"kind": "none"}
    for axis, degrees in TURNS:
        if _find_angle_between(q, axis, math.radians(degrees)) <= room:
            return {"kind": "named", "degrees": str(degrees), "axis": _name(axis)}
    places = min(max(math.ceil(-math.log10(room / angle)), 1), DECIMALS)
    words = ", ".join(f"{round(each / angle, places) + 0.0:.{places}f}" for each in vector)
    return {"kind": "vector", "axis": f"({words})"}


def _find_angle_between(q: Real, axis: tuple[int, ...], angle: float) -> float:
    """Return the angle in rad of the rotation that leads from one about an axis to another."""
    half = angle / 2
    other = np.array([math.cos(half), *np.multiply(axis, math.sin(half) / math.hypot(*axis))])
    return math.hypot(*find_rotation_vectors(compose(invert(other), q)).tolist())


def _name(axis: tuple[int, ...]) -> str:
    """Return the letter of an axis of the frame, or its direction."""
    count = sum(map(abs, axis))
    return AXES[axis.index(1)] if count == 1 else f"({', '.join(map(str, axis))})"
