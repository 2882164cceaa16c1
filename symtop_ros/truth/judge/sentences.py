"""Sentences on the causes of errors, and on what the motion cannot show."""

import math
from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

from symtop_ros.base.arrays import find_rotation_vectors
from symtop_ros.base.measured import format_measured, write_measured
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.judge.causes import Cause, Finding
from symtop_ros.truth.judge.turns import describe_axis
from symtop_ros.words import write
from symtop_ros.words.templates import write_number

NOTHING = 1e-6  # rad; an error below this is not worth a sentence
UNITS = {"delay": 1e3, "clock": 1e6, "scale": 100.0}  # ms, ppm and %; others are in SI units
SEVERAL = 3  # other delays that are written, if they are no family


def choose_key(found: Finding) -> str:
    """Return the name of the first sentence."""
    if found.still:
        return "still"
    if found.candidate:
        return "part"
    if found.steps:
        return "stepped"
    if not found.explained:
        return found.fault or "unexplained"
    if found.best.weight:
        return "explained"
    return "exact" if found.best.residual < NOTHING else "nothing"


def list_sentences(found: Finding, key: str) -> Iterator[str]:
    """Yield the sentences on a finding; `key` is the name of the first one."""
    yield write(f"found.{key}", _write_whole(found))
    if found.candidate or key in ("unexplained", "wanders"):
        yield from _write_left(found)
    if found.period is not None and found.heading_step is None:
        yield write("repeats", _write_repeated(found))
    elif found.period is None:
        for each in found.aliases[:SEVERAL]:
            yield write("or", {"parts": list_parts(each)})
    if found.same:
        yield write("steady", {"parts": list_parts(found.same)})
    for each in found.others:
        yield write("or", {"parts": list_parts(each)})
    for name in found.hidden:
        yield write("hidden", {"kind": name, **vars(found)})


def list_parts(cause: Cause, steps: dict[str, float] | None = None) -> list[dict[str, Any]]:
    """Return the parts of an explanation as records for sentences.

    Those of a family of delays have `steps`, by which they change to the next one.
    """
    steps = steps or {}
    change = [{"kind": "change"}] if cause.change else []
    parameters = [
        {
            "kind": name,
            "value": _write_parameter(name, getattr(cause.offset, name), deviation, seen),
            "begin": cause.offset.begin / NANOSECONDS,
            "step": _write_step(name, steps.get(name), deviation),
        }
        for name, deviation, seen in zip_longest(cause.parameters, cause.deviations, cause.seen)
    ]
    heading = _write_step("heading", steps.get("heading"), next(iter(cause.turn_deviations), None))
    turns = {"kind": cause.level, "step": heading, **_write_turns(cause)}
    return [*change, *parameters, *([turns] if cause.level != "none" else [])]


def _write_parameter(name: str, value: float, deviation: float | None, seen: float | None) -> str:
    unit = UNITS.get(name, 1.0)
    return _write_number(unit * value, unit * (deviation or 0.0), unit * (seen or 0.0))


def _write_number(value: float, deviation: float, seen: float) -> str:
    """Return a number with its deviation; without one, it ends where its changes are seen."""
    if seen and not deviation:
        return write_measured(value, 10 * seen)[0]
    return format_measured(value, deviation or None)


def _write_step(name: str, step: float | None, deviation: float | None) -> dict[str, str] | None:
    """Return a step of a family, with as many digits as the number that it changes."""
    if step is None:
        return None
    unit = UNITS.get(name, 1.0)
    return {"value": write_measured(unit * step, unit * (deviation or 0.0))[0]}


def _write_turns(cause: Cause) -> dict[str, Any]:
    """Return the angles of the rotations, and their axes; the angle of a heading has a sign."""
    offset = cause.offset
    world, body = offset.angles
    if cause.level == "heading":
        world = float(find_rotation_vectors(cause.offset.world)[2])
    seen = cause.turn_seen or 0.0
    found: dict[str, Any] = {}
    turns = zip_longest((world, body), cause.turn_deviations)
    for name, q, (angle, deviation) in zip(
        ("world", "body"), (offset.world, offset.body), turns, strict=True
    ):
        found[name] = _write_number(angle, deviation or 0.0, seen)
        found[f"{name}_axis"] = describe_axis(q, deviation or seen or None)
    return found


def _write_whole(found: Finding) -> dict[str, Any]:
    """Return what is said with all that a sentence may say of it."""
    said = found.said
    whole = write_counted(said)
    correlation = write_counted(found.best) if found.best.correlation_time else None
    steps = {"delay": found.period, "heading": found.heading_step}
    is_family = found.heading_step is not None
    parts = list_parts(said, {n: s for n, s in steps.items() if s} if is_family else None)
    left, error, unit = _scale(found.best.residual, said.residual, found.best.residual)
    return {
        **whole,
        "parts": parts,
        "many": len(parts) > 1,
        "residual": said.residual,
        "correlation": correlation,
        "percent": math.ceil(100 * found.share),
        "left": _write_size(left),
        "whole": error,
        "unit": unit,
        "steps": found.steps and {n: 1e3 * getattr(found.steps, n) for n in ("step", "jitter")},
        "stepped": found.steps and found.steps.left,
    }


def _write_repeated(found: Finding) -> dict[str, Any]:
    """Return the period of delays, and the rotations of the next one."""
    period, deviation = found.period or 0.0, next(iter(found.said.deviations), None)
    digits = write_measured(period, deviation or 0.0)[0] if found.aliases else f"{period:.4g}"
    world, body = found.repeated.angles
    is_turned = found.said.level in ("body", "both") or not found.aliases
    turns = {"world": world, "body": body if is_turned else None}
    return {"period": digits, "n": str(found.repeats), **turns}


def _scale(size: float, *values: float) -> tuple[Any, ...]:
    """Return values in the unit of a size in rad, and this unit."""
    factor, unit = (1.0, "rad") if size >= 1 else (1e3, "mrad")
    return (*(factor * value for value in values), unit)


def _write_size(value: float) -> str:
    """Return a size with two digits, and those of a larger one without an exponent."""
    return write_number(value, "2g" if value < 99.5 else "3g")


def _write_left(found: Finding) -> Iterator[str]:
    """Yield the size of the residuals, and their strongest line."""
    said, swing = found.said, found.swing
    line = None
    if swing:
        size, unit = _scale(said.residual, swing.size)
        frequency = write_measured(swing.frequency, swing.resolution)[0]
        name = swing.name or "other"
        of_line = {"size": _write_size(size), "unit": unit, "frequency": frequency, "name": name}
        line = {**vars(swing), **of_line}
    if found.candidate:
        left, unit = _scale(said.residual, said.residual)
        correlation = write_counted(said) if said.correlation_time else None
        record = {"left": _write_size(left), "unit": unit, "correlation": correlation}
        yield write("left", {**record, "line": line and {"swing": line}})
    elif line:
        yield write("left.all", {"swing": line})


def write_counted(cause: Cause) -> dict[str, Any]:
    """Return the fields of a cause, with a whole number of independent estimates."""
    return {**vars(cause), "independent": round(cause.independent or 0)}


def write_fault(cause: Cause | None) -> dict[str, Any] | None:
    """Return why a cause has no deviations, as a record for a sentence."""
    return {**write_counted(cause), "kind": cause.fault} if cause and cause.fault else None
