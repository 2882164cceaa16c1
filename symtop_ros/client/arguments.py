"""Values for a request from words of the command line, name=value."""

from collections.abc import Iterable
from typing import Any

from symtop_ros.simulation.validation import one_line

MAX_SHOWN = 60  # characters of a word in a message


class UsageError(ValueError):
    """A word of the command line that is not valid."""


def parse_values(words: Iterable[str]) -> dict[str, Any]:
    """Parse words name=value into doubles, lists (`a,b,c` or `[a, b, c]`) and text."""
    values: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or not name:
            raise UsageError(f"argument must be NAME=VALUE, got {one_line(repr(word), MAX_SHOWN)}")
        if name in values:
            raise UsageError(
                f"{one_line(name, MAX_SHOWN)} must be given once, got it more than once"
            )
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
