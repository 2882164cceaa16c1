"""Refusals of a clamp and of a kick, which name what its user can change."""

from dataclasses import astuple
from typing import Any

from symtop_ros.base.refusals import RefusedError, refuse
from symtop_ros.physics import Friction, Motion, State

FRICTIONS = ("friction.axial", "friction.transverse")


def demand_clampable(motion: Motion, state: State) -> None:
    """Refuse `~/clamp` for what the motion has: friction, a torque, or a vertical axis."""
    for name, value in _list_acting(motion.friction, motion.applied_torque):
        raise refuse(name, "0 for ~/clamp", value)
    if _is_vertical(state):
        theta = state.euler_angles.theta
        raise refuse("theta", "> 0 and < pi rad for ~/clamp (no phi on the vertical)", theta)


def demand_held_start(state: State, friction: Friction, torque: Any) -> None:
    """Refuse a start that the parameter `initial.clamped` would hold and that cannot be held."""
    for name, value in _list_acting(friction, torque):
        raise refuse("initial.clamped", f"false together with {name} = {value}", True)
    if _is_vertical(state):
        theta = state.euler_angles.theta
        condition = f"false for a start on the vertical (theta = {theta:g} rad)"
        raise refuse("initial.clamped", condition, True)


def demand_free(motion: Motion, what: str) -> None:
    """Refuse what would act on a precession that a hand holds."""
    if motion.clamped:
        raise RefusedError(
            f"{what} must come while the precession is free, got it held: release it first "
            "(~/clamp with false)"
        )


def demand_tilted(state: State, kind: str) -> None:
    """Refuse a kick of the precession on the vertical, where it is undefined."""
    if _is_vertical(state):
        theta = state.euler_angles.theta
        raise refuse(
            "theta",
            f"> 0 and < pi rad for {kind} (no phi' on the vertical; an angular_impulse works)",
            theta,
        )


def _list_acting(friction: Friction, torque: Any) -> list[tuple[str, Any]]:
    numbers = zip(FRICTIONS, astuple(friction), strict=True)
    acting: list[tuple[str, Any]] = [(name, value) for name, value in numbers if value]
    total = [*map(float, torque)]
    return [*acting, ("steady_torque plus ~/applied_torque", total)] if any(total) else acting


def _is_vertical(state: State) -> bool:
    w, x, y, z = state.given_orientation.tolist()
    return bool((x == 0 and y == 0) or (w == 0 and z == 0))
