"""Messages of which only the stamp and some doubles change from one sample to the next.

With frame and joint names given everything else is constant, so that a message is packed in one
call, and many of them are read as one structured array.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.wire.cdr import HEADER

Bytes = NDArray[np.uint8]
NANOSECONDS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class Stamp:
    """Seconds and nanoseconds; once in a layout."""


@dataclass(frozen=True, slots=True)
class Text:
    """A string that is the same in every message."""

    value: str


@dataclass(frozen=True, slots=True)
class Count:
    """The length of the sequence that follows."""

    value: int


@dataclass(frozen=True, slots=True)
class Doubles:
    """Numbers of which each message has its own."""

    count: int


Part = Stamp | Text | Count | Doubles


class Layout:
    """Where stamp and doubles stand in a message, and the bytes around them.

    Parameters
    ----------
    *parts : Stamp, Text, Count or Doubles
        The message, front to back.
    """

    def __init__(self, *parts: Part) -> None:
        self._template, self._known = bytearray(), bytearray()
        self._stamp = 0  # offset
        self._blocks: list[tuple[int, int]] = []  # offset and number of doubles
        self._append(HEADER)
        for part in parts:
            self._add(part)

    @property
    def size(self) -> int:
        """Bytes of a message."""
        return len(self._template)

    def pack(self, stamp: int, numbers: Sequence[float]) -> bytes:
        """Return the message of a stamp (ns) with its doubles, in order."""
        message = self._template.copy()
        struct.pack_into("<iI", message, self._stamp, *divmod(stamp, NANOSECONDS))
        first = 0
        for offset, count in self._blocks:
            struct.pack_into(f"<{count}d", message, offset, *numbers[first : first + count])
            first += count
        return bytes(message)

    def fits(self, rows: Bytes) -> NDArray[np.bool_]:
        """Which messages, rows of (n, size), differ in stamp, doubles and padding only.

        ROS leaves in the padding what happens to be in memory.
        """
        known = np.frombuffer(self._known, dtype=bool)
        expected = np.frombuffer(self._template, dtype=np.uint8)
        return np.asarray((rows[:, known] == expected[known]).all(axis=1))

    def unpack(self, rows: Bytes) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return stamps (n,) in ns and doubles (n, width) of messages that fit."""
        seconds = _column(rows, self._stamp, 4, "<i4").astype(np.int64)
        stamps = seconds * NANOSECONDS + _column(rows, self._stamp + 4, 4, "<u4")
        blocks = [_column(rows, offset, 8 * count, "<f8") for offset, count in self._blocks]
        return stamps[:, 0], np.concatenate(blocks, axis=1)

    def _add(self, part: Part) -> None:
        alignment = 8 if isinstance(part, Doubles) else 4
        self._skip(-(self.size - len(HEADER)) % alignment)
        match part:
            case Text(value):
                text = value.encode() + b"\0"
                self._append(struct.pack("<I", len(text)) + text)
            case Count(value):
                self._append(struct.pack("<I", value))
            case Stamp():
                self._stamp = self.size
                self._skip(8)
            case Doubles(count):
                self._blocks.append((self.size, count))
                self._skip(8 * count)

    def _append(self, data: bytes) -> None:
        self._template += data
        self._known += b"\1" * len(data)

    def _skip(self, size: int) -> None:
        self._template += bytes(size)
        self._known += bytes(size)


def _column(rows: Bytes, offset: int, size: int, kind: str) -> NDArray[Any]:
    return np.ascontiguousarray(rows[:, offset : offset + size]).view(kind)
