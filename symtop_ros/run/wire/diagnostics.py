"""Diagnostic messages, and records as the fields in them.

Names and texts of a record read back to the same record. Fields of a record in a record have the
names of both, `reason.place.rate`. Numbers are written in decimals that read back to the same
doubles; a tuple of numbers or words is separated by spaces, and records in a tuple are numbered. A
field that is None is left out.
"""

import types
import typing
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import lru_cache
from itertools import takewhile
from typing import Any, NamedTuple, TypeVar

from symtop_ros.run.wire.layout import Reader, Writer

DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
OK, WARN, ERROR = range(3)
T = TypeVar("T")
MAX_RECORDS = 100  # in a tuple that is read; a log may be hostile
_get_hints = lru_cache(typing.get_type_hints)


class Status(NamedTuple):
    """One status of an array."""

    stamp: int  # stamp of the array in ns
    level: int  # OK, WARN or ERROR
    name: str
    message: str
    values: Mapping[str, str]


def encode_statuses(
    stamp: int, frame: str, statuses: Sequence[Status], hardware_id: str = ""
) -> bytes:
    """Encode an array of statuses of one piece of hardware."""
    writer = Writer()
    writer.stamp(stamp)
    writer.strings([frame])
    writer.integer(len(statuses))
    for status in statuses:
        writer.integer(status.level, "B")
        writer.strings((status.name, status.message, hardware_id))
        writer.integer(len(status.values))
        writer.strings([text for pair in status.values.items() for text in pair])
    return writer.data


def decode_statuses(data: bytes) -> list[Status]:
    """Decode an array of statuses."""
    reader = Reader(data)
    stamp = reader.stamp()
    reader.string()
    return [_decode_status(reader, stamp) for _ in range(reader.count())]


def _decode_status(reader: Reader, stamp: int) -> Status:
    level = reader.integer("B")
    name = reader.string()
    message = reader.string()
    reader.string()  # hardware_id
    values = {reader.string(): reader.string() for _ in range(reader.count())}
    return Status(stamp, level, name, message, values)


def write_text(value: Any) -> str:
    """Return a plain value, or a sequence of numbers or words, as text."""
    if isinstance(value, float):
        return repr(float(value))  # of NumPy's floats, too
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str) or not isinstance(value, Sequence):
        return str(value)
    is_words = bool(value) and isinstance(value[0], str)
    return " ".join(value if is_words else map(repr, map(float, value)))


def write_fields(prefix: str, record: Any) -> dict[str, str]:
    """Return the fields of a record as texts; their names begin with a prefix."""
    found: dict[str, str] = {}
    _flatten(found, prefix, record)
    return found


def _flatten(found: dict[str, str], name: str, value: Any) -> None:
    """Add the fields of a value under a name."""
    if is_dataclass(value):
        for key in value.__dataclass_fields__:
            _flatten(found, f"{name}.{key}", getattr(value, key))
    elif isinstance(value, tuple) and value and is_dataclass(value[0]):
        for place, each in enumerate(value):
            _flatten(found, f"{name}.{place}", each)
    elif value is not None:
        found[name] = write_text(value)


def read_fields(prefix: str, kind: type[T], values: Mapping[str, str]) -> T:
    """Return the record of a dataclass from its fields.

    Raises
    ------
    ValueError
        If a field is missing, or if its text is not of its type.
    """
    own = {name: text for name, text in values.items() if name.startswith(f"{prefix}.")}
    return typing.cast(T, _read(kind, prefix, own))


def _read(hint: Any, name: str, values: Mapping[str, str]) -> Any:
    """Return the value of a type hint: a record, a tuple or a plain value."""
    choices = _list_choices(hint)
    if type(None) in choices and not any(f"{each}.".startswith(f"{name}.") for each in values):
        return None
    kind, *others = given = [each for each in choices if each is not type(None)]
    if not others and is_dataclass(kind):
        return _read_record(kind, name, values)
    if typing.get_origin(kind) is tuple and is_dataclass(typing.get_args(kind)[0]):
        return _read_records(typing.get_args(kind)[0], name, values)
    if name not in values:
        raise ValueError(f"{name} must be given, got nothing")
    if typing.get_origin(kind) is tuple:
        return _read_tuple(typing.get_args(kind), name, values[name])
    return _read_plain(given, name, values[name])


def _read_record(kind: Any, name: str, values: Mapping[str, str]) -> Any:
    hints = _get_hints(kind)
    return kind(**{k.name: _read(hints[k.name], f"{name}.{k.name}", values) for k in fields(kind)})


def _list_choices(hint: Any) -> tuple[Any, ...]:
    """Return the members of a union, those of unions and literals in it included."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return tuple(each for part in typing.get_args(hint) for each in _list_choices(part))
    return typing.get_args(hint) if typing.get_origin(hint) is typing.Literal else (hint,)


def _read_records(kind: Any, name: str, values: Mapping[str, str]) -> tuple[Any, ...]:
    """Return the records of a tuple, which are numbered from 0 on."""
    names = (f"{name}.{place}" for place in range(MAX_RECORDS))
    given = takewhile(lambda each: any(key.startswith(f"{each}.") for key in values), names)
    return tuple(_read(kind, each, values) for each in given)


def _read_tuple(members: tuple[Any, ...], name: str, text: str) -> tuple[Any, ...]:
    parts = text.split()
    if members[-1] is not ... and len(parts) != len(members):
        raise ValueError(f"{name} must have {len(members)} elements, got {len(parts)}")
    return tuple(_read_plain(_list_choices(members[0]), name, each) for each in parts)


def _read_plain(choices: Sequence[Any], name: str, text: str) -> Any:
    """Return a number, a flag, a text, or one of some words."""
    only = choices[0]
    if only is bool:
        choices = ("true", "false")
    elif isinstance(only, type):
        return only(text)
    if text not in choices:
        raise ValueError(f"{name} must be one of {', '.join(choices)}, got {text[:60]!r}")
    return text == "true" if only is bool else text
