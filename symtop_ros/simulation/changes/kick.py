"""The kick that a request asks for."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from symtop_ros.physics import (
    HOLDS,
    Hold,
    Motion,
    State,
    apply_impulse,
    hurry,
    precession_rate,
    set_precession_rate,
)
from symtop_ros.simulation.validation import (
    MAX_RATE,
    RefusedError,
    choice,
    exactly_one,
    number,
    reject,
    validate_names,
    vector,
)

KINDS = (
    "precession_rate",
    "precession_rate_change",
    "precession_rate_factor",
    "angular_impulse",
)
FIELDS = (*KINDS, "hold")
MAX_IMPULSE = 1e30  # N m s; keeps the angular velocity after it finite for every top


def read_kick(texts: Mapping[str, str]) -> dict[str, Any]:
    """Return the request for a kick from the texts in its event."""

    def read(name: str, text: str) -> Any:
        if name == "hold":
            return text
        return [*map(float, text.split())] if name == "angular_impulse" else float(text)

    return {name: read(name, text) for name, text in texts.items()}


class Kick(NamedTuple):
    """A kick that was validated."""

    motion: Motion  # the motion after the kick
    hold: Hold | None  # the quantity that the kick leaves unchanged; None for an angular impulse


def plan_kick(motion: Motion, state: State, request: Mapping[str, Any]) -> Kick:
    """Return the motion that follows if a state of a motion is kicked."""
    validate_names(request, FIELDS)
    top, kind = motion.top, exactly_one(request, KINDS)
    hold: Hold | None = None
    if kind == "angular_impulse":
        if "hold" in request:
            raise RefusedError("hold must be given without angular_impulse, got both")
        impulse = vector(kind, request[kind], 3, MAX_IMPULSE, "N m s, world frame")
        after = apply_impulse(top, state, impulse)
    else:
        hold = HOLDS[HOLDS.index(choice("hold", request.get("hold", HOLDS[0]), HOLDS))]
        after = _change_precession(state, kind, request[kind], hold)
    if not float(np.abs(after.angular_velocity).max()) <= MAX_RATE:
        condition = f"such that the top stays below {MAX_RATE:g} rad/s"
        raise reject(kind, condition, request[kind])
    return Kick(Motion(top, after, motion.friction, motion.applied_torque), hold)


def _change_precession(state: State, kind: str, value: Any, hold: Hold) -> State:
    rate = number(kind, value, "" if kind.endswith("factor") else "rad/s")
    try:
        if kind == "precession_rate":
            return set_precession_rate(state, rate, hold)
        if kind == "precession_rate_change":
            return set_precession_rate(state, precession_rate(state) + rate, hold)
        return hurry(state, rate, hold)
    except ValueError as error:  # a vertical axis, or a result that is not finite
        raise RefusedError(str(error)) from None
