"""Runs in several files: rosbag2 folders and split recordings.

A bag of any kind is read like one `McapFile`, as a `MessageSource`.
"""

import os
import weakref
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from mcap.records import Channel, Message, Schema

from symtop_ros.log.reader import LogError, McapFile
from symtop_ros.log.rosbag import SUFFIX as ZSTD
from symtop_ros.log.rosbag import CompressedMessages, SqliteBag, is_compressed, unpack_file

MCAP, SQLITE = ".mcap", ".db3"
SUFFIXES = (MCAP, SQLITE, f"{MCAP}{ZSTD}", f"{SQLITE}{ZSTD}")
MAX_FILES = 10_000  # of one run


class MessageSource(Protocol):
    """Messages of a log, in the order of their arrival, with the descriptions of their channels.

    The attributes are those of `McapFile`.
    """

    path: Path
    schemas: dict[int, Schema]
    channels: dict[int, Channel]
    size: int

    @property
    def metadata(self) -> Mapping[str, Mapping[str, str]]:
        """Metadata records by name."""

    @property
    def problems(self) -> list[str]:
        """Everything that is missing or damaged."""

    @property
    def offset(self) -> int:
        """Bytes that were read."""

    def chunks(self) -> Iterator[list[Message]]:
        """Yield lists of messages."""


def open_run(paths: Sequence[Path]) -> MessageSource:
    """Open files and rosbag2 folders as one run; their order does not matter."""
    files = [file for path in paths for file in _files_of(path)]
    if len(files) > MAX_FILES:
        raise LogError(f"a run must have at most {MAX_FILES} files, got {len(files)}")
    sources = [_open(file) for file in dict.fromkeys(files)]
    return sources[0] if len(sources) == 1 else SeveralFiles(paths[0], sources)


def _files_of(path: Path) -> list[Path]:
    if not os.path.isdir(path):  # Path.is_dir raises for names that are too long
        return [path]
    files = sorted(file for suffix in SUFFIXES for file in path.glob(f"*{suffix}"))
    if not files:
        raise LogError(f"cannot open {path}: no .mcap or .db3 file in it")
    return files


def _open(path: Path) -> MessageSource:
    """Open a file that may be compressed, or hold compressed messages."""
    if path.suffix == ZSTD:
        copy, folder = unpack_file(path)
        source = _open(copy)
        weakref.finalize(source, folder.cleanup)  # when the source is no longer read
        return source
    source = SqliteBag(path) if path.suffix == SQLITE else McapFile(path)
    return CompressedMessages(source) if is_compressed(source) else source


class SeveralFiles:
    """Several logs, read one after the other in the order of their first messages."""

    def __init__(self, path: Path, sources: Sequence[MessageSource]) -> None:
        self.path = path
        self.sources = sorted(sources, key=_begin)
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self._numbers: dict[tuple[int, int], int] = {}
        self.size = sum(source.size for source in sources)
        for place, source in enumerate(self.sources):
            self._describe(place, source)

    @property
    def offset(self) -> int:
        """Bytes that were read."""
        return sum(source.offset for source in self.sources)

    @property
    def metadata(self) -> Mapping[str, Mapping[str, str]]:
        """Metadata records by name; of several the first."""
        return {k: v for each in reversed(self.sources) for k, v in each.metadata.items()}

    @property
    def problems(self) -> list[str]:
        """Everything that is missing or damaged, with the name of its file."""
        return [f"{each.path.name}: {text}" for each in self.sources for text in each.problems]

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages, those of a chunk together; numbers of channels are those of this run."""
        for place, source in enumerate(self.sources):
            for messages in source.chunks():
                self._describe(place, source)
                yield [
                    replace(each, channel_id=self._number(place, each.channel_id))
                    for each in messages
                ]

    def _describe(self, place: int, source: MessageSource) -> None:
        """Take over the channels of a file that are new."""
        for number, channel in list(source.channels.items()):
            mine = self._number(place, number)
            if mine not in self.channels and channel.schema_id in source.schemas:
                self.channels[mine] = replace(channel, id=mine, schema_id=mine)
                self.schemas[mine] = replace(source.schemas[channel.schema_id], id=mine)

    def _number(self, place: int, number: int) -> int:
        """Return the number in this run of a channel in a file."""
        return self._numbers.setdefault((place, number), len(self._numbers) + 1)


def _begin(source: MessageSource) -> tuple[int, str]:
    """Return the time of the first message, and the name for files that begin together."""
    first = next(source.chunks(), [])
    return (first[0].log_time if first else 0), source.path.name
