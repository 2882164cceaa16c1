"""What a kick request asks for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from symtop_ros.node.fields import (
    LARGEST_RATE,
    RefusedError,
    choice,
    exactly_one,
    number,
    numbers,
    refuse,
)
from symtop_ros.physics import Motion, State, Top, hurry, impulse, motion, set_precession_rate
from symtop_ros.physics.kicks import HOLDS, Hold, precession_rate

KINDS = (
    "precession_rate",
    "precession_rate_change",
    "precession_rate_factor",
    "angular_impulse",
)
NAMES = (*KINDS, "hold")


class Kicked(NamedTuple):
    """The motion after a kick, and what was held."""

    path: Motion
    hold: Hold


def kicked(path: Motion, state: State, values: Mapping[str, Any]) -> Kicked:
    """Return what a kick makes of a state on a path; RefusedError where it cannot be given."""
    top = path.top
    kind = exactly_one(values, KINDS)
    if kind == "angular_impulse":
        if "hold" in values:
            msg = "hold: got it together with angular_impulse, allowed is one or the other"
            raise RefusedError(msg)
        after = impulse(top, state, numbers(kind, values[kind], 3, LARGEST_RATE))
        hold: Hold = "spin_rate"
    else:
        hold = _hold(values)
        rate = number(kind, values[kind], -LARGEST_RATE, LARGEST_RATE)
        after = _with_rate(top, state, kind, rate, hold)
    largest = float(np.abs(after.angular_velocity).max())
    if not largest <= LARGEST_RATE:
        raise refuse(kind, values[kind], f"what leaves the top below {LARGEST_RATE:g} rad/s")
    return Kicked(motion(top, after, path.friction, path.applied_torque), hold)


def _with_rate(top: Top, state: State, kind: str, value: float, hold: Hold) -> State:
    try:
        if kind == "precession_rate":
            return set_precession_rate(top, state, value, hold)
        if kind == "precession_rate_change":
            return set_precession_rate(top, state, precession_rate(state) + value, hold)
        return hurry(top, state, value, hold)
    except ValueError as error:
        msg = f"{kind}: {error}"
        raise RefusedError(msg) from None


def _hold(values: Mapping[str, Any]) -> Hold:
    word = choice("hold", values.get("hold", HOLDS[0]), HOLDS)
    return "spin_momentum" if word == "spin_momentum" else "spin_rate"
