"""Bags that rosbag2 compressed with zstd: message by message, or file by file."""

import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import zstandard
from mcap.records import Message

from symtop_ros.log.reader import LogError, McapFile
from symtop_ros.log.sqlite import SqliteBag

SUFFIX = ".zstd"  # of a file
START = b"\x28\xb5\x2f\xfd"  # of a zstd frame; a CDR message begins with 0
MAX_MESSAGE = 16 * 2**20  # bytes; those of a top have some kB
PIECE = 2**20  # bytes


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
