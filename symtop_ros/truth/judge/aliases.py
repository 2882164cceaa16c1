"""Delays that explain the errors equally well, for motions that nearly repeat themselves.

In a steady precession a delay that is longer by a turn of the spin is equivalent to another
heading. So the least squares are profiled over the delay, with the best rotations for each delay.
All minima are kept that cannot be distinguished because of the noise, given the number of
independent estimates.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.truth.judge.causes import Cause

APART = 0.05  # rad by which the attitude turns between two minima, at least
EVEN = 1e-3  # of a period, by which delays of a family may be off


def gather(causes: Sequence[Cause], fastest: float) -> list[Cause]:
    """Return the minima that are apart, the smallest delay first.

    Attitudes turn with at most `fastest` rad/s.
    """
    kept: list[Cause] = []
    for each in sorted(causes, key=lambda each: each.cost):
        if all(abs(each.offset.delay - other.offset.delay) * fastest > APART for other in kept):
            kept.append(each)
    return sorted(kept, key=lambda each: abs(each.offset.delay))


def describe_family(members: Sequence[Cause]) -> dict[str, Any]:
    """Return the period of delays of one kind, and what it changes, by the names of a finding."""
    first = members[0].offset
    found = find_period(np.sort([each.offset.delay for each in members]))
    if found is None:
        return {}
    period: float = found
    # the next one, or the one before if there is none
    other = min(
        (each.offset for each in members[1:]),
        key=lambda e: (abs(e.delay - first.delay) > 1.5 * period, e.delay < first.delay),
    )
    count = round((other.delay - first.delay) / period)
    turned = find_rotation_vectors(compose(other.world, invert(first.world)))
    is_heading = members[0].level in ("none", "heading") and abs(count) == 1
    step = count * float(turned[2]) if is_heading else None
    return {"period": period, "repeated": other, "repeats": count, "heading_step": step}


def find_period(delays: Real) -> float | None:
    """Return the period of sorted delays, if all their differences are multiples of it."""
    steps = np.diff(delays)
    counts = np.rint(steps / steps.min())
    period = float((delays[-1] - delays[0]) / counts.sum())
    return period if np.abs(steps - counts * period).max() <= EVEN * period else None
