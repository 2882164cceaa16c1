"""Writing and reading diagnostic_msgs/DiagnosticArray."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from symtop_ros.wire.cdr import Reader, Writer
from symtop_ros.wire.layout import NANOSECONDS

DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
OK, WARN, ERROR = range(3)


class Status(NamedTuple):
    """One status of an array; its stamp is that of the array, in ns."""

    stamp: int
    level: int
    name: str
    message: str
    values: Mapping[str, str]


def packed(stamp: int, frame: str, found: Sequence[Status]) -> bytes:
    """Return the message of some statuses; its stamp, in ns, is the one that counts."""
    writer = Writer()
    seconds, nanoseconds = divmod(stamp, NANOSECONDS)
    writer.integer(seconds, "i")
    writer.integer(nanoseconds)
    writer.string(frame)
    writer.integer(len(found))
    for each in found:
        writer.integer(each.level, "B")
        for text in (each.name, each.message, ""):
            writer.string(text)
        writer.integer(len(each.values))
        for pair in each.values.items():
            for text in pair:
                writer.string(text)
    return writer.data


def statuses(data: bytes) -> list[Status]:
    """Return the statuses of a message.

    Raises
    ------
    DecodeError
        Where the bytes are not such a message.
    """
    reader = Reader(data)
    stamp = reader.integer("i") * NANOSECONDS + reader.integer("I")
    reader.string()
    return [_status(reader, stamp) for _ in range(reader.count())]


def _status(reader: Reader, stamp: int) -> Status:
    level, name, message = reader.integer("B"), reader.string(), reader.string()
    reader.string()  # hardware_id
    pairs = [(reader.string(), reader.string()) for _ in range(reader.count())]
    return Status(stamp, level, name, message, dict(pairs))
