"""Words of the command line, name=value, as values for a request."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from symtop_ros.wire.text import one_line

SHOWN = 60  # characters of a word


class UsageError(ValueError):
    """Words that cannot be read."""


def named_values(words: Iterable[str]) -> dict[str, Any]:
    """Read `name=value` words: numbers as doubles, a,b,c or [a, b, c] as lists, else text.

    Raises
    ------
    UsageError
        For a word without `=`, or a name given twice.
    """
    values: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or not name:
            msg = f"{one_line(repr(word), SHOWN)}: allowed is name=value, such as precession_rate=9"
            raise UsageError(msg)
        if name in values:
            msg = f"{one_line(name, SHOWN)}: got it more than once, allowed is once"
            raise UsageError(msg)
        values[name] = _value(text)
    return values


def _value(text: str) -> Any:
    number = _number(text)
    if number is not None:
        return number
    if text.startswith("[") or "," in text:
        parts = [_number(part) for part in text.strip("[]").split(",")]
        if all(part is not None for part in parts):
            return parts
    return text


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None
