"""Initial conditions: the `initial.*` parameters, overridden by the fields of a request."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from symtop_ros.physics import Motion, State, Top, regular_precession_rates
from symtop_ros.simulation.settings import MAX_ANGLE, PRECESSIONS, InitialConditions, Settings
from symtop_ros.simulation.validation import (
    MAX_RATE,
    RefusedError,
    choice,
    number,
    validate_names,
    vector,
)

ANGLES = ("theta", "phi", "psi")
RATES = ("theta_dot", "phi_dot", "psi_dot")
DIRECT = ("orientation", "angular_velocity")
AT_REST = (0.0, 0.0, 0.0)
FIELDS = (*ANGLES, *RATES, *DIRECT, "precession")


def start_motion(settings: Settings) -> Motion:
    """Return the motion of a scene from its initial conditions."""
    start = initial_state(settings.top, settings.initial, {})
    return Motion(settings.top, start, settings.friction, settings.steady_torque)


def initial_state(top: Top, defaults: InitialConditions, request: Mapping[str, Any]) -> State:
    """Return the state that a request asks for."""
    validate_names(request, FIELDS)
    _refuse_contradictions(request)
    if any(name in request for name in DIRECT):
        return _from_quaternion(request["orientation"], request["angular_velocity"])
    if not request and defaults.orientation:
        return _from_quaternion(defaults.orientation, defaults.angular_velocity or AT_REST)
    initial = asdict(defaults)
    values = {name: initial[name] for name in (*ANGLES, *RATES, "precession")}
    if "phi_dot" in request or "theta_dot" in request:
        values["precession"] = ""  # a requested rate replaces the default of regular precession
    return _from_euler(top, {**values, **request})


def _refuse_contradictions(request: Mapping[str, Any]) -> None:
    direct = [name for name in DIRECT if name in request]
    others = [name for name in FIELDS if name in request and name not in DIRECT]
    if direct and others:
        raise RefusedError(f"{direct[0]} must be given without {', '.join(others)}, got both")
    if len(direct) == 1:
        missing = next(name for name in DIRECT if name not in request)
        raise RefusedError(f"{missing} must be given together with {direct[0]}, got none")
    if "precession" in request and ("phi_dot" in request or request.get("theta_dot", 0.0) != 0.0):
        other = "phi_dot" if "phi_dot" in request else "theta_dot"
        raise RefusedError(
            f"precession must be given without {other}, got both "
            "(regular precession determines phi_dot, and theta_dot is 0)"
        )


def _from_quaternion(orientation: Any, angular_velocity: Any) -> State:
    x, y, z, w = vector("orientation", orientation, 4, 2.0, "x, y, z, w")
    omega = vector("angular_velocity", angular_velocity, 3, MAX_RATE, "rad/s, body frame")
    try:
        return State((w, x, y, z), omega)
    except ValueError as error:  # the norm
        raise RefusedError(str(error)) from None


def _from_euler(top: Top, values: Mapping[str, Any]) -> State:
    theta = number("theta", values["theta"], "rad", 0.0, math.pi)
    angles = {name: number(name, values[name], "rad", -MAX_ANGLE, MAX_ANGLE) for name in ANGLES}
    rates = {name: number(name, values[name], "rad/s", -MAX_RATE, MAX_RATE) for name in RATES}
    if values["precession"]:
        which = choice("precession", values["precession"], PRECESSIONS)
        rates["phi_dot"] = _regular_rate(top, which, theta, rates["psi_dot"])
        rates["theta_dot"] = 0.0
    return State.from_euler(**angles, **rates)


def _regular_rate(top: Top, which: str, theta: float, psi_dot: float) -> float:
    rates = regular_precession_rates(top, theta=theta, psi_dot=psi_dot)
    roots = [float(rate) for rate in rates if abs(rate) <= MAX_RATE]
    if len(roots) > PRECESSIONS.index(which):
        return roots[PRECESSIONS.index(which)]
    count = f"only {roots[0]:.6g} rad/s" if roots else "no real root"
    if len(roots) < len(rates):
        count += f" up to {MAX_RATE:g} rad/s"
    raise RefusedError(
        f'precession must be a rate that exists, got "{which}": at theta {theta:g} rad and psi_dot '
        f"{psi_dot:g} rad/s regular precession has {count}"
    )
