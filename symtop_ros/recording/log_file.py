"""One MCAP file, from its first byte to its index, which keeps what it has whatever happens."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from symtop_ros import __version__
from symtop_ros.recording.definitions import definition

MAGIC = b"\x89MCAP0\r\n"
CHUNK = 4 * 2**20  # bytes; at 1 kHz the flush every half second closes them before
METADATA = "symtop_ros"
ENDING = "symtop_ros.end"


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic of the log."""

    topic: str
    kind: str
    latched: bool = False


class LogFile:
    """An open log.

    Parameters
    ----------
    directory : Path
        Made where it is missing.
    channels : iterable of Channel
    metadata : mapping
        What is known at the start.
    head : mapping
        Channels (numbers) and the latched messages that hold: they come before all others.

    Raises
    ------
    OSError
        Where the file cannot be made.
    """

    def __init__(
        self,
        directory: Path,
        channels: Iterable[Channel],
        metadata: Mapping[str, str],
        head: Mapping[int, bytes],
    ) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        self.path = _new(directory)
        self._file = self.path.open("xb")
        self._safe = 0
        self._head = dict(sorted(head.items()))
        self._first: int | None = None
        self._last = 0
        self._writer = Writer(self._file, CHUNK, CompressionType.ZSTD)
        try:
            self._writer.start(Profile.ROS2, f"symtop_ros {__version__}")
            self._writer.add_metadata(METADATA, dict(metadata))
            self._ids = [self._register(channel) for channel in channels]
            self.flush()
        except Exception:
            self.abandon()
            raise

    def write(self, channel: int, stamp: int, data: bytes) -> None:
        """Add a message; its time is its stamp, in ns of the node's clock."""
        if self._first is None:
            self._first = stamp
            for number, message in self._head.items():
                self._writer.add_message(self._ids[number], stamp, message, stamp)
        self._last = stamp
        self._writer.add_message(self._ids[channel], stamp, data, stamp)

    def flush(self) -> None:
        """Close the chunk and hand everything to the system: a killed process loses none of it.

        Raises
        ------
        OSError
            Where the disk is full, or the file is not there any more.
        """
        self._writer.flush()  # type: ignore[no-untyped-call]
        if not self._is_there():
            msg = "it has vanished"
            raise FileNotFoundError(msg)
        self._safe = self._file.tell()

    @property
    def size(self) -> int:
        """Bytes that are written, in whole chunks."""
        return self._safe

    @property
    def duration(self) -> float:
        """Seconds from the first stamp to the last."""
        return 0.0 if self._first is None else (self._last - self._first) * 1e-9

    def finish(self, ending: Mapping[str, str]) -> None:
        """Write the index and close the file."""
        self.flush()
        self._writer.add_metadata(ENDING, dict(ending))
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._file.close()

    def abandon(self) -> None:
        """Close after an error: cut what is incomplete, and end the file without an index.

        A file that holds nothing is removed.
        """
        if self._file.closed:
            return
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            if not self._safe:
                self.path.unlink()
            os.truncate(self.path, self._safe)
            with self.path.open("ab") as file:
                file.write(_end())

    def _is_there(self) -> bool:
        """Whether the path leads to the file; one that is unlinked takes bytes, and loses them."""
        with suppress(OSError):
            return os.path.samestat(self.path.stat(), os.fstat(self._file.fileno()))
        return False

    def _register(self, channel: Channel) -> int:
        known = definition(channel.kind)
        schema = self._writer.register_schema(known.kind, SchemaEncoding.ROS2, known.text.encode())
        metadata = {"offered_qos_profiles": "", "topic_type_hash": known.type_hash}
        return self._writer.register_channel(channel.topic, MessageEncoding.CDR, schema, metadata)


def _new(directory: Path) -> Path:
    """Return a name that is not taken."""
    name = f"top_{datetime.now(timezone.utc):%Y-%m-%dT%H-%M-%SZ}"
    path, number = directory / f"{name}.mcap", 1
    while path.exists():
        number += 1
        path = directory / f"{name}_{number}.mcap"
    return path


def _end() -> bytes:
    """A whole end of a file that has no index."""
    builder = RecordBuilder()
    DataEnd(0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    return bytes(builder.end()) + MAGIC  # type: ignore[no-untyped-call]
