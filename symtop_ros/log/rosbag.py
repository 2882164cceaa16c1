"""Bags of rosbag2 that are no MCAP files: sqlite3 storage, and what zstd compressed.

Messages may be compressed one by one, or files as a whole.
"""

import sqlite3
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import zstandard
from mcap.records import Channel, Message, Schema

from symtop_ros.log.reader import MAX_MESSAGES, LogError, McapFile

# In the order in which they arrived: simulated times may go back.
MESSAGES = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
TOPICS = "SELECT id, name, type, serialization_format FROM topics"
SUFFIX = ".zstd"  # of a file
START = b"\x28\xb5\x2f\xfd"  # of a zstd frame; a CDR message begins with 0
MAX_MESSAGE = 16 * 2**20  # bytes; those of a top have some kB
PIECE = 2**20  # bytes


class SqliteBag:
    """A bag of rosbag2's sqlite3 storage, read with the attributes of an `McapFile`."""

    def __init__(self, path: Path) -> None:
        self.path, self.offset = path, 0
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.problems: list[str] = []
        self.metadata: dict[str, dict[str, str]] = {}  # missing in a bag
        try:
            self.size = path.stat().st_size
            for number, name, kind, encoding in self._rows(TOPICS):
                self._add_topic(int(number), str(name), str(kind), str(encoding))
        except OSError as error:
            raise LogError(f"cannot open {path}: {error.strerror}") from None
        except (sqlite3.Error, ValueError) as error:
            raise LogError(f"cannot open {path}: not a bag of rosbag2 ({error})") from None

    def _add_topic(self, number: int, name: str, kind: str, encoding: str) -> None:
        self.schemas[number] = Schema(number, b"", "ros2msg", kind)
        self.channels[number] = Channel(number, name, encoding, {}, number)

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages in the order of their arrival."""
        self.problems.clear()
        messages: list[Message] = []
        try:
            for number, time, data in self._rows(MESSAGES):
                messages.append(Message(number, time, bytes(data), time, 0))
                if len(messages) == MAX_MESSAGES:
                    yield messages
                    messages = []
        except (sqlite3.Error, ValueError, TypeError) as error:
            self.problems.append(f"the bag is damaged after the messages that were read: {error}")
        self.offset = self.size
        yield messages

    def _rows(self, query: str) -> Iterator[tuple[Any, ...]]:
        # Immutable: without locks and files next to the bag, whose disk may be read-only. But a
        # recorder that was killed may have left messages in a file next to it (write-ahead log),
        # which SQLite would then ignore.
        pending = self.path.with_name(f"{self.path.name}-wal").exists()
        name = f"{self.path.absolute().as_uri()}?mode=ro{'' if pending else '&immutable=1'}"
        with closing(sqlite3.connect(name, uri=True)) as database:
            yield from database.execute(query)


class CompressedMessages:
    """A source of which each message was compressed by itself."""

    def __init__(self, source: McapFile | SqliteBag) -> None:
        self.source, self.path, self.size = source, source.path, source.size
        self.schemas, self.channels = source.schemas, source.channels
        self._damaged = 0

    @property
    def offset(self) -> int:
        """Bytes that were read."""
        return self.source.offset

    @property
    def metadata(self) -> Mapping[str, Mapping[str, str]]:
        """Metadata records by name."""
        return self.source.metadata

    @property
    def problems(self) -> list[str]:
        """Everything that is missing or damaged."""
        own = [f"messages that cannot be decompressed: {self._damaged}"] if self._damaged else []
        return [*self.source.problems, *own]

    def chunks(self) -> Iterator[list[Message]]:
        """Yield lists of messages."""
        self._damaged = 0
        for messages in self.source.chunks():
            yield [*self._decompress(messages)]

    def _decompress(self, messages: list[Message]) -> Iterator[Message]:
        for message in messages:
            if not message.data.startswith(START):
                yield message
                continue
            try:
                yield replace(message, data=_decompress(message.data))
            except zstandard.ZstdError:
                self._damaged += 1


def _decompress(data: bytes) -> bytes:
    """Return what a frame holds, up to a size: hostile data may contain far more."""
    with zstandard.ZstdDecompressor().stream_reader(BytesIO(data)) as reader:
        return bytes(reader.read(MAX_MESSAGE))


def is_compressed(source: McapFile | SqliteBag) -> bool:
    """Return True if the first messages of a source are compressed."""
    return any(message.data.startswith(START) for message in next(source.chunks(), []))


def unpack_file(path: Path) -> tuple[Path, tempfile.TemporaryDirectory[str]]:
    """Return a copy of a file that was compressed as a whole, and the folder that removes it.

    LogError if the file cannot be read.
    """
    folder = tempfile.TemporaryDirectory(prefix="symtop_ros_")
    copy = Path(folder.name, path.name.removesuffix(SUFFIX))
    try:
        with path.open("rb") as packed, copy.open("wb") as file:
            zstandard.ZstdDecompressor().copy_stream(packed, file, PIECE, PIECE)
    except (zstandard.ZstdError, OSError) as error:
        folder.cleanup()
        text = getattr(error, "strerror", None) or f"it cannot be decompressed: {error}"
        raise LogError(f"cannot open {path}: {text}") from None
    return copy, folder
