"""Reading diagnostic_msgs/DiagnosticArray and std_msgs/String where there is no ROS."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from symtop_ros.wire.cdr import Reader
from symtop_ros.wire.layout import NANOSECONDS

DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"


class Status(NamedTuple):
    """One status of an array; its stamp is that of the array, in ns."""

    stamp: int
    level: int
    name: str
    message: str
    values: Mapping[str, str]


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
