"""Bytes of an MCAP file that readers of messages never look at.

A chunk has its own checksum, which `McapFile` verifies. Here are the others: those of the data, of
the summary and of attachments, and the indexes behind each chunk, which follow from its messages.
"""

import struct
import zlib
from collections import defaultdict
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Chunk, DataEnd, Footer

from symtop_ros.base.counts import write_count
from symtop_ros.run.log.message_index import Entry, read_entries
from symtop_ros.run.log.reader import (
    CHECKSUM,
    DAMAGE,
    HELD,
    MAGIC,
    MESSAGE_START,
    PIECE,
    RECORD_START,
    McapFile,
    RecordPlaces,
    fits,
    log_errors,
    open_stream,
    read_attachment,
    unpack_chunk,
)
from symtop_ros.run.log.source import MessageSource

Index = dict[int, list[Entry]]  # log time and offset of each message, by channel
FOOTER_HEAD = struct.Struct("<BQQQ")  # the checksum of the summary includes it


def find_damage(file: MessageSource) -> list[str]:
    """Return the damage in all files of a log, with their names if there are several."""
    if len(file.files) > 1:
        return [f"{each.path.name}: {text}" for each in file.files for text in find_damage(each)]
    with log_errors("read", file.path):
        return read_damage(file.files[0].path) if isinstance(file, McapFile) else []


def read_damage(path: Path) -> list[str]:
    """Return what is damaged in the records of a file, apart from messages."""
    found = Walk()
    with path.open("rb") as file:
        found.add(file.read(len(MAGIC)), is_magic=True)
        size = path.stat().st_size
        while len(head := file.read(RECORD_START.size)) == RECORD_START.size:
            opcode, length = RECORD_START.unpack(head)
            if not fits(opcode, length, size - file.tell()):
                # Before the end of the data `McapFile` reports the gap.
                found.in_summary |= opcode == Opcode.DATA_END
                break
            if opcode in HELD or length <= PIECE:
                found.take(opcode, head, file.read(length), file.tell())
            else:
                found.pass_over(opcode, head, file, length)
            if opcode == Opcode.FOOTER:
                found.end(file.read(len(MAGIC)), size - file.tell())
    if found.in_summary:  # a damaged length leads past the footer, or past the end of the file
        found.problems.append("the summary is damaged: it has no end")
    return found.problems


@dataclass
class Walk:
    """A walk through the records of a file, in their order."""

    problems: list[str] = field(default_factory=list)
    checksum: int = 0  # of all bytes so far; from the end of the data on, of the summary
    in_summary: bool = False  # True from the end of the data to the footer
    _after_magic: int = 0  # the checksum without the first bytes of the file
    _expected: Index | None = None  # indexes that follow from the last chunk
    _found: Index = field(default_factory=dict)

    def add(self, data: bytes, is_magic: bool = False) -> None:
        """Add bytes to the checksums."""
        self.checksum = zlib.crc32(data, self.checksum)
        if not is_magic:
            self._after_magic = zlib.crc32(data, self._after_magic)

    def take(self, opcode: int, head: bytes, data: bytes, end: int) -> None:
        """Take a record with its head, and the offset of its end."""
        try:
            self._judge(opcode, data, end)
        except DAMAGE:
            self.problems.append(f"the record before byte {end} is damaged")
        if opcode == Opcode.DATA_END:
            self.checksum, self.in_summary = 0, True
        else:
            self.add(head)
            self.add(data)

    def pass_over(self, opcode: int, head: bytes, file: BinaryIO, length: int) -> None:
        """Take a large record piece by piece, such as an attachment."""
        begin = file.tell()
        self._compare_indexes(begin - len(head))
        self.add(head)
        own = 0
        left = length
        last = b""
        content = _measure(file.read(PIECE)) if opcode == Opcode.ATTACHMENT else length
        file.seek(begin)
        while left:
            at = file.tell() - begin
            size = min(PIECE, content - at) if at < content else CHECKSUM.size
            self.add(piece := file.read(min(size, left)))
            left -= len(piece)
            if at < content:
                own = zlib.crc32(piece, own)
            last = last or (piece if at == content else b"")
        if last not in (b"", bytes(CHECKSUM.size), CHECKSUM.pack(own)):
            self.problems.append(f"the attachment before byte {file.tell()} is damaged")

    def _judge(self, opcode: int, data: bytes, end: int) -> None:
        if opcode != Opcode.MESSAGE_INDEX:
            self._compare_indexes(end - len(data) - RECORD_START.size)
        match opcode:
            case Opcode.CHUNK:
                self._found = {}
                self._expected = _index(data)
            case Opcode.MESSAGE_INDEX:
                channel, entries = read_entries(data)
                self._found[channel] = entries
            case Opcode.ATTACHMENT:
                read_attachment(data)
            case Opcode.DATA_END:
                checksum = DataEnd.read(open_stream(data)).data_section_crc
                # Writers differ in whether the first bytes of the file belong to the data.
                if checksum and checksum not in (self.checksum, self._after_magic):
                    self.problems.append("the checksum of the data is not that of its bytes")
            case Opcode.FOOTER:
                self._judge_footer(Footer.read(open_stream(data)), len(data))

    def _compare_indexes(self, end: int) -> None:
        """Compare the indexes behind a chunk, if it has any, with its messages."""
        expected, self._expected = self._expected, None
        # Writers differ in whether a channel without messages has an index, and in the order.
        found = {channel: sorted(index) for channel, index in self._found.items() if index}
        if expected is not None and found and found != expected:
            self.problems.append(f"the index of messages before byte {end} is damaged")

    def _judge_footer(self, footer: Footer, length: int) -> None:
        head = FOOTER_HEAD.pack(
            Opcode.FOOTER, length, footer.summary_start, footer.summary_offset_start
        )
        if footer.summary_crc and footer.summary_crc != zlib.crc32(head, self.checksum):
            self.problems.append("the checksum of the summary is not that of its bytes")

    def end(self, last: bytes, more: int) -> None:
        """Take what follows the footer, and the number of bytes behind it."""
        self.in_summary = False
        if last != MAGIC:
            self.problems.append("the last bytes are not those of an MCAP file")
        elif more:
            are = "is" if more == 1 else "are"
            behind = write_count(more, "byte")
            self.problems.append(f"{behind} behind the end of the log {are} not read")


def _index(data: bytes) -> Index | None:
    """Return the indexes that follow from a chunk; None if it cannot be read."""
    index: Index = defaultdict(list)
    try:
        content = unpack_chunk(Chunk.read(open_stream(data)))
        for opcode, begin, _ in RecordPlaces(content):
            if opcode == Opcode.MESSAGE:
                channel, _, log_time, _ = MESSAGE_START.unpack_from(content, begin)
                index[channel].append((log_time, begin - RECORD_START.size))
    except DAMAGE:  # `McapFile` reports it
        return None
    return {channel: sorted(places) for channel, places in index.items()}


def _measure(head: bytes) -> int:
    """Return the bytes of an attachment before its checksum, from its beginning."""
    stream = BytesIO(head)
    reader = ReadDataStream(stream)
    reader.read(16)  # the times
    reader.read_prefixed_string()
    reader.read_prefixed_string()
    size: int = reader.read8()
    return stream.tell() + size
