"""One language of refusals: "NAME must be CONDITION, got VALUE", in one printable line.

Here values are validated one by one, as requests, files and command lines have them; arrays of them
in `physics/values.py`. What is refused is a ValueError everywhere, whose text is the answer.
"""

import math
import re
from array import array
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence, Sized
from numbers import Real
from typing import Any, TypeVar

MAX_SHOWN = 60  # characters of a value in a message
MAX_LIST = 250  # characters of a list of names in a message
MAX_SENTENCE = 400  # characters of a text from another program or a file
# YAML 1.1 takes 2e-06, without a point, as text, in scene files and in `ros2 service call`. It is
# accepted as a number.
NUMBER = re.compile(r"[-+]?\d+[eE][-+]?\d+")


Word = TypeVar("Word", bound=str)  # one of some words, as a type: Literal["slow", "fast"]


class RefusedError(ValueError):
    """A value or a request that is refused; its text is the answer."""


class Words(str):
    """Words that describe a value, such as the shape of an array, and stand without quotes."""

    __slots__ = ()


def attempt(act: Callable[[], str | None]) -> tuple[bool, str]:
    """Return success and the answer of a request, or False and the reason why it is refused."""
    try:
        return True, act() or ""
    except RefusedError as refusal:
        return False, str(refusal)


def refuse(name: str, condition: str, value: object) -> RefusedError:
    """Return the refusal of a value that does not meet its condition, with its unit.

    Examples
    --------
    >>> str(refuse("Ix", "> 0 kg m^2", -1.0))
    'Ix must be > 0 kg m^2, got -1'
    >>> str(refuse("scene", "one of cusps, looping", "cups"))
    "scene must be one of cusps, looping, got 'cups'"
    >>> str(refuse("t", "of shape (n,)", Words("shape (2, 3)")))
    't must be of shape (n,), got shape (2, 3)'
    """
    return RefusedError(f"{name} must be {condition}, got {show(value)}")


def require(holds: object, name: str, condition: str, value: object) -> None:
    """Refuse a value unless its condition holds."""
    if not holds:
        raise refuse(name, condition, value)


def show(value: object) -> str:
    """Return a value as one line of at most `MAX_SHOWN` characters, however long the value is.

    A number has all its digits.
    """
    if isinstance(value, Words):
        text = str(value)
    elif isinstance(value, float):  # also those of NumPy
        text = repr(float(value)).removesuffix(".0")
    else:
        text = repr(value[:MAX_SHOWN] if isinstance(value, Sequence | array) else value)
    text = " ".join(text.split())
    return text if len(text) <= MAX_SHOWN else f"{text[: MAX_SHOWN - 3]}..."


def show_limit(limit: float) -> str:
    """Return a limit in six digits if they are all of it, else in all its digits.

    A limit that is rounded may be one that is refused itself.

    Examples
    --------
    >>> show_limit(1e30), show_limit(0.25), show_limit(2 / 3)
    ('1e+30', '0.25', '0.6666666666666666')
    """
    text = f"{limit:.6g}"
    return text if float(text) == limit else show(limit)


def find_nearest(word: str, known: Iterable[str], likeness: float = 0.6) -> str:
    """Return the known word that is most like a word; empty if no known word is like it enough.

    Examples
    --------
    >>> find_nearest("hury", ["hurry", "delay"])
    'hurry'
    """
    import difflib  # noqa: PLC0415 - few runs need it

    found = difflib.get_close_matches(word[:MAX_SHOWN], list(known), n=1, cutoff=likeness)
    return found[0] if found else ""


def list_names(names: Collection[str], word: object) -> str:
    """Return the condition to be one of some names, with the one that a word is most like.

    Of a list that is too long for a line there is then no need.

    Examples
    --------
    >>> list_names(("slow", "fast"), "fsat")
    'one of slow, fast (the nearest is fast)'
    """
    listed = f"one of {', '.join(names)}"
    nearest = find_nearest(word, names) if isinstance(word, str) else ""
    if not nearest:
        return listed
    return f"{listed if len(listed) < MAX_LIST else 'known'} (the nearest is {nearest})"


def validate_names(
    values: Mapping[str, Any], names: Collection[str], what: str = "field name"
) -> None:
    """Refuse a mapping with a name that is not one of `names`."""
    for name in values:
        if name not in names:
            raise refuse(what, list_names(names, name), name)


def is_real(value: Any) -> bool:
    """Return True for a number: also those of NumPy, but neither truth values nor durations."""
    # The first test is only for speed: the lookup in an abstract class takes longer.
    if type(value) is float:
        return True
    is_duration = getattr(getattr(value, "dtype", None), "kind", "") == "m"
    return isinstance(value, Real) and not (is_duration or isinstance(value, bool))


def number(
    name: str, value: object, unit: str = "", low: float = -math.inf, high: float = math.inf
) -> float:
    """Return a finite number within [low, high]; integers and text such as 2e-06 are converted."""
    if isinstance(value, str) and NUMBER.fullmatch(value):
        value = float(value)
    if (
        not is_real(value)
        or not math.isfinite(double := to_double(value))
        or not low <= double <= high
    ):
        raise refuse(name, describe_range(low, high, unit), value)
    return double


def to_double(value: Any) -> float:
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


def describe_range(low: float, high: float, unit: str = "") -> str:
    """Return a range as text; without limits that of all numbers."""
    if math.isfinite(low) or math.isfinite(high):
        return f"{show_limit(low)} to {show_limit(high)} {unit}".rstrip()
    return f"a finite number ({unit})" if unit else "a finite number"


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
        raise refuse(name, condition, list(parts)) from None


def choice(name: str, value: object, options: tuple[Word, ...]) -> Word:
    """Return one of some words."""
    for option in options:
        if isinstance(value, str) and value == option:
            return option
    raise refuse(name, " or ".join(f'"{option}"' for option in options), value)


def flag(name: str, value: object) -> bool:
    """Return True or False; numbers and text are refused."""
    if not isinstance(value, bool):
        raise refuse(name, "true or false", value)
    return value


def exactly_one(values: Mapping[str, Any], names: tuple[str, ...]) -> str:
    """Return which of several names is given; refuse none and more than one."""
    given = [name for name in names if name in values]
    if len(given) != 1:
        raise RefusedError(
            f"a request must have one of {', '.join(names)}, got {' and '.join(given) or 'none'}"
        )
    return given[0]


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
