"""The run of one top in a log, recorded by symtop_ros or by another program, in files of any kind.

Topics are recognised by the last part of their names and by their types, so that namespaces and
other topics in the file do not matter. Topics that are missing are missing in the batches.

A run may be in other files than one MCAP file: bags of rosbag2, split recordings, compressed files.
A bag of any kind is read like one `McapFile`, as a `MessageSource`.
"""

import os
import sqlite3
import tempfile
import weakref
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import zstandard
from mcap.records import Channel, Message, Schema

from symtop_ros.log.batch import TF, Batch, BatchReader
from symtop_ros.log.reader import MAX_MESSAGES, LogError, McapFile
from symtop_ros.log.source import ZSTD_START, MessageSource
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.topics import EVENTS, SAMPLE_TOPICS, SENSOR_TOPICS
from symtop_ros.simulation.validation import full_name

ROWS = 4096  # samples of a topic in a batch: Rerun's viewer is fastest with columns of this length
TYPES = {topic.name: topic.type for topic in (EVENTS, *SAMPLE_TOPICS.values())}
MCAP, SQLITE, ZSTD = ".mcap", ".db3", ".zstd"
SUFFIXES = (MCAP, SQLITE, f"{MCAP}{ZSTD}", f"{SQLITE}{ZSTD}")
MAX_FILES = 10_000  # of one run
PIECE = 2**20  # bytes


class TopLog:
    """The run of one top."""

    def __init__(self, file: MessageSource, node: str | None = None) -> None:
        self.file, self.node = file, full_name(node) if node else None
        self._asked = f" {self.node}" if node else ""
        # full names of the topics that were found, by their names in `simulation.topics`
        self.topics: dict[str, str] = {}
        self.others: set[str] = set()  # full names of other nodes with tops in the file
        self._name = cache(self._find_name)  # by channel
        self._reader = BatchReader()

    def batches(self) -> Iterator[Batch]:
        """Yield the run from its start to its end."""
        # /tf is shared, and samples may precede the event that says which frame is the top's.
        if first := next(self.events(), None):
            self._reader.frame = first.values.get("top_frame")
        for messages in self._runs():
            yield self._reader.read(self._select(messages))
        if not set(self.topics) - {TF}:
            topics = sorted(channel.topic for channel in self.file.channels.values())
            known = ", ".join(topics[:20]) or "none"
            raise LogError(f"no run of a top{self._asked} in {self.file.path}: topics {known}")

    def events(self) -> Iterator[Event]:
        """Yield the events of the run in the order of the log."""
        if self.node is None:
            self.node = self._find_node()
        for messages in self.file.chunks():
            chosen = [each for each in self._select(messages) if each[0] == EVENTS.name]
            yield from (event for _, event in self._reader.read(chosen).events)

    @property
    def has_readable_events(self) -> bool:
        """True if no event was found to be unreadable so far."""
        return EVENTS.name not in self._reader.unreadable

    @property
    def problems(self) -> list[str]:
        """Everything that is missing or unreadable; complete after the last batch."""
        missing = [name for name in TYPES if name not in (*self.topics, *SENSOR_TOPICS)]
        found = [f"the log has no {', no '.join(missing)}"] if missing else []
        if self.others:
            found.append(
                f"the node is {self.node}; others can be chosen by --node: "
                f"{', '.join(sorted(self.others))}"
            )
        return self.damage + found

    @property
    def damage(self) -> list[str]:
        """Everything that is damaged, lost or unreadable; complete after the last batch."""
        unreadable = [f"{name}: {text}" for name, text in self._reader.unreadable.items()]
        return self.file.problems + unreadable

    def _runs(self) -> Iterator[list[Message]]:
        """Yield messages in runs that keep the topics of each sample together."""
        messages: list[Message] = []
        for chunk in self.file.chunks():
            messages += chunk
            while len(messages) > (most := ROWS * max(1, len(self.topics))):
                # the last place up to `most` at which a sample begins
                begins = (
                    k
                    for k in range(most, 0, -1)
                    if messages[k - 1].log_time != messages[k].log_time
                )
                cut = next(begins, most)
                yield messages[:cut]
                messages = messages[cut:]
        yield messages

    def _select(self, messages: list[Message]) -> list[tuple[str, bytes]]:
        """Return the messages of the top, with the names of their topics."""
        named = ((self._name(message.channel_id), message.data) for message in messages)
        return [each for each in named if each[0]]

    def _find_name(self, number: int) -> str:
        """Return the name of the topic of a channel; "" for those of others."""
        node, name = self._node_and_name(number)
        if name and name != TF and node != self.node:
            self.others.add(node)
            return ""
        if name:
            self.topics[name] = self.file.channels[number].topic
        return name

    def _node_and_name(self, number: int) -> tuple[str, str]:
        """Return the node and the name of the topic of a channel; "" if it is not of a top."""
        channel = self.file.channels.get(number)
        schema = channel and self.file.schemas.get(channel.schema_id)
        if not channel or not schema or channel.message_encoding != "cdr":
            return "", ""
        node, _, name = channel.topic.rpartition("/")
        return (node, name) if schema.name == TYPES.get(name) else ("", "")

    def _find_node(self) -> str | None:
        """Return the node whose run is read by default, whatever the order of the files is."""
        if not self.file.channels:  # a file without an index: they are described in its chunks
            next(self.file.chunks(), [])
        tops = map(self._node_and_name, self.file.channels)
        nodes = {node for node, name in tops if name and name != TF}
        return min(nodes, key=lambda node: (node != "/top", node), default=None)


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
        copy, folder = _unpack(path)
        source = _open(copy)
        weakref.finalize(source, folder.cleanup)  # when the source is no longer read
        return source
    source = SqliteBag(path) if path.suffix == SQLITE else McapFile(path)
    source.is_packed = any(each.data.startswith(ZSTD_START) for each in next(source.chunks(), []))
    return source


def _unpack(path: Path) -> tuple[Path, tempfile.TemporaryDirectory[str]]:
    """Return a copy of a file that was compressed as a whole, and the folder that removes it.

    LogError if the file cannot be read.
    """
    folder = tempfile.TemporaryDirectory(prefix="symtop_ros_")
    copy = Path(folder.name, path.name.removesuffix(ZSTD))
    try:
        with path.open("rb") as packed, copy.open("wb") as file:
            zstandard.ZstdDecompressor().copy_stream(packed, file, PIECE, PIECE)
    except (zstandard.ZstdError, OSError) as error:
        folder.cleanup()
        text = getattr(error, "strerror", None) or f"it cannot be decompressed: {error}"
        raise LogError(f"cannot open {path}: {text}") from None
    return copy, folder


class SqliteBag(MessageSource):
    """A bag of rosbag2's sqlite3 storage, which has no metadata."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        try:
            self.size = path.stat().st_size
            for row in self._rows("SELECT id, name, type, serialization_format FROM topics"):
                number, (name, kind, encoding) = int(row[0]), map(str, row[1:])
                self.schemas[number] = Schema(number, b"", "ros2msg", kind)
                self.channels[number] = Channel(number, name, encoding, {}, number)
        except OSError as error:
            raise LogError(f"cannot open {path}: {error.strerror}") from None
        except (sqlite3.Error, ValueError) as error:
            raise LogError(f"cannot open {path}: not a bag of rosbag2 ({error})") from None

    def _read(self) -> Iterator[list[Message]]:
        """Yield messages in the order of their arrival."""
        messages: list[Message] = []
        # In the order in which they arrived: simulated times may go back.
        query = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
        try:
            for number, time, data in self._rows(query):
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


class SeveralFiles(MessageSource):
    """Several logs, read one after the other in the order of their first messages."""

    def __init__(self, path: Path, sources: Sequence[MessageSource]) -> None:
        super().__init__(path)
        self.sources = sorted(sources, key=_begin)
        self._numbers: dict[tuple[int, int], int] = {}
        self.size = sum(source.size for source in sources)
        for place, source in enumerate(self.sources):
            self._describe(place, source)

    def _read(self) -> Iterator[list[Message]]:
        """Yield messages; numbers of channels are those of this run."""
        for place, source in enumerate(self.sources):
            for messages in source.chunks():
                self._describe(place, source)
                self.offset = sum(each.offset for each in self.sources)
                yield [
                    replace(each, channel_id=self._number(place, each.channel_id))
                    for each in messages
                ]
            self.metadata = source.metadata | self.metadata  # of several the first
            self.problems += [f"{source.path.name}: {text}" for text in source.problems]

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
