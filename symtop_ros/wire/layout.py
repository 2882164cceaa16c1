"""Messages in which only the stamp and some doubles differ from one sample to the next.

Once the names of frames and joints are known, all other bytes are constant. A message is then a
copy of a template with a few numbers written into it, and many messages are decoded at once as a
two-dimensional array of bytes.
"""

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
    """Seconds and nanoseconds; a layout has one stamp."""


@dataclass(frozen=True, slots=True)
class Text:
    """A constant string."""

    value: str


@dataclass(frozen=True, slots=True)
class Count:
    """The length of the sequence that follows (constant)."""

    value: int


@dataclass(frozen=True, slots=True)
class Doubles:
    """Numbers that differ between messages."""

    count: int


Part = Stamp | Text | Count | Doubles


class Layout:
    """Offsets of the stamp and of the doubles in a message, and its constant bytes."""

    def __init__(self, *parts: Part) -> None:
        self._template, self._constant = bytearray(), bytearray()
        self._stamp = 0  # offset of the stamp
        self._blocks: list[tuple[int, int]] = []  # offset and number of consecutive doubles
        self._append(HEADER)
        for part in parts:
            self._add(part)

    @property
    def size(self) -> int:
        """Size of a message in bytes."""
        return len(self._template)

    def encode(self, stamp: int, numbers: Sequence[float]) -> bytes:
        """Encode a message from its stamp (ns) and its doubles, in the order of the message."""
        message = self._template.copy()
        struct.pack_into("<iI", message, self._stamp, *divmod(stamp, NANOSECONDS))
        first = 0
        for offset, count in self._blocks:
            struct.pack_into(f"<{count}d", message, offset, *numbers[first : first + count])
            first += count
        return bytes(message)

    def match(self, rows: Bytes) -> NDArray[np.bool_]:
        """Return which messages (n, size) have the constant bytes of this layout, (n,).

        Padding is not compared: ROS leaves arbitrary bytes of memory there.
        """
        known = np.frombuffer(self._constant, dtype=bool)
        expected = np.frombuffer(self._template, dtype=np.uint8)
        return np.asarray((rows[:, known] == expected[known]).all(axis=1))

    def decode(self, rows: Bytes) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Decode matching messages (n, size) into stamps (n,) in ns and doubles (n, width)."""
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
        self._constant += b"\1" * len(data)

    def _skip(self, size: int) -> None:
        self._template += bytes(size)
        self._constant += bytes(size)


def _column(rows: Bytes, offset: int, size: int, kind: str) -> NDArray[Any]:
    return np.ascontiguousarray(rows[:, offset : offset + size]).view(kind)
