"""Sources of messages: what all kinds of logs have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path

import zstandard
from mcap.records import Channel, Message, Schema

ZSTD_START = b"\x28\xb5\x2f\xfd"  # of a zstd frame; a CDR message begins with 0
MAX_MESSAGE = 16 * 2**20  # bytes; those of a top have some kB
HEAD = 64  # bytes by which other kinds of files are known
OTHER_KINDS = {
    b"version https://git-lfs": "a pointer of Git LFS and not the file: git lfs pull fetches it",
    b"#ROSBAG V": "a bag of ROS 1: rosbags-convert --src FILE --dst FOLDER makes it one of ROS 2",
}


def name_kind(path: Path, expected: str) -> str:
    """Return the kind of a file that is not of the expected kind."""
    with path.open("rb") as file:
        head = file.read(HEAD)
    return next((text for start, text in OTHER_KINDS.items() if head.startswith(start)), expected)


@dataclass(frozen=True, slots=True)
class Loss:
    """Something of a log that is damaged or lost."""

    text: str
    # messages of the log before it, 0 if that is not known; None: no message is lost
    place: int | None = None


class MessageSource(ABC):
    """Messages of a log, in the order of their arrival, with the descriptions of their channels.

    Descriptions, metadata and losses are complete when all chunks are read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.schemas: dict[int, Schema] = {}  # by their ids
        self.channels: dict[int, Channel] = {}  # by their ids
        self.metadata: dict[str, dict[str, str]] = {}  # metadata records by name
        self.losses: list[Loss] = []  # everything that reading has found to be damaged or lost
        # Each returns what else is lost, when everything was read.
        self.checks: Sequence[Callable[[MessageSource], list[Loss]]] = ()
        self.count = 0  # messages that were read
        self.counts: Counter[int] = Counter()  # messages by channel, readable or not
        self.latest = 0  # latest time of a message, in ns
        self.size, self.offset = 0, 0  # bytes of the file, and those that were read
        self.is_packed = False  # True if each message was compressed by itself (rosbag2)

    @abstractmethod
    def _read(self) -> Iterator[list[Message]]:
        """Yield lists of messages in the form in which the log has them."""

    @property
    def problems(self) -> list[str]:
        """The texts of the losses."""
        return [each.text for each in self.losses]

    @property
    def files(self) -> Sequence[MessageSource]:
        """The files of which the log consists, in the order in which they are read."""
        return [self]

    @property
    def begins(self) -> Sequence[int]:
        """The number of messages before each file; complete when all chunks are read."""
        return [0]

    def find_file(self, channel: int) -> MessageSource:
        """Return the file that has a channel."""
        del channel
        return self

    def report(self, text: str, is_place: bool = True) -> None:
        """Add a loss; `is_place` if messages are lost between the last one and the next."""
        self.losses.append(Loss(text, self.count if is_place else None))

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages in the order of the log, those of a chunk together."""
        self.losses.clear()
        self.counts.clear()
        self.count = self.latest = lost = 0
        for messages in self._read():
            self.counts.update(each.channel_id for each in messages)
            self.latest = max(self.latest, *(each.log_time for each in messages), 0)
            unpacked = [*_unpack(messages)] if self.is_packed else messages
            lost += len(messages) - len(unpacked)
            self.count += len(unpacked)
            yield unpacked
        if lost:
            self.losses.append(Loss(f"messages that cannot be decompressed: {lost}", 0))
        self.losses += [loss for check in self.checks for loss in check(self)]


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
