"""Encoding and decoding of diagnostic_msgs/DiagnosticArray."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from symtop_ros.wire.cdr import Reader, Writer
from symtop_ros.wire.layout import NANOSECONDS

DIAGNOSTIC_ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
OK, WARN, ERROR = range(3)


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
    seconds, nanoseconds = divmod(stamp, NANOSECONDS)
    writer.integer(seconds, "i")
    writer.integer(nanoseconds)
    writer.string(frame)
    writer.integer(len(statuses))
    for status in statuses:
        writer.integer(status.level, "B")
        for text in (status.name, status.message, hardware_id):
            writer.string(text)
        writer.integer(len(status.values))
        for pair in status.values.items():
            for text in pair:
                writer.string(text)
    return writer.data


def decode_statuses(data: bytes) -> list[Status]:
    """Decode an array of statuses."""
    reader = Reader(data)
    stamp = reader.integer("i") * NANOSECONDS + reader.integer("I")
    reader.string()
    return [_decode_status(reader, stamp) for _ in range(reader.count())]


def _decode_status(reader: Reader, stamp: int) -> Status:
    level, name, message = reader.integer("B"), reader.string(), reader.string()
    reader.string()  # hardware_id
    pairs = [(reader.string(), reader.string()) for _ in range(reader.count())]
    return Status(stamp, level, name, message, dict(pairs))
