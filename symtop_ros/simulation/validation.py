"""Validation of named values from requests, parameter files and the command line.

Every refusal reads "NAME must be CONDITION, got VALUE", in one printable line.
"""

import math
import re
from array import array
from collections.abc import Callable, Collection, Mapping, Sequence, Sized
from typing import Any

MAX_RATE = 1e9  # rad/s; of any rate that is requested, and of the top after a kick
MAX_SHOWN = 60  # characters of a value in a message
# YAML 1.1 takes 2e-06, without a point, as text, in scene files and in `ros2 service call`. It is
# accepted as a number.
NUMBER = re.compile(r"[-+]?\d+[eE][-+]?\d+")
MAX_SENTENCE = 400  # characters of a text from another program or a file


class RefusedError(ValueError):
    """A request that is refused; its text is the answer."""


def attempt(act: Callable[[], str | None]) -> tuple[bool, str]:
    """Return success and the answer of a request, or False and the reason why it is refused."""
    try:
        return True, act() or ""
    except RefusedError as refusal:
        return False, str(refusal)


def reject(name: str, condition: str, got: object) -> RefusedError:
    """Return the refusal of a value."""
    return RefusedError(f"{name} must be {condition}, got {show(got)}")


def show(value: object) -> str:
    """Return a value as text of at most `MAX_SHOWN` characters, however long the value is."""
    text = repr(value[:MAX_SHOWN] if isinstance(value, Sequence | array) else value)
    return text if len(text) <= MAX_SHOWN else f"{text[: MAX_SHOWN - 3]}..."


def validate_names(
    values: Mapping[str, Any], names: Collection[str], what: str = "field name"
) -> None:
    """Refuse a mapping with a name that is not one of `names`."""
    for name in values:
        if name not in names:
            raise reject(what, f"one of {', '.join(names)}", name)


def number(
    name: str, value: object, unit: str, low: float = -math.inf, high: float = math.inf
) -> float:
    """Return a finite number within [low, high]; integers and text such as 2e-06 are converted."""
    bounded = math.isfinite(low) or math.isfinite(high)
    plain = f"a finite number ({unit})" if unit else "a finite number"
    condition = describe_range(low, high, unit) if bounded else plain
    if isinstance(value, str) and NUMBER.fullmatch(value):
        value = float(value)
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not low <= value <= high
        or not math.isfinite(double := to_double(value))
    ):
        raise reject(name, condition, value)
    return double


def to_double(value: float) -> float:
    """Return a number as a double; an integer with too many digits is infinite."""
    try:
        return float(value)
    except OverflowError:
        return math.inf if value > 0 else -math.inf


def plain(text: str) -> str:
    """Return a text that is to be read as a number: Python's own grammar has underscores, too."""
    if "_" in text:
        raise ValueError(text)
    return text


def describe_range(low: float, high: float, unit: str) -> str:
    """Return a range as text."""
    return f"{low:.6g} to {high:.6g} {unit}".rstrip()


def vector(name: str, value: Any, size: int, limit: float, unit: str) -> tuple[float, ...]:
    """Return a sequence of `size` numbers, each within [-limit, limit].

    `unit` may name the frame as well: "N m, world frame".
    """
    count = len(value) if isinstance(value, Sized) and not isinstance(value, str | bytes) else 0
    if count != size:
        raise RefusedError(f"{name} must have {size} elements ({unit}), got {count or show(value)}")
    parts = tuple(value)
    try:
        return tuple(number(name, part, unit, -limit, limit) for part in parts)
    except RefusedError:
        condition = f"{size} numbers from {-limit:g} to {limit:g} ({unit})"
        raise reject(name, condition, list(parts)) from None


def choice(name: str, value: object, options: tuple[str, ...]) -> str:
    """Return one of some words."""
    if not isinstance(value, str) or value not in options:
        raise reject(name, " or ".join(f'"{option}"' for option in options), value)
    return value


def flag(name: str, value: object) -> bool:
    """Return True or False; numbers and text are refused."""
    if not isinstance(value, bool):
        raise reject(name, "true or false", value)
    return value


def exactly_one(values: Mapping[str, Any], names: tuple[str, ...]) -> str:
    """Return which of several names is given; refuse none and more than one."""
    given = [name for name in names if name in values]
    if len(given) != 1:
        raise RefusedError(
            f"a request must have one of {', '.join(names)}, got {' and '.join(given) or 'none'}"
        )
    return given[0]


def full_name(node: str) -> str:
    """Return the full name of a node; the slash at its beginning may be left out."""
    return f"/{node.strip('/')}"


def one_line(text: object, max_length: int = MAX_SENTENCE) -> str:
    r"""Return printable text in one line.

    Control characters are escaped. Text longer than `max_length` characters is shortened in its
    middle, because an error message has its cause at the end.
    """
    whole = str(text)
    half = max_length // 2
    if len(whole) > 4 * max_length:  # spare the work on characters that are cut out anyway
        whole = f"{whole[: 2 * max_length]}{whole[-2 * max_length :]}"
    line = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in " ".join(whole.split()))
    return line if len(line) <= max_length else f"{line[: half - 3]}...{line[-half:]}"
