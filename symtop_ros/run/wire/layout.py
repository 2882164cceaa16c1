"""Plain CDR, little-endian, and messages in which only the stamp and some doubles change.

CDR is the encoding of ROS 2 messages, here limited to the types that are used. Numbers are aligned
to their size, counted from the end of the 4-byte header (OMG CDR 1.0; DDS-RTPS 2.5, section 10.2).

Once the names of frames and joints are known, all other bytes of a sample are constant. A message
is then a copy of a template with a few numbers written into it, and many messages are decoded at
once as a two-dimensional array of bytes.
"""

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
NANOSECONDS = 1_000_000_000
HEADER = b"\x00\x01\x00\x00"


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
    """Offsets of the stamp and of the doubles in a message, and its constant bytes.

    Raises
    ------
    ValueError
        If the parts do not have one stamp: it would be written over the header, or lost.
    """

    def __init__(self, *parts: Part) -> None:
        if (count := sum(isinstance(part, Stamp) for part in parts)) != 1:
            raise ValueError(f"a layout must have one Stamp, got {count}")
        self._template, self._constant = bytearray(), bytearray()
        self._stamp = 0  # offset of the stamp
        self._blocks: list[tuple[int, int]] = []  # offset and number of consecutive doubles
        self._append(HEADER)
        for part in parts:
            self._add(part)
        self._kind = np.dtype(
            {
                "names": ["seconds", "nanoseconds", *map(str, range(len(self._blocks)))],
                "formats": ["<i4", "<u4", *(f"({count},)<f8" for _, count in self._blocks)],
                "offsets": [self._stamp, self._stamp + 4, *(offset for offset, _ in self._blocks)],
                "itemsize": self.size,
            }
        )

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

    def encode_many(self, stamps: NDArray[np.int64], numbers: NDArray[np.float64]) -> list[bytes]:
        """Encode messages from their stamps (n,) in ns and their doubles (n, width), together."""
        if len(stamps) == 1:  # NumPy takes twice the time for one
            return [self.encode(int(stamps[0]), numbers[0].tolist())]
        rows = np.tile(np.frombuffer(self._template, np.uint8), (len(stamps), 1))
        fields = rows.view(self._kind)[:, 0]
        fields["seconds"], fields["nanoseconds"] = np.divmod(stamps, NANOSECONDS)
        first = 0
        for place, (_, count) in enumerate(self._blocks):
            fields[str(place)] = numbers[:, first : first + count]
            first += count
        return [row.tobytes() for row in rows]

    def match(self, rows: Bytes) -> NDArray[np.bool_]:
        """Return which messages (n, size) have the constant bytes of this layout, (n,).

        Padding is not compared: ROS leaves arbitrary bytes of memory there.
        """
        known = np.frombuffer(self._constant, dtype=bool)
        expected = np.frombuffer(self._template, dtype=np.uint8)[known]
        return np.asarray((rows[:, known] == expected).all(axis=1))

    def decode(self, rows: Bytes) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Decode matching messages (n, size) into stamps (n,) in ns and doubles (n, width)."""
        fields = np.ascontiguousarray(rows).view(self._kind)[:, 0]
        stamps = fields["seconds"].astype(np.int64) * NANOSECONDS + fields["nanoseconds"]
        blocks = range(len(self._blocks))
        return stamps, np.concatenate([fields[str(place)] for place in blocks], axis=1)

    def _add(self, part: Part) -> None:
        alignment = 8 if isinstance(part, Doubles) else 4
        self._append(bytes(-(self.size - len(HEADER)) % alignment), is_constant=False)
        match part:
            case Text(value):
                text = value.encode() + b"\0"
                self._append(struct.pack("<I", len(text)) + text)
            case Count(value):
                self._append(struct.pack("<I", value))
            case Stamp():
                self._stamp = self.size
                self._append(bytes(8), is_constant=False)
            case Doubles(count):
                self._blocks.append((self.size, count))
                self._append(bytes(8 * count), is_constant=False)

    def _append(self, data: bytes, *, is_constant: bool = True) -> None:
        self._template += data
        self._constant += bytes([is_constant]) * len(data)


class DecodeError(ValueError):
    """The bytes are not a message of the expected type."""


class Writer:
    """Encode values into a message, one after the other."""

    def __init__(self) -> None:
        self._data = bytearray()  # without the header: numbers are aligned from its end on

    @property
    def data(self) -> bytes:
        """Encoded message."""
        return HEADER + self._data

    def integer(self, value: int, code: str = "I") -> None:
        """Append an integer; `code` is its format character of the struct module."""
        self.numbers((value,), code)

    def stamp(self, stamp: int) -> None:
        """Append a stamp (ns): seconds and nanoseconds."""
        seconds, nanoseconds = divmod(stamp, NANOSECONDS)
        self.integer(seconds, "i")
        self.integer(nanoseconds)

    def numbers(self, values: Sequence[float], code: str = "d") -> None:
        """Append numbers; `code` is their format character of the struct module."""
        if values:
            self._data += bytes(-len(self._data) % struct.calcsize(f"<{code}"))
            self._data += struct.pack(f"<{len(values)}{code}", *values)

    def strings(self, texts: Iterable[str]) -> None:
        """Append strings, each with its length and its terminating zero."""
        data = self._data
        for text in texts:
            encoded = text.encode() + b"\0"
            data += bytes(-len(data) % 4) + len(encoded).to_bytes(4, "little")
            data += encoded


class Reader:
    """Decode values from a message, one after the other."""

    def __init__(self, data: bytes) -> None:
        if data[:2] != HEADER[:2]:
            raise DecodeError(
                f"encoding must be 0001 (CDR, little-endian), got {bytes(data[:2]).hex() or '-'}"
            )
        self._data = data
        self.offset = len(HEADER)

    def skip(self, size: int, count: int) -> None:
        """Skip `count` numbers of `size` bytes each."""
        self._take(size * count, size)

    def integer(self, code: str = "I") -> int:
        """Return an integer; `code` is its format character of the struct module."""
        return int(self._number(code))

    def stamp(self) -> int:
        """Return a stamp in ns."""
        return self.integer("i") * NANOSECONDS + self.integer()

    def number(self) -> float:
        """Return a double."""
        return float(self._number("d"))

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

    def _number(self, code: str) -> Any:
        size = struct.calcsize(f"<{code}")
        return struct.unpack(f"<{code}", self._take(size, size))[0]

    def _take(self, size: int, alignment: int = 1) -> bytes:
        self.offset += -(self.offset - len(HEADER)) % alignment
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
    writer.strings([text])
    return writer.data
