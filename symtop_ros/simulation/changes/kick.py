"""The kick that a request asks for."""

from collections.abc import Mapping
from dataclasses import astuple
from typing import Any, NamedTuple

import numpy as np

from symtop_ros.physics import (
    HOLDS,
    Hold,
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    precession_rate,
    push_axle,
    set_precession_rate,
)
from symtop_ros.simulation.pushed import PushedMotion, Pushes
from symtop_ros.simulation.validation import (
    MAX_RATE,
    RefusedError,
    choice,
    exactly_one,
    number,
    reject,
    show,
    validate_names,
    vector,
)

KINDS = (
    "precession_rate",
    "precession_rate_change",
    "precession_rate_factor",
    "angular_impulse",
    "axle_impulse",
)
PUSHES = ("axle_impulse", "rate", "number")  # of a push
FIELDS = (*KINDS, "hold", *PUSHES[1:])
UNITS = {"precession_rate_factor": "", "axle_impulse": "N m s"}  # of others rad/s
MAX_IMPULSE = 1e30  # N m s; keeps the angular velocity after it finite for every top


def read_kick(texts: Mapping[str, str]) -> dict[str, Any]:
    """Return the request for a kick from the texts in its event."""

    def read(name: str, text: str) -> Any:
        if name == "hold":
            return text
        if name == "angular_impulse":
            return [*map(float, text.split())]
        return int(text) if text.lstrip("-").isdigit() else float(text)

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
    if kind.endswith("impulse") and "hold" in request:
        raise RefusedError(f"hold must be given without {kind}, got both")
    if kind == "angular_impulse":
        impulse = vector(kind, request[kind], 3, MAX_IMPULSE, "N m s, world frame")
        after = apply_impulse(top, state, impulse)
    else:
        hold = HOLDS[HOLDS.index(choice("hold", request.get("hold", HOLDS[0]), HOLDS))]
        hold = "spin_momentum" if kind == "axle_impulse" else hold
        after = _change_precession(top, state, kind, request[kind], hold)
    _limit_rates(kind, request, after)
    return Kick(Motion(top, after, motion.friction, motion.applied_torque), hold)


def name_kick(request: Mapping[str, Any]) -> str:
    """Return the name of the event that reports a request to ~/kick."""
    return "push" if "rate" in request or "number" in request else "kick"


def plan_pushes(motion: Motion, state: State, request: Mapping[str, Any]) -> PushedMotion:
    """Return the motion that follows if a state of a motion is pushed again and again."""
    validate_names(request, FIELDS)
    pushes = read_pushes(request, motion)
    try:
        pushed = PushedMotion(motion.top, push_axle(motion.top, state, pushes.impulse), pushes)
    except ValueError as error:  # a vertical axis, or a top that is too fast, then or later
        raise RefusedError(str(error)) from None
    _limit_rates("axle_impulse", request, pushed.pieces[-1].start)
    return pushed


def read_pushes(request: Mapping[str, Any], motion: Motion) -> Pushes:
    """Return the pushes that a request asks for, if a motion may get them."""
    given = [name for name in FIELDS if name in request]
    if {*given} != {*PUSHES}:
        raise RefusedError(f"pushes must have {', '.join(PUSHES)}, got {show(given)}")
    if motion.is_driven:
        acting = [*astuple(motion.friction), *motion.applied_torque]
        raise reject("friction and torque", "0 for a series of pushes", acting)
    return Pushes.read(*(request[name] for name in PUSHES))


def _limit_rates(kind: str, request: Mapping[str, Any], after: State) -> None:
    if not float(np.abs(after.angular_velocity).max()) <= MAX_RATE:
        condition = f"such that the top stays below {MAX_RATE:g} rad/s"
        raise reject(kind, condition, request[kind])


def _change_precession(top: Top, state: State, kind: str, value: Any, hold: Hold) -> State:
    rate = number(kind, value, UNITS.get(kind, "rad/s"))
    try:
        if kind == "axle_impulse":
            return push_axle(top, state, rate)
        if kind == "precession_rate":
            return set_precession_rate(state, rate, hold)
        if kind == "precession_rate_change":
            return set_precession_rate(state, precession_rate(state) + rate, hold)
        return hurry(state, rate, hold)
    except ValueError as error:  # a vertical axis, or a result that is not finite
        raise RefusedError(str(error)) from None
