"""The whole check of a log: its samples, its events, its texts and the bytes of its files.

Readers of messages never look at some bytes of an MCAP file. A chunk has its own checksum, which
`McapFile` verifies. Here are the others: that of the data section, that of the summary, and the
indexes behind each chunk, which follow from its messages.
"""

import struct
import zlib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mcap.opcode import Opcode
from mcap.records import Chunk, DataEnd, Footer, MessageIndex

from symtop_ros.check.course import Course, Grid, count_missed, describe_gaps
from symtop_ros.check.events import (
    Mismatch,
    find_mismatches,
    find_wrong_texts,
    is_of_this_version,
    list_other_versions,
)
from symtop_ros.check.samples import Deviation, check_log
from symtop_ros.log.reader import (
    DAMAGE,
    MAGIC,
    MESSAGE_START,
    RECORD_START,
    McapFile,
    Places,
    fits,
    log_errors,
    open_stream,
    unpack_chunk,
)
from symtop_ros.log.source import MessageSource
from symtop_ros.log.top_log import SeveralFiles, TopLog
from symtop_ros.simulation.events import Event

Index = dict[int, list[tuple[int, int]]]  # log time and offset of each message, by channel
FOOTER_HEAD = struct.Struct("<BQQQ")  # of which the checksum of the summary is taken, too


@dataclass(frozen=True)
class Findings:
    """Results of a check."""

    deviations: dict[str, Deviation]  # of the samples, by their topics
    mismatches: list[Mismatch]  # in events, descriptions and diagnostics
    foreign: int  # events of another version, which are not computed
    versions: list[str]  # other versions that reported events
    damage: list[str]  # in the files, apart from what reading them has found
    first: int  # number of the first event; 1 unless the log begins later than the run
    missing: list[str]  # events and samples that are missing, or there twice

    @property
    def samples_agree(self) -> bool:
        """True if the samples agree with the events."""
        return all(each.is_rounding for each in self.deviations.values())


def check_run(log: TopLog) -> Findings:
    """Check a log; LogError if it cannot be checked."""
    given = list(log.events())
    grid = Grid(log, given)
    deviations = check_log(log, grid)
    return Findings(
        deviations,
        [*find_mismatches(given), *find_wrong_texts(log, given)],
        sum(not is_of_this_version(each) for each in given),
        list_other_versions(given),
        _find_damage(log.file),
        given[0].number if given else 0,
        list(_list_missing(log, given, deviations, grid)),
    )


def _list_missing(
    log: TopLog, given: list[Event], deviations: Mapping[str, Deviation], grid: Grid
) -> Iterator[str]:
    """Yield what is said of events and samples that are missing or repeated."""
    course = Course(given)
    files = len(log.file.sources) if isinstance(log.file, SeveralFiles) else 1
    yield from course.list_missing()
    yield from course.list_repeated(files - 1)
    early = max((each.unchecked for each in deviations.values()), default=0)
    if given and early:
        yield (
            f"the beginning is missing: {early} samples are before the first event, "
            f"which is number {given[0].number}"
        )
    has_gaps = any(each.missing for each in grid.gaps.values())
    yield from describe_gaps(grid.gaps, count_missed(log, given) if has_gaps else 0)


def _find_damage(file: MessageSource) -> list[str]:
    """Return the damage in all files of a run, with their names if there are several."""
    if isinstance(file, SeveralFiles):
        return [f"{each.path.name}: {text}" for each in file.sources for text in _find_damage(each)]
    with log_errors("read", file.path):
        return find_damage(file.path) if isinstance(file, McapFile) else []


def find_damage(path: Path) -> list[str]:
    """Return what is damaged in the records of a file, apart from messages."""
    found = Walk()
    with path.open("rb") as file:
        found.checksum = zlib.crc32(file.read(len(MAGIC)))
        size = path.stat().st_size
        while len(head := file.read(RECORD_START.size)) == RECORD_START.size:
            opcode, length = RECORD_START.unpack(head)
            if not fits(length, file, size):
                break  # `McapFile` reports the gap
            found.take(opcode, head, file.read(length), file.tell())
            if opcode == Opcode.FOOTER:
                found.end(file.read())
    if found.in_summary:  # a damaged length leads past the footer
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
        match opcode:
            case Opcode.CHUNK:
                self._found, self._expected = {}, _index(data)
            case Opcode.MESSAGE_INDEX:
                index = MessageIndex.read(open_stream(data))
                self._found[index.channel_id] = [(time, place) for time, place in index.records]
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
