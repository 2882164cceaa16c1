"""Compute what `top_ctl` asks of the top: a start from what is seen, a body of parts.

The library is imported where it is needed, so that other commands start without it.
"""

import json
import math
from typing import TYPE_CHECKING, Any

from symtop_ros.base.refusals import RefusedError, refuse, require, validate_names
from symtop_ros.base.units import parse_quantity
from symtop_ros.ros.client.connection import Connection
from symtop_ros.run.session.services import Response

if TYPE_CHECKING:
    from symtop_ros.physics import Body, Part, Solution

# Names that are of no start: something is asked for.
SEEN = frozenset(
    ("precession_period", "dip", "nutation_period", "energy", "p_phi", "p_psi", "alpha", "a", "b")
)
KNOWN = SEEN | {"theta", "psi_dot"}  # of which a question is made
BESIDE = ("phi", "psi")  # angles of a start that no question knows
MEASURED = {"gravity": "m/s^2", "Ix": "kg m^2", "Iz": "kg m^2"}  # Ix about the pivot
UNITS = {"mass": "kg", "size": "m", "distance": "m"}


def asks_to_solve(values: dict[str, Any]) -> bool:
    """Return True if a start has to be found from what is seen."""
    return not SEEN.isdisjoint(values)


def start_solved(top: Connection, values: dict[str, Any]) -> Response:
    """Start the solution that is asked for, and list all of them."""
    from symtop_ros.physics import Top, solve_start

    chosen = values.pop("solution", 1.0)
    known = {name: value for name, value in values.items() if name in KNOWN}
    others = {name: value for name, value in values.items() if name not in KNOWN}
    for name in others:
        if name not in BESIDE:
            asked = ", ".join(sorted(SEEN & known.keys()))
            raise RefusedError(f"{name} must be given without {asked}, got both")
    own = json.loads(top.request("get_state")[1])["top"]
    found = solve_start(Top(**own), **known)
    numbers = range(1, len(found) + 1)
    require(chosen in numbers, "solution", f"one of {', '.join(map(str, numbers))}", chosen)
    start = found[int(chosen) - 1]
    rates = {name: getattr(start, name) for name in ("theta_dot", "phi_dot", "psi_dot")}
    granted, answer = top.request(
        "set_initial_conditions", {**rates, "theta": start.theta, **others}
    )
    listed = [f"{number}: {describe(each)}" for number, each in zip(numbers, found, strict=True)]
    return granted, "\n".join([*listed, answer]) if granted else answer


def describe(start: "Solution") -> str:
    """Return a solution in the units of SI, and in those of a class."""
    parts = [
        f"theta = {start.theta:.6g} rad ({math.degrees(start.theta):.4g} deg)",
        _describe_rate("phi'", start.phi_dot),
        _describe_rate("psi'", start.psi_dot),
    ]
    if start.theta_dot:
        parts.insert(1, _describe_rate("theta'", start.theta_dot))
    return ", ".join(parts)


def _describe_rate(name: str, rate: float) -> str:
    return f"{name} = {rate:.6g} rad/s ({rate * 30 / math.pi:.5g} rpm)"


def set_body(top: Connection, words: list[str]) -> Response:
    """Give the top the moments and the mass of a body, and say what these are."""
    body = make_body(words)
    made = body.top
    moments = {"top.Ix": made.Ix, "top.Iz": made.Iz, "top.Mgl": made.Mgl}
    weighed = {"mass": body.mass, "gravity": body.gravity}
    granted, answer = top.request("set_parameters_atomically", moments | weighed)
    return granted, f"{describe_body(body)}\n{answer}".rstrip() if granted else answer


def describe_body(body: "Body") -> str:
    """Return what follows from the parts of a body."""
    top = body.top
    return (
        f"mass {body.mass:.6g} kg, centre {body.arm:.6g} m from the pivot, "
        f"weight {body.mass * body.gravity:.6g} N\n"
        f"Ix = {top.Ix:.6g} kg m^2, Iz = {top.Iz:.6g} kg m^2, Mgl = {top.Mgl:.6g} J"
    )


def make_body(words: list[str]) -> "Body":
    """Return the body of parts, or of its name, with `gravity=`, and Ix and Iz as measured."""
    from symtop_ros.physics import STANDARD_GRAVITY, Body

    texts = dict(word.split("=", 1) for word in words if "=" in word)
    validate_names(texts, MEASURED, "name")
    given = {name: parse_quantity(name, texts[name], MEASURED[name]) for name in texts}
    gravity = given.pop("gravity", STANDARD_GRAVITY)
    parts = [part for word in words if "=" not in word for part in read_parts(word)]
    return Body.of_parts(parts, gravity, given.get("Ix"), given.get("Iz"))


def read_parts(word: str) -> "tuple[Part, ...]":
    """Return the parts of a named body, or the one part that a word is.

    Examples
    --------
    >>> read_parts("point:0.9kg,-25.3cm")
    (Part(kind='point', mass=0.9, distance=-0.253, size=0.0, spins=True),)
    """
    from symtop_ros.physics import BODIES, SIZES, Part

    if word in BODIES:
        return BODIES[word]
    kind, _, text = word.partition(":")
    names = [name for name in UNITS if name != "size" or kind in SIZES]
    texts = text.split(",")
    if kind not in (*SIZES, "point") or len(texts) != len(names):
        kinds = f"point:MASS,DISTANCE or {', '.join(SIZES)}:MASS,SIZE,DISTANCE"
        raise refuse("part", f"{kinds} or one of {', '.join(BODIES)}", word)
    numbers = {
        name: parse_quantity(name, each, UNITS[name])
        for name, each in zip(names, texts, strict=True)
    }
    return (Part(kind, **numbers),)  # type: ignore[arg-type]
