"""Reading of whole and damaged MCAP files, chunk by chunk, with a list of what is missing.

A file that was cut, a damaged chunk or a nonsensical length loses only what it covers, and memory
stays bounded by the largest chunk. The readers of the mcap package stop at the first of these.
"""

import json
import struct
import zlib
from bisect import bisect_right
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from itertools import islice
from pathlib import Path
from types import NoneType
from typing import Any, BinaryIO, NamedTuple

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    Message,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
)

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import one_line
from symtop_ros.run.log.message_index import INDEX_HEAD, DamagedChunk, DamageError
from symtop_ros.run.log.source import Loss, MessageSource, decompress, name_kind
from symtop_ros.run.log.writer import ENDING, METADATA, REPAIR, REPAIR_LOSSES

MAGIC = b"\x89MCAP0\r\n"
# Bytes of a chunk, compressed or not, and of any record that is held in memory; the recorder writes
# chunks of up to 4 MiB.
MAX_RECORD = 256 * 2**20
PIECE = 2**20  # bytes of a file that are read at once
RECORD_START = struct.Struct("<BQ")  # opcode and length of a record
FOOTER_SIZE = RECORD_START.size + 20 + len(MAGIC)  # at the end of a complete file
MESSAGE_START = struct.Struct("<HIQQ")  # channel, sequence, log and publish time of a message
MAX_MESSAGES = 65_536  # in memory: a chunk of a few bytes may decompress to millions
Description = Schema | Channel | Metadata
Parse = Callable[[ReadDataStream], Description]
Span = tuple[int, int, int]
Contents = tuple[list[Description], Iterator[Message]]  # of a record
PARSED_IN_CHUNK: dict[int, Parse] = {Opcode.SCHEMA: Schema.read, Opcode.CHANNEL: Channel.read}
PARSED: dict[int, Parse] = {**PARSED_IN_CHUNK, Opcode.METADATA: Metadata.read}
SUMMARY = (
    Opcode.SCHEMA,
    Opcode.CHANNEL,
    Opcode.STATISTICS,
    Opcode.CHUNK_INDEX,
    Opcode.METADATA_INDEX,
)
# Records whose content is read; the others may have any length that the file has.
HELD = frozenset((*PARSED, Opcode.MESSAGE, Opcode.MESSAGE_INDEX, Opcode.CHUNK))
END_SIZE = 4  # bytes of the record at the end of the data: their checksum
CHECKSUM = struct.Struct("<I")  # behind the bytes of an attachment; 0: without it
MAX_DESCRIPTIONS = 64 * 2**20  # bytes of schemas, channels and metadata in memory
MAX_PROBLEMS = 20  # problems that are listed
MAX_COUNT = 19  # digits of a number of messages
NOT_FINISHED = "the recording was not finished"
LOST_BEFORE = "lost before a repair: "


class LogError(ValueError):
    """A log that cannot be read or written; the text says why."""


# What reading a damaged record can raise: mcap and `struct` for one that is cut, a text that is not
# UTF-8, a length beyond all of memory, and bytes that cannot be decompressed. Anything else is a
# bug, and stays visible.
DAMAGE = (
    DamageError,
    McapError,
    struct.error,
    UnicodeDecodeError,
    OverflowError,
    zstandard.ZstdError,
)


class FileRecord(NamedTuple):
    """A record of the file, with its offset and that of its end."""

    opcode: int
    data: bytes  # empty for the kinds that are not held
    start: int
    end: int


def list_problems(problems: Sequence[str]) -> list[str]:
    """Return the first problems, each in one line, and the number of the others."""
    more = len(problems) - MAX_PROBLEMS
    rest = [write_count(more, "more problem")] if more > 0 else []
    return [one_line(each) for each in problems[:MAX_PROBLEMS]] + rest


@contextmanager
def log_errors(act: str, path: Path) -> Iterator[None]:
    """Turn an OSError into a LogError that says what cannot be done with a file."""
    try:
        yield
    except OSError as error:
        raise LogError(f"cannot {act} {path}: {error.strerror}") from None


class McapFile(MessageSource):
    """A log on disk."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.profile = ""  # "ros2" for logs of ROS 2
        self._span: tuple[int, int] | None = None  # log times of the first and latest message
        self._index: dict[int, ChunkIndex] = {}  # by the offsets of the chunks, as the file has it
        self._chunks: list[int] = []  # offsets at which a chunk begins, in their order
        self._footer: Footer | None = None  # None: the file has no end
        self._counted = 0  # messages, as the index counts them
        self._found = 0  # messages that were read
        self._data_end = 0  # offset of the index, by reading up to it; 0: it was not reached
        self._damaged: DamagedChunk | None = None  # the latest chunk, if it has no messages
        self._described = 0  # bytes of all descriptions, about
        with log_errors("open", path), path.open("rb") as file:
            self.size = file.seek(0, 2)
            file.seek(0)
            if file.read(len(MAGIC)) != MAGIC:
                raise LogError(f"cannot open {path}: {name_kind(path, 'not an MCAP file')}")
            self._read_summary(file)

    def attachments(self) -> Iterator[Attachment]:
        """Yield the attachments that can be read, one at a time in memory."""
        with log_errors("read", self.path), self.path.open("rb") as file:
            for record in self._records(file, {Opcode.ATTACHMENT}):
                if record.opcode == Opcode.ATTACHMENT:
                    with suppress(*DAMAGE):
                        yield read_attachment(record.data)

    def list_metadata(self) -> Iterator[tuple[str, dict[str, str]]]:
        """Yield the name and the values of each metadata record; names may be there twice."""
        names = set()
        with log_errors("read", self.path), self.path.open("rb") as file:
            for record in self._records(file, {Opcode.METADATA}):
                if record.opcode == Opcode.METADATA:
                    with suppress(*DAMAGE):
                        found: Metadata = Metadata.read(open_stream(record.data))
                        names.add(found.name)
                        yield found.name, found.metadata
        # in bytes that are damaged, found by the index
        yield from (each for each in self.metadata.items() if each[0] not in names)

    def _read(self) -> Iterator[list[Message]]:
        """Yield messages in the order of the file, those of a chunk together."""
        with log_errors("read", self.path), self.path.open("rb") as file:
            self._damaged = None
            self._found = self._data_end = 0
            for record in self._records(file, HELD, self._report_gap):
                self.offset = record.end
                if self._damaged and record.opcode == Opcode.MESSAGE_INDEX:
                    self._damaged.add(record.data, record.end - record.start)
                    continue
                self._report_damage()
                yield from self._read_record(record)
            self._report_damage()
        self._report_ending()

    def _read_record(self, record: FileRecord) -> Iterator[list[Message]]:
        """Yield the messages of a record, and report or note its damage."""
        is_of_index = self._is_chunk_of_index(record)
        if record.opcode == Opcode.CHUNK or is_of_index:
            # This holds until its messages are found: readers skip another opcode, and a head of
            # zeros looks like that of an empty chunk. The indexes behind the chunk decide.
            index = self._index.get(record.start)
            self._damaged = DamagedChunk(_chunk_of(record), index, self._has_messages(index))
        try:
            descriptions, messages = self._parse_record(record, is_of_index)
        except DAMAGE:
            self._note_damage(record, is_of_index)
            return
        self._describe(descriptions)
        found = self._found
        yield from self._runs(messages)
        if self._found > found:
            self._damaged = None

    def _parse_record(self, record: FileRecord, is_of_index: bool) -> Contents:
        """Return the contents; DamageError for a record whose kind a flipped bit has changed."""
        if is_of_index and record.opcode != Opcode.CHUNK:
            raise DamageError("not a chunk")
        if record.opcode == Opcode.MESSAGE and self._index and not self._is_message(record.data):
            raise DamageError("not a message")
        return _contents(record)

    def _note_damage(self, record: FileRecord, is_of_index: bool) -> None:
        if self._damaged and (is_of_index or not self._index):
            self._damaged.is_certain = True
            return
        self._damaged = None  # a flipped bit can turn the index behind a chunk into a chunk
        self.report(f"the record before byte {record.end} is damaged")

    def _has_messages(self, chunk: ChunkIndex | None) -> bool:
        """Return False if a chunk has no messages, as far as the index of the file says."""
        if not chunk or chunk.message_index_length or chunk.message_end_time:
            return True
        # A message may have the time 0, and not all writers write indexes of messages.
        return not any(each.message_index_length for each in self._index.values())

    def _is_chunk_of_index(self, record: FileRecord) -> bool:
        """Return True for a record that the index has as a chunk."""
        index = self._index.get(record.start)
        return index is not None and index.chunk_length == record.end - record.start

    def _is_message(self, data: bytes) -> bool:
        """Return False for a record between chunks that is no message for certain.

        A flipped bit turns an index, or metadata, into a message. The checksum of all data decides;
        without one the form of an index does.
        """
        if self._is_sound is None and len(data) >= INDEX_HEAD.size:
            entries = len(data) - INDEX_HEAD.size
            return bool(entries % 16) or INDEX_HEAD.unpack_from(data)[1] != entries
        return self._is_sound is not False

    @cached_property
    def _is_sound(self) -> bool | None:
        """True if the checksum of the data is that of its bytes; None without a checksum."""
        with self.path.open("rb") as file:
            for record in self._records_at(file, len(MAGIC), Opcode.DATA_END):
                with suppress(*DAMAGE):
                    checksum = DataEnd.read(open_stream(record.data)).data_section_crc
                    # Writers differ in whether the first bytes of the file belong to the data.
                    starts = (0, zlib.crc32(MAGIC))
                    sums = (_sum_up(file, len(MAGIC), record.start, each) for each in starts)
                    return checksum in sums if checksum else None
        return None

    def since_start(self, log_time: int) -> float:
        """Return the seconds between the first message and a log time in ns."""
        return (log_time - self._span[0]) * 1e-9 if self._span else 0.0

    def _read_summary(self, file: BinaryIO) -> None:
        """Read the header, and the index at the end if there is one."""
        with suppress(*DAMAGE):
            for header in islice(self._records_at(file, len(MAGIC), Opcode.HEADER), 1):
                self.profile = Header.read(open_stream(header.data)).profile
        with suppress(*DAMAGE):
            place = max(len(MAGIC), self.size - FOOTER_SIZE)
            for footer in islice(self._records_at(file, place, Opcode.FOOTER), 1):
                self._footer = Footer.read(open_stream(footer.data))
                self._read_index(file, self._footer.summary_start)
        self._chunks = sorted(each for each in self._index if self._has_chunk(file, each))

    def _read_index(self, file: BinaryIO, start: int) -> None:
        """Read descriptions and places of chunks from an offset on; 0: the file lacks them."""
        metadata: list[int] = []
        if 0 < start < self.size:
            for record in self._records_at(file, start, *SUMMARY):
                stream = open_stream(record.data)
                if record.opcode == Opcode.CHUNK_INDEX:
                    index = ChunkIndex.read(stream)
                    self._index[index.chunk_start_offset] = index
                elif record.opcode == Opcode.STATISTICS:
                    self._counted = Statistics.read(stream).message_count
                elif record.opcode == Opcode.METADATA_INDEX:
                    metadata.append(MetadataIndex.read(stream).offset)
                else:
                    self._describe(_contents(record)[0])
        for offset in metadata:
            for record in islice(self._records_at(file, offset, Opcode.METADATA), 1):
                self._describe(_contents(record)[0])

    def _has_chunk(self, file: BinaryIO, offset: int) -> bool:
        """Return True if a chunk begins at an offset of the index."""
        file.seek(min(offset, self.size))
        opcode, length = _read_head(file)
        return opcode == Opcode.CHUNK and fits(opcode, length, self.size - file.tell())

    def _records_at(self, file: BinaryIO, offset: int, *wanted: int) -> Iterator[FileRecord]:
        """Yield the readable records with some opcodes from an offset on."""
        place = min(offset, self.size)  # offsets in a damaged index may be any
        while True:
            file.seek(place)
            opcode, length = _read_head(file)
            if not opcode or not self._fits(opcode, length, file.tell()):
                return
            start, place = place, file.tell() + length
            if opcode in wanted:
                yield FileRecord(opcode, file.read(length), start, place)

    def _records(
        self,
        file: BinaryIO,
        held: Container[int],  # the kinds of which the content is read
        report: Callable[..., None] = lambda *_: None,
    ) -> Iterator[FileRecord]:
        """Yield all records of the data; damaged bytes are skipped with the help of the index."""
        file.seek(len(MAGIC))
        while True:
            start = file.tell()
            opcode, length = _read_head(file)
            following = self._list_following(start)
            # Damaged bytes may have any opcode, but no end is at or before a chunk of the index.
            is_end = start not in self._index and self._is_end(opcode, length, file.tell())
            if is_end and not following:
                self._data_end = file.tell() + length
                return
            if is_end or not opcode or not self._fits(opcode, length, file.tell()):
                report(start, *following)
                if not following:
                    return
                file.seek(following[0])
            else:
                end = file.tell() + length
                data = file.read(length) if opcode in held else b""
                file.seek(end)
                yield FileRecord(opcode, data, start, end)

    def _is_end(self, opcode: int, length: int, begin: int) -> bool:
        """Return True for the end of the data, whose content begins at an offset."""
        if opcode == Opcode.FOOTER:
            return begin + length == self.size - len(MAGIC)
        starts = (self.size - FOOTER_SIZE, self._footer.summary_start) if self._footer else ()
        # A record may have further bytes.
        return opcode == Opcode.DATA_END and (length == END_SIZE or begin + length in starts)

    def _fits(self, opcode: int, length: int, begin: int) -> bool:
        """Return True if a record of a length in bytes may begin at an offset with its content."""
        if not fits(opcode, length, self.size - begin):
            return False
        # A damaged length may lead over chunks.
        following = self._list_following(begin)
        return not following or begin + length <= following[0]

    def _list_following(self, offset: int) -> list[int]:
        """Return the offset of the next chunk after an offset, if the index has one."""
        place = bisect_right(self._chunks, offset)
        return self._chunks[place : place + 1]

    def _describe(self, descriptions: Iterable[Description]) -> None:
        """Keep descriptions, within a limit: a small chunk may decompress to a lot of them."""
        for each in descriptions:
            if isinstance(each, Metadata):
                self.metadata[each.name] = each.metadata
                self._described += _size(each)
                continue
            known: dict[int, Any] = self.schemas if isinstance(each, Schema) else self.channels
            if known.get(each.id) != each:  # most are repeated in each chunk
                known[each.id] = each
                self._described += _size(each)
        if self._described > MAX_DESCRIPTIONS:
            raise LogError(
                f"{self.path} must have at most {MAX_DESCRIPTIONS} bytes of schemas, channels and "
                "metadata, got more: it is not a log"
            )

    def _runs(self, messages: Iterator[Message]) -> Iterator[list[Message]]:
        while run := list(islice(messages, MAX_MESSAGES)):
            self._span = self._span[0] if self._span else run[0].log_time, run[-1].log_time
            self._found += len(run)
            yield run

    def _report_damage(self) -> None:
        """Report the latest chunk if its messages are lost, and forget it."""
        chunk, self._damaged = self._damaged, None
        if chunk and (chunk.is_certain or chunk.count):
            self._begin_time(chunk.find_span())
            text = chunk.describe(self.since_start)
            self.report(text, is_place=chunk.has_messages)

    def _begin_time(self, span: tuple[int, int] | None) -> None:
        """Let the time of the log begin with messages that are lost if they are the first ones."""
        if self._span is None and span:
            self._span = span[0], span[0]

    def _report_gap(self, start: int, onward: int | None = None) -> None:
        """Report bytes that cannot be read, up to the next chunk or to the end of the file."""
        if self._damaged:
            self._damaged.is_cut = True
            self._report_damage()
        summary = self._footer.summary_start if self._footer else 0
        if onward is None and not self._has_sound_index:
            where = f"the file ends or is unreadable at byte {start} of {self.size}"
            self.report(f"{where}: {self._doubt_end()}")
            return
        end = onward or (summary if start < summary else self.size)
        lost = [
            each
            for offset, each in self._index.items()
            if start <= offset < end and self._has_messages(each)
        ]
        damage = f"bytes {start} to {end} are damaged"
        self.report(damage + self._describe_lost(lost), is_place=bool(lost))

    def _doubt_end(self) -> str:
        """Return the sentence that the log may have had further messages."""
        if self._span is None:
            return "all messages may be lost"
        latest = self.since_start(self._span[1])
        return f"messages after the last one, at {latest:.3f} s, may be lost"

    def _describe_lost(self, chunks: Sequence[ChunkIndex]) -> str:
        """Return the sentence on lost chunks of the index, with their times; empty without any."""
        if not chunks:
            return ""
        first = min(each.message_start_time for each in chunks)
        last = max(each.message_end_time for each in chunks)
        self._begin_time((first, last))
        times = f"{self.since_start(first):.3f} .. {self.since_start(last):.3f} s"
        are = "a chunk is" if len(chunks) == 1 else f"{len(chunks)} chunks are"
        return f": {are} lost, with messages of {times}"

    def _report_ending(self) -> None:
        """Report the notes of the recorder, if symtop_ros wrote the log, and those of a repair."""
        ending = self.metadata.get(ENDING, {})
        dropped = ending.get("dropped", "0")
        if dropped != "0":
            self.losses.append(Loss(self._describe_dropped(dropped), 0))
        self.losses += _read_repair(self.metadata.get(REPAIR, {}))
        if self.losses:
            return
        if self._found < self._counted and self._has_sound_index:
            missing = self._counted - self._found
            are = "is" if missing == 1 else "are"
            counted = write_count(self._counted, "message")
            self.report(f"{missing} of {counted} that the index counts {are} missing")
        elif shift := self._find_shift():
            what = write_count(abs(shift), "byte")
            were, are = ("was", "is") if abs(shift) == 1 else ("were", "are")
            lost = f"{what} before the index {are} missing: messages may be lost"
            self.report(lost if shift > 0 else f"{what} {were} inserted before the index")
        elif METADATA in self.metadata and not ending:
            has_index = self._footer and self._footer.summary_start
            what = "the log has no record of its end" if has_index else NOT_FINISHED
            self.report(f"{what}: {self._doubt_end()}")

    def _describe_dropped(self, count: str) -> str:
        """Return what the record of the end says, which may be damaged."""
        if not count.isdecimal() or len(count) > MAX_COUNT:
            return "the record of the end of the log is damaged"
        dropped = write_count(int(count), "message", "were")
        text = f"{dropped} dropped: the disk was too slow"
        is_doubtful = self._is_sound is False
        return f"{text}, if the record of the end is not damaged" if is_doubtful else text

    def _find_shift(self) -> int:
        """Return how far the index is before its place; 0: no checksum proves it."""
        if not self._footer or not self._footer.summary_start or not self._data_end:
            return 0
        shift = self._footer.summary_start - self._data_end
        return shift if shift and self._verify_index(self._data_end) else 0

    @cached_property
    def _has_sound_index(self) -> bool:
        """True if the file has an index, with the checksum of its bytes if it has one."""
        begin = self._footer.summary_start if self._footer else 0
        is_unsigned = self._footer and not self._footer.summary_crc
        return bool(self._index) and bool(is_unsigned or self._verify_index(begin))

    def _verify_index(self, begin: int) -> bool:
        """Return True if the bytes from an offset on are those of the checksum of the index."""
        if self._footer is None:
            return False
        with self.path.open("rb") as file:
            # The checksum is taken of the footer, too, up to itself.
            end = self.size - len(MAGIC) - CHECKSUM.size
            return self._footer.summary_crc == _sum_up(file, begin, end)


def _read_repair(values: Mapping[str, str]) -> list[Loss]:
    """Return what a repair has noted as lost; nothing that is no list of losses."""
    with suppress(KeyError, ValueError, TypeError, RecursionError):
        found = [Loss(**each) for each in json.loads(values[REPAIR_LOSSES])]
        if all(type(each.text) is str and type(each.place) in (int, NoneType) for each in found):
            return [Loss(f"{LOST_BEFORE}{each.text}", each.place) for each in found]
    return []


def _sum_up(file: BinaryIO, begin: int, end: int, checksum: int = 0) -> int:
    """Return the checksum of bytes of a file, continued from one of bytes before them."""
    file.seek(begin)
    while part := file.read(max(0, min(PIECE, end - file.tell()))):
        checksum = zlib.crc32(part, checksum)
    return checksum


def open_stream(data: bytes) -> ReadDataStream:
    """Return the content of a record, as the records of mcap read it."""
    return ReadDataStream(BytesIO(data))


def read_attachment(data: bytes) -> Attachment:
    """Return the attachment of a record; DamageError if it has another checksum than its bytes."""
    stream = BytesIO(data)
    attachment: Attachment = Attachment.read(ReadDataStream(stream))
    end = stream.tell() - CHECKSUM.size  # there may be further bytes behind it
    (checksum,) = CHECKSUM.unpack_from(data, end)
    if checksum and checksum != zlib.crc32(memoryview(data)[:end]):
        raise DamageError("CRC")
    return attachment


def _size(description: Description) -> int:
    """Return about how many bytes of memory a description takes."""
    if isinstance(description, Schema):
        return 500 + len(description.data)
    return 500 + sum(len(key) + len(value) for key, value in description.metadata.items())


def _chunk_of(record: FileRecord) -> Chunk | None:
    """Return the chunk of a record, for its times; None if they cannot be read."""
    with suppress(*DAMAGE):
        if record.opcode == Opcode.CHUNK:
            chunk: Chunk = Chunk.read(open_stream(record.data))
            return chunk
    return None


def _contents(record: FileRecord) -> Contents:
    """Return the contents of a record that is sound as a whole."""
    if record.opcode != Opcode.CHUNK:
        return _parse(record.data, [(record.opcode, 0, len(record.data))], PARSED)
    data = unpack_chunk(Chunk.read(open_stream(record.data)))
    return _parse(data, RecordPlaces(data), PARSED_IN_CHUNK)


def unpack_chunk(chunk: Chunk) -> bytes:
    """Return the records of a chunk; DamageError if they are not those that were written."""
    data = _decompress(chunk)
    if len(data) != chunk.uncompressed_size:
        raise DamageError("the size differs from the announced one")
    if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
        raise DamageError("CRC")
    return data


@dataclass(frozen=True, slots=True)
class RecordPlaces:
    """The records of a chunk as opcode, begin and end, found anew in each iteration."""

    data: bytes

    def __iter__(self) -> Iterator[Span]:
        """Iterate from the first record on."""
        end = 0
        while end < len(self.data):
            opcode, length = RECORD_START.unpack_from(self.data, end)
            begin, end = end + RECORD_START.size, end + RECORD_START.size + length
            if not opcode or end > len(self.data):
                raise DamageError("not a record")
            yield opcode, begin, end


def _parse(data: bytes, places: Iterable[Span], parsed: Mapping[int, Parse]) -> Contents:
    """Parse the descriptions and check the messages; messages are then read lazily."""
    descriptions = []
    for opcode, begin, end in places:
        if opcode in parsed:
            descriptions.append(parsed[opcode](open_stream(data[begin:end])))
        if opcode == Opcode.MESSAGE and end - begin < MESSAGE_START.size:
            raise DamageError("not a message")
    return descriptions, _messages(data, places)


def _read_head(file: BinaryIO) -> tuple[int, int]:
    """Return opcode and length of the record that begins here; zeros at the end of the file."""
    head = file.read(RECORD_START.size)
    opcode, length = RECORD_START.unpack(head) if len(head) == RECORD_START.size else (0, 0)
    return opcode, length


def fits(opcode: int, length: int, rest: int) -> bool:
    """Return True if a record of a length may begin the rest of a file, both in bytes."""
    return length <= (min(rest, MAX_RECORD) if opcode in HELD else rest)


def _messages(data: bytes, places: Iterable[Span]) -> Iterator[Message]:
    for opcode, begin, end in places:
        if opcode == Opcode.MESSAGE:
            channel, sequence, log_time, publish_time = MESSAGE_START.unpack_from(data, begin)
            content = data[begin + MESSAGE_START.size : end]
            yield Message(channel, log_time, content, publish_time, sequence)


def _decompress(chunk: Chunk) -> bytes:
    """Decompress at most the announced size: hostile data may contain far more."""
    size = chunk.uncompressed_size
    if size > MAX_RECORD:
        raise DamageError(f"{size} bytes are more than {MAX_RECORD}")
    if chunk.compression == "zstd":
        return decompress(chunk.data, size)
    if chunk.compression != "lz4":
        return bytes(chunk.data)
    try:
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=size))
    except RuntimeError as error:  # of lz4 for any damage
        raise DamageError(str(error)) from None
