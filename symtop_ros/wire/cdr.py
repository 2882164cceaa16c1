"""Plain CDR, little-endian: the encoding of ROS 2 messages, limited to the types used here.

Numbers are aligned to their size, counted from the end of the 4-byte header (OMG CDR 1.0;
DDS-RTPS 2.5, section 10.2).
"""

import struct

HEADER = b"\x00\x01\x00\x00"


class DecodeError(ValueError):
    """The bytes are not a message of the expected type."""


class Writer:
    """Encode values into a message, one after the other."""

    def __init__(self) -> None:
        self._data = bytearray(HEADER)

    @property
    def data(self) -> bytes:
        """Encoded message."""
        return bytes(self._data)

    def integer(self, value: int, code: str = "I") -> None:
        """Append an integer; `code` is its format character of the struct module."""
        self._data += bytes(-(len(self._data) - len(HEADER)) % struct.calcsize(f"<{code}"))
        self._data += struct.pack(f"<{code}", value)

    def number(self, value: float) -> None:
        """Append a double."""
        self._data += bytes(-(len(self._data) - len(HEADER)) % 8) + struct.pack("<d", value)

    def string(self, text: str) -> None:
        """Append a string with its length and its terminating zero."""
        encoded = text.encode() + b"\0"
        self.integer(len(encoded))
        self._data += encoded


class Reader:
    """Decode values from a message, one after the other."""

    def __init__(self, data: bytes) -> None:
        if data[:2] != HEADER[:2]:
            raise DecodeError(
                f"encoding must be 0001 (CDR, little-endian), got {bytes(data[:2]).hex() or '-'}"
            )
        self._data = data
        self.offset = len(HEADER)

    def skip(self, size: int, count: int = 1) -> None:
        """Skip `count` numbers of `size` bytes each."""
        self._align(size)
        self._take(size * count)

    def integer(self, code: str = "I") -> int:
        """Return an integer; `code` is its format character of the struct module."""
        size = struct.calcsize(f"<{code}")
        self._align(size)
        (value,) = struct.unpack(f"<{code}", self._take(size))
        return int(value)

    def number(self) -> float:
        """Return a double."""
        self._align(8)
        (value,) = struct.unpack("<d", self._take(8))
        return float(value)

    def string(self) -> str:
        """Return a string; invalid UTF-8 is replaced."""
        return self._take(self.integer())[:-1].decode("utf-8", "replace")

    def count(self) -> int:
        """Return the length of a sequence, at most the number of remaining bytes."""
        count = self.integer()
        # Every element takes at least a byte. Without this limit a damaged length of four billion
        # would be used to loop.
        if count > len(self._data) - self.offset:
            raise DecodeError(
                f"a sequence of {count} elements does not fit in {len(self._data)} bytes"
            )
        return count

    def strings(self) -> tuple[str, ...]:
        """Return a sequence of strings."""
        return tuple(self.string() for _ in range(self.count()))

    def _align(self, size: int) -> None:
        self.offset += -(self.offset - len(HEADER)) % size

    def _take(self, size: int) -> bytes:
        part = self._data[self.offset : self.offset + size]
        if len(part) < size:
            raise DecodeError(
                f"the message is cut: {len(self._data)} bytes are too few for its content"
            )
        self.offset += size
        return part


def encode_string(text: str) -> bytes:
    """Encode a std_msgs/String."""
    writer = Writer()
    writer.string(text)
    return writer.data
