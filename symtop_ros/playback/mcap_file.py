"""Everything that can be read of an MCAP file, chunk by chunk, and in words what cannot be.

Files that end in the middle, damaged chunks and nonsense lengths cost what they cover and no more,
and memory stays bounded by the largest chunk.
"""

from __future__ import annotations

import struct
import zlib
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import BinaryIO, NamedTuple

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    Footer,
    Header,
    Message,
    Metadata,
    Schema,
)

from symtop_ros.wire.text import one_line

MAGIC = b"\x89MCAP0\r\n"
LARGEST = 256 * 2**20  # bytes of a chunk, packed or not; ours have at most 4 MiB
START = struct.Struct("<BQ")  # opcode and length of a record
FOOTER = START.size + 20 + len(MAGIC)  # the end of a whole file
HEAD = struct.Struct("<HIQQ")  # channel, sequence, log and publish time of a message
AT_ONCE = 65_536  # messages in memory: a chunk of a few bytes may unpack to millions
Description = Schema | Channel | Metadata
Parse = Callable[[ReadDataStream], Description]
Place = tuple[int, int, int]
PARSED_IN_CHUNK: dict[int, Parse] = {Opcode.SCHEMA: Schema.read, Opcode.CHANNEL: Channel.read}
PARSED: dict[int, Parse] = {**PARSED_IN_CHUNK, Opcode.METADATA: Metadata.read}
SUMMARY = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.CHUNK_INDEX)
MOST_DESCRIBED = 64 * 2**20  # bytes of schemas, channels and metadata
MOST_TOLD = 20  # problems
METADATA, ENDING = "symtop_ros", "symtop_ros.end"


class LogError(ValueError):
    """A file that cannot be read or written, in a sentence."""


class Record(NamedTuple):
    """A record of the file, and the offset behind it."""

    opcode: int
    data: bytes
    end: int


class Contents(NamedTuple):
    """What matters in a record: what messages are, and the messages."""

    descriptions: list[Description]
    messages: Iterator[Message]


def told(problems: Sequence[str]) -> list[str]:
    """Return what is to be said of problems: the first of them, each in one line."""
    more = len(problems) - MOST_TOLD
    rest = [f"and {more} more of the kind"] if more > 0 else []
    return [one_line(each) for each in problems[:MOST_TOLD]] + rest


class McapFile:
    """A log on disk.

    Parameters
    ----------
    path : Path

    Attributes
    ----------
    profile : str
        "ros2" for logs of ROS.
    schemas, channels : dict
        By their numbers; complete when all chunks are read, as all that follows.
    metadata : dict
        Metadata records by name.
    problems : list of str
        What is missing, or wrong.
    offset : int
        How far it is read, of `size` bytes.

    Raises
    ------
    LogError
        Where it is not an MCAP file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.profile = ""
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self.problems: list[str] = []
        self.offset = 0
        self._span: tuple[int, int] | None = None  # log times of the first and latest message
        self._chunk_offsets: list[int] = []
        self._described = 0  # about the bytes of all descriptions
        try:
            with path.open("rb") as file:
                self.size = file.seek(0, 2)
                file.seek(0)
                if file.read(len(MAGIC)) != MAGIC:
                    msg = f"{path} is not an MCAP file"
                    raise LogError(msg)
                self._read_summary(file)
        except OSError as error:
            msg = f"{path}: {error.strerror}"
            raise LogError(msg) from None

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages in the order of the file, no more at a time than a chunk has.

        Raises
        ------
        LogError
            Where the file cannot be read any more, or is none of a recorder.
        """
        try:
            yield from self._read_chunks()
        except OSError as error:
            msg = f"{self.path}: {error.strerror}"
            raise LogError(msg) from None

    def _read_chunks(self) -> Iterator[list[Message]]:
        self.problems.clear()
        with self.path.open("rb") as file:
            file.seek(len(MAGIC))
            damaged: list[Chunk] = []
            lost = 0
            for record in self._records(file):
                self.offset = record.end
                if damaged and record.opcode == Opcode.MESSAGE_INDEX:
                    lost += _indexed(record.data)
                    continue
                self._tell_damage(damaged, lost)
                lost = 0
                try:
                    contents = _contents(record)
                except Exception:
                    damaged += _chunk_of(record)
                    continue
                self._describe(contents.descriptions)
                yield from self._runs(contents.messages)
            self._tell_damage(damaged, lost)
        self._tell_ending()

    def since_start(self, log_time: int) -> float:
        """Seconds from the first message of the file, by log times in ns."""
        return (log_time - self._span[0]) * 1e-9 if self._span else 0.0

    def _read_summary(self, file: BinaryIO) -> None:
        """Take what the header says, and the index at the end, where there is one."""
        with suppress(Exception):
            header = next(self._records_at(file, len(MAGIC), Opcode.HEADER))
            self.profile = Header.read(_stream(header.data)).profile
        with suppress(Exception):
            footer = next(self._records_at(file, self.size - FOOTER, Opcode.FOOTER))
            start = Footer.read(_stream(footer.data)).summary_start
            for record in self._records_at(file, start, *SUMMARY) if start else ():
                if record.opcode == Opcode.CHUNK_INDEX:
                    index = ChunkIndex.read(_stream(record.data))
                    self._chunk_offsets.append(index.chunk_start_offset)
                else:
                    self._describe(_contents(record).descriptions)
        self._chunk_offsets.sort()

    def _records_at(self, file: BinaryIO, offset: int, *wanted: int) -> Iterator[Record]:
        """Yield records of some kinds from an offset on, up to the end of what can be read."""
        file.seek(offset)
        while len(head := file.read(START.size)) == START.size:
            opcode, length = START.unpack(head)
            end = file.tell() + length
            if end > self.size or length > LARGEST:
                return
            if opcode in wanted:
                yield Record(opcode, file.read(length), end)
            file.seek(end)

    def _records(self, file: BinaryIO) -> Iterator[Record]:
        """Yield records up to the end of the data, past what is no record if an index tells how."""
        while True:
            start = file.tell()
            head = file.read(START.size)
            opcode, length = START.unpack(head) if len(head) == START.size else (0, 0)
            if opcode in (Opcode.DATA_END, Opcode.FOOTER):
                return
            if not opcode or length > min(LARGEST, self.size - file.tell()):
                place = bisect_right(self._chunk_offsets, start)
                following = self._chunk_offsets[place : place + 1]
                self._tell_gap(start, *following)
                if not following:
                    return
                file.seek(following[0])
            else:
                yield Record(opcode, file.read(length), file.tell())

    def _describe(self, descriptions: Iterable[Description]) -> None:
        """Keep what says what messages are; a chunk of a few bytes may unpack to a lot of it."""
        for each in descriptions:
            if self._keep(each) != each:
                self._described += _size(each)
        if self._described > MOST_DESCRIBED:
            msg = f"{self.path}: more than {MOST_DESCRIBED} bytes say what is in it: it is no log"
            raise LogError(msg)

    def _keep(self, each: Description) -> Description | None:
        """Keep it, and return what was in its place; most are written again in every chunk."""
        before: Description | None
        if isinstance(each, Schema):
            before, self.schemas[each.id] = self.schemas.get(each.id), each
        elif isinstance(each, Channel):
            before, self.channels[each.id] = self.channels.get(each.id), each
        else:
            before, self.metadata[each.name] = None, each.metadata
        return before

    def _runs(self, messages: Iterator[Message]) -> Iterator[list[Message]]:
        while run := list(islice(messages, AT_ONCE)):
            first = self._span[0] if self._span else run[0].log_time
            self._span = first, run[-1].log_time
            yield run

    def _tell_damage(self, damaged: list[Chunk], lost: int) -> None:
        """Say what chunks that cannot be unpacked have covered, and forget them."""
        for chunk in damaged:
            if self._span is None:
                self._span = chunk.message_start_time, chunk.message_start_time
            first, last = map(self.since_start, (chunk.message_start_time, chunk.message_end_time))
            count = f"{lost} messages" if lost else "all messages"
            self.problems.append(
                f"a chunk is damaged: {count} of {first:.3f} .. {last:.3f} s are lost"
            )
        damaged.clear()

    def _tell_gap(self, start: int, onward: int | None = None) -> None:
        latest = self.since_start(self._span[1]) if self._span else 0.0
        if onward is not None:
            self.problems.append(
                f"bytes {start} to {onward} are damaged: messages after {latest:.3f} s are lost"
            )
        else:
            self.problems.append(
                f"the file ends, or is unreadable, at byte {start} of {self.size}: "
                f"nothing after {latest:.3f} s is in it"
            )

    def _tell_ending(self) -> None:
        """Say what the recorder itself knows to be missing, in a log of ours."""
        ending = self.metadata.get(ENDING, {})
        dropped = ending.get("dropped", "0")
        if dropped != "0":
            self.problems.append(
                f"{dropped} messages were too many for the disk when it was written"
            )
        if METADATA in self.metadata and not ending and not self.problems:
            latest = self.since_start(self._span[1]) if self._span else 0.0
            self.problems.append(
                f"the recording was cut short: nothing after {latest:.3f} s is in it"
            )


def _stream(data: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(data))


def _size(description: Description) -> int:
    """About the bytes of it in memory."""
    if isinstance(description, Schema):
        return 500 + len(description.data)
    return 500 + sum(len(key) + len(value) for key, value in description.metadata.items())


def _indexed(data: bytes) -> int:
    """Messages that an index counts: pairs of a time and an offset behind channel and size."""
    return max(0, len(data) - 6) // 16


def _chunk_of(record: Record) -> list[Chunk]:
    """The chunk, at least its times, if it is one."""
    with suppress(Exception):
        if record.opcode == Opcode.CHUNK:
            return [Chunk.read(_stream(record.data))]
    return []


def _contents(record: Record) -> Contents:
    """Return what matters in a record of the file, which is sound as a whole.

    Raises
    ------
    Exception
        Of many kinds, where it is damaged.
    """
    if record.opcode != Opcode.CHUNK:
        return _parsed(record.data, [(record.opcode, 0, len(record.data))], PARSED)
    chunk = Chunk.read(_stream(record.data))
    data = _unpacked(chunk)
    if len(data) != chunk.uncompressed_size:
        msg = "not of the size it announces"
        raise ValueError(msg)
    if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
        msg = "CRC"
        raise ValueError(msg)
    return _parsed(data, Places(data), PARSED_IN_CHUNK)


@dataclass(frozen=True, slots=True)
class Places:
    """Where the records of a chunk stand in it: opcode, begin and end.

    Raises
    ------
    ValueError, struct.error
        While they are looked through, where one is cut or none.
    """

    data: bytes

    def __iter__(self) -> Iterator[Place]:
        """Look through them from the first on."""
        end = 0
        while end < len(self.data):
            opcode, length = START.unpack_from(self.data, end)
            begin, end = end + START.size, end + START.size + length
            if not opcode or end > len(self.data):
                msg = "no record"
                raise ValueError(msg)
            yield opcode, begin, end


def _parsed(data: bytes, places: Iterable[Place], parsed: Mapping[int, Parse]) -> Contents:
    """Parse all that describes messages, and see that these are whole; they follow one by one."""
    descriptions = []
    for opcode, begin, end in places:
        if opcode in parsed:
            descriptions.append(parsed[opcode](_stream(data[begin:end])))
        if opcode == Opcode.MESSAGE and end - begin < HEAD.size:
            msg = "no message"
            raise ValueError(msg)
    return Contents(descriptions, _messages(data, places))


def _messages(data: bytes, places: Iterable[Place]) -> Iterator[Message]:
    for opcode, begin, end in places:
        if opcode == Opcode.MESSAGE:
            channel, sequence, log_time, publish_time = HEAD.unpack_from(data, begin)
            content = data[begin + HEAD.size : end]
            yield Message(channel, log_time, content, publish_time, sequence)


def _unpacked(chunk: Chunk) -> bytes:
    """Unpack up to what a chunk announces: the packed data may claim, and hold, far more."""
    size = chunk.uncompressed_size
    if size > LARGEST:
        msg = f"{size} bytes are more than {LARGEST}"
        raise ValueError(msg)
    if chunk.compression == "zstd":
        with zstandard.ZstdDecompressor().stream_reader(BytesIO(chunk.data)) as reader:
            return bytes(reader.read(size))
    if chunk.compression == "lz4":
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size))
    return bytes(chunk.data)
