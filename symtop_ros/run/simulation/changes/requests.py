"""The start or the kick that a request asks for.

A start has the `initial.*` parameters, overridden by the fields of the request.
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import astuple, replace
from pathlib import Path
from typing import Any

from symtop_ros.base.refusals import (
    RefusedError,
    choice,
    exactly_one,
    number,
    refuse,
    show,
    validate_names,
    vector,
)
from symtop_ros.physics import (
    HOLDS,
    MOST_PUSHES,
    PUSH_RATES,
    ExactTimes,
    Hold,
    Motion,
    Pushes,
    State,
    Top,
    apply_impulse,
    hurry,
    precession_rate,
    push_axle,
    regular_precession_rates,
    set_precession_rate,
)
from symtop_ros.run.simulation.changes.obstacles import (
    demand_clampable,
    demand_free,
    demand_held_start,
    demand_tilted,
)
from symtop_ros.run.simulation.changes.seen import (
    SEEN,
    SOLUTION,
    Solved,
    asks_to_solve,
    solve_request,
)
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import (
    ANGLES,
    MAX_ANGLE,
    MAX_MOMENT,
    MAX_RATE,
    PRECESSIONS,
    RATES,
    InitialConditions,
    Settings,
)

# What ~/kick and a kick of run.json ask for. A kind of kick has the name of symtop_kick_kind, and
# what it holds: a hold, null for nothing, or the one that is `chosen`.
FIELDS = json.loads(Path(__file__).parents[1].joinpath("run_fields.json").read_text("utf-8"))["act"]
KINDS = tuple(name for name, field in FIELDS.items() if "kick" in field)
PUSHES = ("axle_impulse", "rate", "number")  # of a push
KICK_FIELDS = (*KINDS, "hold", *PUSHES[1:])
LARGEST_IMPULSE = 1e30  # N m s
DIRECT = ("orientation", "angular_velocity")
START_FIELDS = (*ANGLES, *RATES, *DIRECT, "precession")
# What ~/set_initial_conditions knows, besides what is seen of a motion.
ALL_START_FIELDS = (*START_FIELDS, *SEEN, SOLUTION)
# Fields of requests that are words or vectors; all others are numbers.
NOT_NUMBERS = (*DIRECT, "precession", "hold", *(name for name in KINDS if "size" in FIELDS[name]))


def read_kick(texts: Mapping[str, str]) -> dict[str, Any]:
    """Return the request for a kick from the texts in its event."""

    def read(name: str, text: str) -> Any:
        if name == "hold":
            return text
        if name == "angular_impulse":
            return [*map(float, text.split())]
        return int(text) if text.lstrip("-").isdigit() else float(text)

    return {name: read(name, text) for name, text in texts.items()}


def plan_kick(
    motion: Motion, state: State, request: Mapping[str, Any]
) -> tuple[Motion, Hold | None]:
    """Return the motion that follows if a state of a motion is kicked, and what the kick holds.

    That is the quantity that it leaves unchanged; None for an angular impulse.
    """
    validate_names(request, KICK_FIELDS)
    demand_free(motion, "kick")
    kind = exactly_one(request, KINDS)
    hold = find_hold(request)
    if "hold" in request and FIELDS[kind]["holds"] != "chosen":
        raise RefusedError(f"hold must be given without {kind}, got both")
    amount = _read_amount(kind, request[kind])
    if kind != "angular_impulse":
        demand_tilted(state, kind)
    try:
        after = KICKS[kind](motion.top, state, amount, hold)
    except ValueError:  # the amount is too large for a state of the kernel
        raise _refuse_rates(kind, request) from None
    _limit_rates(kind, request, after)
    return motion.restart(after), hold


def find_hold(request: Mapping[str, Any]) -> Hold | None:
    """Return what a kick of one kind holds; None for an angular impulse."""
    held = FIELDS[exactly_one(request, KINDS)]["holds"]
    if held is None:
        return None
    word = request.get("hold", HOLDS[0]) if held == "chosen" else held
    return choice("hold", word, HOLDS)


def _read_amount(kind: str, value: Any) -> Any:
    field = FIELDS[kind]
    if "size" in field:
        return vector(kind, value, field["size"], MAX_MOMENT, field["unit"])
    return number(kind, value, field["unit"])


# What each kind makes of the top, a state, the amount, and what is held.
KICKS: dict[str, Callable[[Top, State, Any, Any], State]] = {
    "precession_rate": lambda _, state, rate, hold: set_precession_rate(state, rate, hold),
    "precession_rate_change": lambda _, state, change, hold: set_precession_rate(
        state, precession_rate(state) + change, hold
    ),
    "precession_rate_factor": lambda _, state, factor, hold: hurry(state, factor, hold),
    "angular_impulse": lambda top, state, impulse, _: apply_impulse(top, state, impulse),
    "axle_impulse": lambda top, state, impulse, _: push_axle(top, state, impulse),
}


def name_kick(request: Mapping[str, Any]) -> str:
    """Return the name of the event that reports a request to ~/kick."""
    return "push" if "rate" in request or "number" in request else "kick"


def plan_pushes(motion: Motion, state: State, request: Mapping[str, Any]) -> tuple[Motion, Pushes]:
    """Return the motion that follows if a state of a motion is pushed again and again."""
    validate_names(request, KICK_FIELDS)
    demand_free(motion, "pushes")
    pushes = read_pushes(request)
    demand_tilted(state, "axle_impulse")
    first = push_axle(motion.top, state, pushes.impulse)
    pushed = Motion(motion.top, first, motion.friction, motion.applied_torque, pushes)
    # Under gravity alone all pushes are tried; a driven motion would have to be integrated up to
    # the last one.
    end = ExactTimes(pushes.last_time)
    last = first if motion.is_driven else pushed.piece_at(end).motion.start
    _limit_rates("axle_impulse", request, last)
    return pushed, pushes


def plan_clamp(motion: Motion, state: State) -> Motion:
    """Return the motion that follows if a hand begins to hold the precession of a motion."""
    if motion.clamped:
        raise RefusedError("clamp must come while the precession is free, got it held")
    demand_clampable(motion, state)
    return Motion(motion.top, state, clamped=True)


def plan_unclamp(motion: Motion, state: State) -> Motion:
    """Return the motion that follows if that hand lets go."""
    if not motion.clamped:
        raise RefusedError("unclamp must come while the precession is held, got it free")
    return motion.restart(state)


def plan_release(segment: Segment, stamp: int) -> tuple[Segment, Pushes]:
    """Return the segment without pushes after a stamp (ns), and those before it."""
    given = segment.count_pushes(stamp)
    pushes = segment.motion.pushes
    if not (pushes and given and given < pushes.number):
        raise RefusedError("release must follow pushes that have not ended, got none")
    ended = replace(pushes, number=given)
    return replace(segment, motion=segment.motion.end_pushes(given)), ended


def read_pushes(request: Mapping[str, Any]) -> Pushes:
    """Return the pushes that a request asks for."""
    given = [name for name in KICK_FIELDS if name in request]
    if {*given} != {*PUSHES}:
        raise RefusedError(f"pushes must have {', '.join(PUSHES)}, got {show(given)}")
    count = number("number", request["number"], "", 1, MOST_PUSHES)
    if not count.is_integer():
        raise refuse("number", f"a whole number up to {MOST_PUSHES}", request["number"])
    return Pushes(
        number("axle_impulse", request["axle_impulse"], "N m s", -LARGEST_IMPULSE, LARGEST_IMPULSE),
        number("rate", request["rate"], "pushes per s of the motion", *PUSH_RATES),
        int(count),
    )


def name_pushes(pushes: Pushes) -> dict[str, float]:
    """Return the fields of ~/kick that ask for pushes."""
    return dict(zip(PUSHES, astuple(pushes), strict=True))


def _limit_rates(kind: str, request: Mapping[str, Any], after: State) -> None:
    if max(map(abs, after.angular_velocity.tolist())) > MAX_RATE:
        raise _refuse_rates(kind, request)


def _refuse_rates(kind: str, request: Mapping[str, Any]) -> RefusedError:
    what = "such that angular_velocity has components of at most"
    return refuse(kind, f"{what} {MAX_RATE:g} rad/s (body frame)", request[kind])


def start_motion(settings: Settings) -> Motion:
    """Return the motion of a scene from its initial conditions."""
    start = initial_state(settings.top, settings.initial, {})
    clamped = settings.initial.clamped
    acting = settings.friction, settings.steady_torque
    if clamped:
        demand_held_start(start, *acting)
    return Motion(settings.top, start, *acting, clamped=clamped)


def plan_start(
    top: Top, defaults: InitialConditions, request: Mapping[str, Any]
) -> tuple[State, Solved | None]:
    """Return the state that a request asks for, and its solution if it says what is seen."""
    if not asks_to_solve(request):
        return initial_state(top, defaults, request), None
    solved = solve_request(top, defaults, request, START_FIELDS)
    if defaults.clamped:
        solved = replace(solved, caveat="held")
    return solved.start, solved


def initial_state(top: Top, defaults: InitialConditions, request: Mapping[str, Any]) -> State:
    """Return the state that a request asks for."""
    validate_names(request, ALL_START_FIELDS)
    _refuse_contradictions(request)
    if any(name in request for name in DIRECT):
        return _from_quaternion(request["orientation"], request["angular_velocity"])
    if not request and defaults.orientation:
        return _from_quaternion(defaults.orientation, defaults.angular_velocity or (0.0, 0.0, 0.0))
    values = {name: getattr(defaults, name) for name in (*ANGLES, *RATES, "precession")}
    if "phi_dot" in request or "theta_dot" in request:
        values["precession"] = ""  # a requested rate replaces the default of regular precession
    name = "precession" if "precession" in request else "initial.precession"
    return _from_euler(top, {**values, **request}, name)


def _refuse_contradictions(request: Mapping[str, Any]) -> None:
    direct = [name for name in DIRECT if name in request]
    others = [name for name in START_FIELDS if name in request and name not in DIRECT]
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
    return State((w, x, y, z), omega)


def _from_euler(top: Top, values: Mapping[str, Any], name: str) -> State:
    theta = number("theta", values["theta"], "rad", 0.0, math.pi)
    angles = {name: number(name, values[name], "rad", -MAX_ANGLE, MAX_ANGLE) for name in ANGLES}
    rates = {name: number(name, values[name], "rad/s", -MAX_RATE, MAX_RATE) for name in RATES}
    if values["precession"]:
        which = choice("precession", values["precession"], PRECESSIONS)
        rates |= {
            "phi_dot": _regular_rate(top, which, theta, rates["psi_dot"], name),
            "theta_dot": 0.0,
        }
    return State.from_euler(**angles, **rates)


def _regular_rate(top: Top, which: str, theta: float, psi_dot: float, name: str) -> float:
    """Return a root of regular precession; `name` is that of what asks for it."""
    found = regular_precession_rates(top, theta=theta, psi_dot=psi_dot)
    rates = [float(rate) for rate in found if not math.isnan(rate)]
    roots = [rate for rate in rates if abs(rate) <= MAX_RATE]
    if len(roots) > PRECESSIONS.index(which):
        return roots[PRECESSIONS.index(which)]
    count = f"only {roots[0]:.6g} rad/s" if roots else "no real root"
    if not rates and top.Mgl == 0:  # and neither spin nor centrifugal torque
        count = "every rate, none of them slow or fast"
    if len(roots) < len(rates):
        count += f" up to {MAX_RATE:g} rad/s"
    exists = "a rate that exists" + (", or empty" if name.startswith("initial.") else "")
    raise RefusedError(
        f'{name} must be {exists}, got "{which}": at theta {theta:g} rad and psi_dot '
        f"{psi_dot:g} rad/s regular precession has {count}"
    )
