"""Named values from a request, a parameter file or the command line, checked and converted.

Every refusal names the field, what it got and what is allowed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType
from rclpy.parameter import parameter_value_to_python

LARGEST_RATE = 1e9  # rad/s
SHOWN = 60  # characters of a value


class RefusedError(ValueError):
    """A request that cannot be granted; its text is the answer."""


def refuse(name: str, got: object, allowed: str) -> RefusedError:
    """Return the refusal of a value."""
    return RefusedError(f"{name}: got {shown(got)}, allowed is {allowed}")


def shown(value: object) -> str:
    """Return a value as text, however long or odd it is."""
    some = value[:SHOWN] if isinstance(value, list | tuple | str) else value
    text = repr(some)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."


def named_values(parameters: Iterable[ParameterMessage], allowed: Iterable[str]) -> dict[str, Any]:
    """Return the values of a request by name; refuse unknown, repeated and empty ones."""
    parameters, names = tuple(parameters), tuple(allowed)
    check_types(parameters)
    values: dict[str, Any] = {}
    for parameter in parameters:
        name = parameter.name
        if name not in names:
            raise refuse("field", name, f"one of {', '.join(names)}")
        if name in values:
            msg = f"{name}: got it more than once, allowed is once"
            raise RefusedError(msg)
        value = parameter_value_to_python(parameter.value)
        if value is None:
            raise refuse(name, "no value", "a value")
        values[name] = value
    return values


def check_types(parameters: Iterable[ParameterMessage]) -> None:
    """Refuse values of a type that ROS does not have."""
    for parameter in parameters:
        kind, last = parameter.value.type, ParameterType.PARAMETER_STRING_ARRAY
        if kind > last:
            msg = f"{shown(parameter.name)}: got type {kind}, allowed is a type from 0 to {last}"
            raise RefusedError(msg)


def number(name: str, value: object, low: float = -math.inf, high: float = math.inf) -> float:
    """Return a finite number within [low, high]."""
    allowed = _range(low, high)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise refuse(name, value, allowed)
    if not low <= value <= high or not math.isfinite(value):
        raise refuse(name, value, allowed)
    return float(value)


def numbers(name: str, value: Any, size: int, limit: float) -> tuple[float, ...]:
    """Return `size` finite numbers, none larger than the limit."""
    allowed = f"{size} numbers, each {_range(-limit, limit).removeprefix('a number ')}"
    if isinstance(value, str):
        raise refuse(name, value, allowed)
    try:
        parts = tuple(value)
    except TypeError:
        raise refuse(name, value, allowed) from None
    if len(parts) != size:
        raise refuse(name, list(parts), allowed)
    try:
        return tuple(number(name, part, -limit, limit) for part in parts)
    except RefusedError:
        raise refuse(name, list(parts), allowed) from None


def choice(name: str, value: object, options: tuple[str, ...]) -> str:
    """Return one of some words."""
    if not isinstance(value, str) or value not in options:
        raise refuse(name, value, " or ".join(f'"{option}"' for option in options))
    return value


def flag(name: str, value: object) -> bool:
    """Return a truth value."""
    if not isinstance(value, bool):
        raise refuse(name, value, "true or false")
    return value


def _range(low: float, high: float) -> str:
    if math.isinf(low) and math.isinf(high):
        return "a finite number"
    return f"a number from {low:.6g} to {high:.6g}"


def exactly_one(values: Mapping[str, Any], names: tuple[str, ...]) -> str:
    """Return which of several names is given; refuse none and more than one."""
    given = [name for name in names if name in values]
    if len(given) != 1:
        got = " and ".join(given) or "none of them"
        msg = f"fields: got {got}, allowed is exactly one of {', '.join(names)}"
        raise RefusedError(msg)
    return given[0]
