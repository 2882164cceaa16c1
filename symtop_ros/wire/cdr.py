"""Plain CDR, little-endian: the encoding of ROS 2 messages, as far as ours need it.

Numbers are aligned to their size, counted from the end of a header of four bytes (OMG CDR 1.0,
DDS-RTPS 10.2).
"""

from __future__ import annotations

import struct

HEADER = b"\x00\x01\x00\x00"


class DecodeError(ValueError):
    """Bytes that are not the message they are said to be."""


class Writer:
    """Puts values into a message, one after the other."""

    def __init__(self) -> None:
        self._data = bytearray(HEADER)

    @property
    def data(self) -> bytes:
        """The message."""
        return bytes(self._data)

    def integer(self, value: int, code: str = "I") -> None:
        """Add an integer; `code` as in struct."""
        self._data += bytes(-(len(self._data) - len(HEADER)) % struct.calcsize(f"<{code}"))
        self._data += struct.pack(f"<{code}", value)

    def string(self, text: str) -> None:
        """Add a string."""
        encoded = text.encode() + b"\0"
        self.integer(len(encoded))
        self._data += encoded


class Reader:
    """Takes values out of a message, one after the other."""

    def __init__(self, data: bytes) -> None:
        if data[:2] != HEADER[:2]:
            msg = (
                f"encoding {bytes(data[:2]).hex() or 'of no bytes'}, readable is CDR little-endian"
            )
            raise DecodeError(msg)
        self._data = data
        self.offset = len(HEADER)

    def skip(self, size: int, count: int = 1) -> None:
        """Pass over numbers of a size in bytes."""
        self._align(size)
        self._take(size * count)

    def integer(self, code: str = "I") -> int:
        """Return an integer; `code` as in struct."""
        size = struct.calcsize(f"<{code}")
        self._align(size)
        (value,) = struct.unpack(f"<{code}", self._take(size))
        return int(value)

    def string(self) -> str:
        """Return a string."""
        return self._take(self.integer())[:-1].decode("utf-8", "replace")

    def count(self) -> int:
        """Return the length of a sequence; no element is smaller than a byte."""
        count = self.integer()
        if count > len(self._data) - self.offset:
            msg = f"a sequence of {count} in {len(self._data)} bytes"
            raise DecodeError(msg)
        return count

    def strings(self) -> tuple[str, ...]:
        """Return a sequence of strings."""
        return tuple(self.string() for _ in range(self.count()))

    def _align(self, size: int) -> None:
        self.offset += -(self.offset - len(HEADER)) % size

    def _take(self, size: int) -> bytes:
        part = self._data[self.offset : self.offset + size]
        if len(part) < size:
            msg = f"{len(self._data)} bytes, too few for what they announce"
            raise DecodeError(msg)
        self.offset += size
        return part
