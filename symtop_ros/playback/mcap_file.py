"""Everything that can be read of an MCAP file, chunk by chunk, and in words what cannot be.

Files that end in the middle, damaged chunks and nonsense lengths cost what they cover and no more,
and memory stays bounded by the largest chunk.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator
from contextlib import suppress
from io import BytesIO
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
    McapRecord,
    Message,
    MessageIndex,
    Metadata,
    Schema,
)
from mcap.stream_reader import StreamReader, breakup_chunk

MAGIC = b"\x89MCAP0\r\n"
LARGEST = 256 * 2**20  # bytes of a chunk, packed or not; ours have at most 4 MiB
START = struct.Struct("<BQ")  # opcode and length of a record
FOOTER = START.size + 20 + len(MAGIC)  # the end of a whole file
PARSED = {
    Opcode.SCHEMA: lambda data, stream: Schema.read(stream),
    Opcode.CHANNEL: lambda data, stream: Channel.read(stream),
    Opcode.MESSAGE: lambda data, stream: Message.read(stream, len(data)),
    Opcode.METADATA: lambda data, stream: Metadata.read(stream),
}
METADATA, ENDING = "symtop_ros", "symtop_ros.end"


class LogError(ValueError):
    """A file that cannot be read or written, in a sentence."""


class Record(NamedTuple):
    """A record of the file, and the offset behind it."""

    opcode: int
    data: bytes
    end: int


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
        """Yield the messages of one chunk after the other, in the order of the file."""
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
                    messages = self._take(_contents(record))
                except Exception:
                    damaged += _chunk_of(record)
                    continue
                if messages:
                    yield messages
            self._tell_damage(damaged, lost)
        self._tell_ending()

    def since_start(self, log_time: int) -> float:
        """Seconds from the first message of the file, by log times in ns."""
        return (log_time - self._span[0]) * 1e-9 if self._span else 0.0

    def _read_summary(self, file: BinaryIO) -> None:
        """Take what the header says, and the index at the end, where there is one."""
        with suppress(Exception):
            header = next(_records_at(file, len(MAGIC)))
            self.profile = header.profile if isinstance(header, Header) else ""
        with suppress(Exception):
            footer = next(_records_at(file, self.size - FOOTER))
            start = footer.summary_start if isinstance(footer, Footer) else 0
            for record in _records_at(file, start) if start else ():
                if isinstance(record, Schema | Channel):
                    self._take([record])
                if isinstance(record, ChunkIndex):
                    self._chunk_offsets.append(record.chunk_start_offset)
        self._chunk_offsets.sort()

    def _records(self, file: BinaryIO) -> Iterator[Record]:
        """Yield records up to the end of the data, past what is no record if an index tells how."""
        while True:
            start = file.tell()
            head = file.read(START.size)
            opcode, length = START.unpack(head) if len(head) == START.size else (0, 0)
            if opcode in (Opcode.DATA_END, Opcode.FOOTER):
                return
            if not opcode or length > min(LARGEST, self.size - file.tell()):
                onward = next((each for each in self._chunk_offsets if each > start), None)
                self._tell_gap(start, onward)
                if onward is None:
                    return
                file.seek(onward)
            else:
                yield Record(opcode, file.read(length), file.tell())

    def _take(self, records: Iterable[McapRecord]) -> list[Message]:
        messages = []
        for record in records:
            if isinstance(record, Message):
                messages.append(record)
            elif isinstance(record, Schema):
                self.schemas[record.id] = record
            elif isinstance(record, Channel):
                self.channels[record.id] = record
            elif isinstance(record, Metadata):
                self.metadata[record.name] = record.metadata
        if messages:
            first = self._span[0] if self._span else messages[0].log_time
            self._span = first, messages[-1].log_time
        return messages

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

    def _tell_gap(self, start: int, onward: int | None) -> None:
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


def _records_at(file: BinaryIO, offset: int) -> Iterator[McapRecord]:
    """Read records from somewhere on; chunks stay packed."""
    file.seek(offset)
    reader = StreamReader(file, skip_magic=True, emit_chunks=True, record_size_limit=LARGEST)
    return iter(reader.records)


def _stream(data: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(data))


def _indexed(data: bytes) -> int:
    """Messages that an index counts; 0 where it is damaged too."""
    with suppress(Exception):
        return len(MessageIndex.read(_stream(data)).records)
    return 0


def _chunk_of(record: Record) -> list[Chunk]:
    """The chunk, at least its times, if it is one."""
    with suppress(Exception):
        if record.opcode == Opcode.CHUNK:
            return [Chunk.read(_stream(record.data))]
    return []


def _contents(record: Record) -> list[McapRecord]:
    """Return what matters in a record of the file.

    Raises
    ------
    Exception
        Of many kinds, where it is damaged.
    """
    if record.opcode == Opcode.CHUNK:
        chunk = Chunk.read(_stream(record.data))
        data = _unpacked(chunk)
        if len(data) != chunk.uncompressed_size:
            msg = "not of the size it announces"
            raise ValueError(msg)
        if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
            msg = "CRC"
            raise ValueError(msg)
        chunk.compression, chunk.data = "", data
        return breakup_chunk(chunk)
    parse = PARSED.get(Opcode(record.opcode)) if record.opcode in set(Opcode) else None
    return [parse(record.data, _stream(record.data))] if parse else []


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
