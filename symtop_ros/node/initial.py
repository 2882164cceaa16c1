"""Initial conditions: from the `initial.*` parameters and what a request says over them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from symtop_ros.node.fields import LARGEST_RATE, RefusedError, choice, number, numbers
from symtop_ros.physics import State, Top, regular_precession_rates

ANGLES = ("theta", "phi", "psi")
RATES = ("theta_dot", "phi_dot", "psi_dot")
DIRECT = ("orientation", "angular_velocity")
PRECESSIONS = ("slow", "fast")
NAMES = (*ANGLES, *RATES, *DIRECT, "precession")
LARGEST_ANGLE = 1e3  # rad


def initial_state(top: Top, defaults: Mapping[str, Any], given: Mapping[str, Any]) -> State:
    """Return the state that a request asks for.

    Parameters
    ----------
    top : Top
    defaults : mapping
        The `initial.*` parameters; an empty `precession` or `orientation` is not set.
    given : mapping
        Fields of the request. Missing ones are taken from the defaults.

    Raises
    ------
    RefusedError
        For missing or contradictory fields, values out of range, or where there is no such rate of
        regular precession.
    """
    _refuse_contradictions(given)
    if any(name in given for name in DIRECT):
        return _direct(given)
    if not given and len(defaults["orientation"]) > 0:
        return _direct(defaults)
    return _from_euler(top, {**defaults, **_without_default_precession(given)})


def _refuse_contradictions(given: Mapping[str, Any]) -> None:
    direct = [name for name in DIRECT if name in given]
    others = [name for name in NAMES if name in given and name not in DIRECT]
    if direct and others:
        msg = f"{direct[0]}: got it together with {', '.join(others)}, allowed is one or the other"
        raise RefusedError(msg)
    if len(direct) == 1:
        missing = next(name for name in DIRECT if name not in given)
        msg = f"{missing}: got none, allowed is {direct[0]} together with {missing}"
        raise RefusedError(msg)
    if "precession" in given and ("phi_dot" in given or given.get("theta_dot", 0.0) != 0.0):
        other = "phi_dot" if "phi_dot" in given else "theta_dot"
        msg = (
            f"precession: got it together with {other}, allowed is one or the other: "
            "a regular precession has its own phi_dot and theta_dot 0"
        )
        raise RefusedError(msg)


def _without_default_precession(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """A rate that is asked for goes before a regular precession that is only the default."""
    replaced = "phi_dot" in given or "theta_dot" in given
    return {**given, "precession": ""} if replaced else given


def _direct(values: Mapping[str, Any]) -> State:
    x, y, z, w = numbers("orientation", values["orientation"], 4, 2.0)
    omega = numbers("angular_velocity", values["angular_velocity"], 3, LARGEST_RATE)
    try:
        return State((w, x, y, z), omega)
    except ValueError as error:
        raise RefusedError(str(error)) from None


def _from_euler(top: Top, values: Mapping[str, Any]) -> State:
    theta = number("theta", values["theta"], 0.0, math.pi)
    angles = {name: number(name, values[name], -LARGEST_ANGLE, LARGEST_ANGLE) for name in ANGLES}
    rates = {name: number(name, values[name], -LARGEST_RATE, LARGEST_RATE) for name in RATES}
    if values["precession"]:
        which = choice("precession", values["precession"], PRECESSIONS)
        rates["phi_dot"] = _regular_rate(top, which, theta, rates["psi_dot"])
        rates["theta_dot"] = 0.0
    return State.from_euler(**angles, **rates)


def _regular_rate(top: Top, which: str, theta: float, psi_dot: float) -> float:
    rates = regular_precession_rates(top, theta=theta, psi_dot=psi_dot)
    roots = [rate for rate in rates if abs(rate) <= LARGEST_RATE]
    if len(roots) > PRECESSIONS.index(which):
        return roots[PRECESSIONS.index(which)]
    found = f"only {roots[0]:.6g} rad/s" if roots else "no real root"
    if len(roots) < len(rates):
        found += f" below {LARGEST_RATE:g} rad/s"
    msg = (
        f'precession: got "{which}", but at theta {theta:g} rad and psi_dot {psi_dot:g} rad/s '
        f"regular precession has {found}; allowed is another theta or psi_dot"
    )
    raise RefusedError(msg)
