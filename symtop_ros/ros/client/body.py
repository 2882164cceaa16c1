"""Give the top the moments and the mass of a body of parts.

The library is imported where it is needed, so that other commands start without it.
"""

from typing import TYPE_CHECKING

from symtop_ros.base.refusals import RefusedError, find_nearest, refuse, validate_names
from symtop_ros.base.units import parse_quantity
from symtop_ros.ros.client.connection import Connection
from symtop_ros.run.session.services import Response

if TYPE_CHECKING:
    from symtop_ros.physics import Body, Part

MEASURED = {"gravity": "m/s^2", "Ix": "kg m^2", "Iz": "kg m^2"}  # Ix about the pivot
UNITS = {"mass": "kg", "size": "m", "distance": "m"}


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
    from symtop_ros.physics import DEFAULT_GRAVITY, Body

    given = [word.split("=", 1) for word in words if "=" in word]
    texts = dict(given)
    validate_names(texts, MEASURED, "name")
    if len(texts) < len(given):
        raise RefusedError(f"{', '.join(texts)} must be given once, got {len(given)} values")
    measured = {name: parse_quantity(name, texts[name], MEASURED[name]) for name in texts}
    gravity = measured.pop("gravity", DEFAULT_GRAVITY)
    parts = [part for word in words if "=" not in word for part in read_parts(word)]
    return Body.from_parts(parts, gravity, measured.get("Ix"), measured.get("Iz"))


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
        kinds = f"KIND:MASS,SIZE,DISTANCE (KIND: {', '.join(SIZES)}), point:MASS,DISTANCE,"
        known = [*SIZES, "point"] if ":" in word else [*BODIES]
        nearest = "" if kind in known else find_nearest(kind, known)
        hint = f" (the nearest is {nearest})" if nearest else ""
        raise refuse("part", f"{kinds} or one of {', '.join(BODIES)}{hint}", word)
    numbers = {
        name: parse_quantity(name, each, UNITS[name])
        for name, each in zip(names, texts, strict=True)
    }
    return (Part(kind, **numbers),)  # type: ignore[arg-type]
