"""Sources of messages: what all kinds of logs have in common."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import zstandard
from mcap.records import Channel, Message, Schema

ZSTD_START = b"\x28\xb5\x2f\xfd"  # of a zstd frame; a CDR message begins with 0
MAX_MESSAGE = 16 * 2**20  # bytes; those of a top have some kB


class MessageSource(ABC):
    """Messages of a log, in the order of their arrival, with the descriptions of their channels.

    Descriptions, metadata and problems are complete when all chunks are read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.schemas: dict[int, Schema] = {}  # by their ids
        self.channels: dict[int, Channel] = {}  # by their ids
        self.metadata: dict[str, dict[str, str]] = {}  # metadata records by name
        self.problems: list[str] = []  # everything that is missing or damaged
        self.size, self.offset = 0, 0  # bytes of the file, and those that were read
        self.is_packed = False  # True if each message was compressed by itself (rosbag2)

    @abstractmethod
    def _read(self) -> Iterator[list[Message]]:
        """Yield lists of messages in the form in which the log has them."""

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages in the order of the log, those of a chunk together."""
        self.problems.clear()
        lost = 0
        for messages in self._read():
            unpacked = [*_unpack(messages)] if self.is_packed else messages
            lost += len(messages) - len(unpacked)
            yield unpacked
        if lost:
            self.problems.append(f"messages that cannot be decompressed: {lost}")


def _unpack(messages: list[Message]) -> Iterator[Message]:
    """Yield messages, decompressed; one that is damaged is left out."""
    for message in messages:
        is_packed = message.data.startswith(ZSTD_START)
        with suppress(zstandard.ZstdError):
            yield (
                replace(message, data=decompress(message.data, MAX_MESSAGE))
                if is_packed
                else message
            )


def decompress(data: bytes, most: int) -> bytes:
    """Return what a zstd frame holds, up to a number of bytes: hostile data may hold far more."""
    with zstandard.ZstdDecompressor().stream_reader(BytesIO(data)) as reader:
        return bytes(reader.read(most))
