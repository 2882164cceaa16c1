"""Checksums and indexes of an MCAP file: bytes that readers of messages never look at.

A chunk has its own checksum, which `McapFile` verifies. Here are the others: that of the data
section, that of the summary, and the indexes behind each chunk, which follow from its messages.
"""

import struct
import zlib
from collections import defaultdict
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Chunk, DataEnd, Footer, MessageIndex

from symtop_ros.log.reader import (
    DAMAGE,
    MAGIC,
    MAX_RECORD,
    MESSAGE_START,
    RECORD_START,
    Places,
    open_stream,
    unpack_chunk,
)

Index = dict[int, list[tuple[int, int]]]  # log time and offset of each message, by channel
FOOTER_HEAD = struct.Struct("<BQQQ")  # of which the checksum of the summary is taken, too


def find_damage(path: Path) -> list[str]:
    """Return what is damaged in the records of a file, apart from messages."""
    found = Walk()
    with path.open("rb") as file:
        found.checksum = zlib.crc32(file.read(len(MAGIC)))
        size = path.stat().st_size
        while len(head := file.read(RECORD_START.size)) == RECORD_START.size:
            opcode, length = RECORD_START.unpack(head)
            if length > min(MAX_RECORD, size - file.tell()):
                break  # `McapFile` reports the gap
            found.take(opcode, head, file.read(length), file.tell())
            if opcode == Opcode.FOOTER:
                found.end(file.read())
    if found.in_summary:  # a damaged length leads past the footer
        found.problems.append("the summary is damaged: it has no end")
    return found.problems


class Walk:
    """A walk through the records of a file, in their order."""

    def __init__(self) -> None:
        self.problems: list[str] = []
        self.checksum = 0  # of all bytes so far; from the end of the data on, of the summary
        self._after_magic = 0  # the same without the first bytes of the file
        self._expected: Index | None = None  # indexes that follow from the last chunk
        self._found: Index = {}
        self.in_summary = False  # True from the end of the data to the footer

    def take(self, opcode: int, head: bytes, data: bytes, end: int) -> None:
        """Take a record with its head, and the offset of its end."""
        try:
            self._judge(opcode, data, end)
        except DAMAGE:
            self.problems.append(f"the record before byte {end} is damaged")
        if opcode == Opcode.DATA_END:
            self.checksum, self.in_summary = 0, True
        else:
            for part in (head, data):
                self.checksum = zlib.crc32(part, self.checksum)
                self._after_magic = zlib.crc32(part, self._after_magic)

    def _judge(self, opcode: int, data: bytes, end: int) -> None:
        if opcode != Opcode.MESSAGE_INDEX:
            self._compare_indexes(end - len(data) - RECORD_START.size)
        if opcode == Opcode.CHUNK:
            self._found, self._expected = {}, _index(data)
        elif opcode == Opcode.MESSAGE_INDEX:
            index = MessageIndex.read(open_stream(data))
            self._found[index.channel_id] = [(time, place) for time, place in index.records]
        elif opcode == Opcode.DATA_END:
            checksum = DataEnd.read(open_stream(data)).data_section_crc
            # Writers differ in whether the first bytes of the file belong to the data.
            if checksum and checksum not in (self.checksum, self._after_magic):
                self.problems.append("the checksum of the data is not that of its bytes")
        elif opcode == Opcode.FOOTER:
            self._judge_footer(Footer.read(open_stream(data)), len(data))

    def _compare_indexes(self, end: int) -> None:
        """Compare the indexes behind a chunk, if it has any, with its messages."""
        expected, self._expected = self._expected, None
        if expected is not None and self._found and self._found != expected:
            self.problems.append(f"the index of messages before byte {end} is damaged")

    def _judge_footer(self, footer: Footer, length: int) -> None:
        head = FOOTER_HEAD.pack(
            Opcode.FOOTER, length, footer.summary_start, footer.summary_offset_start
        )
        if footer.summary_crc and footer.summary_crc != zlib.crc32(head, self.checksum):
            self.problems.append("the checksum of the summary is not that of its bytes")

    def end(self, rest: bytes) -> None:
        """Take what follows the footer."""
        self.in_summary = False
        if rest != MAGIC:
            self.problems.append("the last bytes are not those of an MCAP file")


def _index(data: bytes) -> Index | None:
    """Return the indexes that follow from a chunk; None if it cannot be read."""
    index: Index = defaultdict(list)
    try:
        content = unpack_chunk(Chunk.read(open_stream(data)))
        for opcode, begin, _ in Places(content):
            if opcode == Opcode.MESSAGE:
                channel, _, log_time, _ = MESSAGE_START.unpack_from(content, begin)
                index[channel].append((log_time, begin - RECORD_START.size))
    except DAMAGE:  # `McapFile` reports it
        return None
    return dict(index)
