"""Files of a run: one MCAP file, bags of rosbag2, split recordings, compressed files.

A bag of any kind is read like one `McapFile`, as a `MessageSource`.
"""

import os
import shutil
import sqlite3
import tempfile
import weakref
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import zstandard
from mcap.records import Channel, Message, Schema

from symtop_ros.base.counts import write_count
from symtop_ros.run.log.inventory import FILE as INVENTORY
from symtop_ros.run.log.inventory import Bag
from symtop_ros.run.log.reader import MAX_MESSAGES, PIECE, LogError, McapFile
from symtop_ros.run.log.source import ZSTD_START, Loss, MessageSource, name_kind
from symtop_ros.run.log.writer import BEGUN_ENTRY, FILE_ENTRY, METADATA

MCAP, SQLITE, ZSTD = ".mcap", ".db3", ".zstd"
SUFFIXES = (MCAP, SQLITE, f"{MCAP}{ZSTD}", f"{SQLITE}{ZSTD}")
MALFORMED = "malformed"  # a word in SQLite's message on a damaged database
MAX_FILES = 10_000  # of one run
# Errors of SQLite about the disk, permissions, memory and locks: the file itself may be sound.
OF_MEDIUM = {
    *(sqlite3.SQLITE_PERM, sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED, sqlite3.SQLITE_NOMEM),
    *(sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_FULL, sqlite3.SQLITE_CANTOPEN),
}


def open_run(paths: Sequence[Path]) -> MessageSource:
    """Open files and rosbag2 folders as one run; their order does not matter."""
    found = {path: _files_of(path) for path in paths}
    files = [*dict.fromkeys(file for each in found.values() for file in each)]
    if len(files) > MAX_FILES:
        raise LogError(f"a run must have at most {MAX_FILES} files, got {len(files)}")
    sources = {file: _open(file) for file in files}
    opened = [*sources.values()]
    run = opened[0] if len(opened) == 1 else SeveralFiles(paths[0], opened)
    run.checks = [
        Bag(path, {file: sources[file] for file in own}).find_losses
        for path, own in found.items()
        if os.path.isdir(path)
    ]
    return run


def _files_of(path: Path) -> list[Path]:
    if not os.path.isdir(path):  # Path.is_dir raises for names that are too long
        return [path]
    files = sorted(file for suffix in SUFFIXES for file in path.glob(f"*{suffix}"))
    if not files:
        raise LogError(f"cannot open {path}: no .mcap or .db3 file in it")
    return _without_copies(path, files)


def _without_copies(folder: Path, files: list[Path]) -> list[Path]:
    """Return each file of a bag once, compressed or not.

    A player of rosbag2 unpacks compressed files next to them and leaves copies, perhaps in part;
    the metadata of the bag names the compressed ones. If there is no metadata, the recorder was
    killed, and a compressed file may be incomplete.
    """
    known = {*files}
    pairs = [(file, packed) for file in files if (packed := _packed(file)) in known]
    if not pairs:
        return files
    about = _read_metadata(folder)
    left_out = {file if packed.name in about else packed for file, packed in pairs}
    return [file for file in files if file not in left_out]


def _packed(file: Path) -> Path:
    return file.with_name(f"{file.name}{ZSTD}")


def _read_metadata(folder: Path) -> str:
    with suppress(OSError):
        return (folder / INVENTORY).read_text(errors="replace")
    return ""


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
        text = getattr(error, "strerror", None) or name_kind(
            path, f"it cannot be decompressed: {error}"
        )
        raise LogError(f"cannot open {path}: {text}") from None
    return copy, folder


class SqliteBag(MessageSource):
    """A bag of rosbag2's sqlite3 storage, which has no metadata."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        try:
            self.size = path.stat().st_size
            self._readable = self._find_readable()
            for row in self._rows("SELECT id, name, type, serialization_format FROM topics"):
                number = int(row[0])
                name, kind, encoding = map(str, row[1:])
                self.schemas[number] = Schema(number, b"", "ros2msg", kind)
                self.channels[number] = Channel(number, name, encoding, {}, number)
        except OSError as error:
            raise LogError(f"cannot open {path}: {error.strerror}") from None
        except (sqlite3.Error, ValueError) as error:
            raise LogError(f"cannot open {path}: {_describe_refusal(path, error)}") from None

    def _read(self) -> Iterator[list[Message]]:
        """Yield messages in the order of their arrival."""
        messages: list[Message] = []
        # In the order in which they arrived: simulated times may go back.
        query = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
        lost = 0
        try:
            for number, time, data in self._rows(query):
                is_readable = type(number) is type(time) is int and type(data) is bytes
                if len(messages) == MAX_MESSAGES or (lost and is_readable):
                    yield messages
                    messages = []
                    lost = self._report_rows(lost)
                if is_readable:
                    messages.append(Message(number, time, data, time, 0))
                lost += not is_readable
        except (sqlite3.Error, ValueError) as error:
            yield messages
            messages = []
            lost = self._report_rows(lost)
            what = "cannot be read" if _is_of_medium(error) else "is damaged"
            self.report(f"the bag {what} after the messages that were read: {error}")
        self.offset = self.size
        yield messages
        self._report_rows(lost)

    def _report_rows(self, lost: int) -> int:
        """Report rows without a readable message; return 0, the new number of unreported rows."""
        if lost:
            self.report(f"{write_count(lost, 'row')} without a message: the bag is damaged")
        return 0

    def _rows(self, query: str) -> Iterator[tuple[Any, ...]]:
        with closing(sqlite3.connect(self._readable, uri=True)) as database:
            yield from database.execute(query)

    def _find_readable(self) -> str:
        """Return the address at which SQLite reads the database and leaves no file next to it.

        A recorder that was killed may have left messages in a file next to the database (its
        write-ahead log). Immutable, without locks and files next to it, SQLite would ignore them;
        otherwise it makes an index next to them, if there is none, for which the disk may be
        read-only. So it gets a copy of both. Where an index is, a recorder may still be writing.
        """
        log, index = (self.path.with_name(f"{self.path.name}{end}") for end in ("-wal", "-shm"))
        path, mode = self.path.absolute(), "mode=ro&immutable=1"
        if log.exists() and index.exists():
            mode = "mode=ro"
        elif log.exists():
            folder = tempfile.TemporaryDirectory(prefix="symtop_ros_")
            weakref.finalize(self, folder.cleanup)
            for each in (path, log):
                shutil.copyfile(each, Path(folder.name, each.name))
            path, mode = Path(folder.name, path.name), "mode=ro"
        return f"{path.as_uri()}?{mode}"


def _is_of_medium(error: Exception) -> bool:
    """Return True if the disk or the system refused, and the file may be sound."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF in OF_MEDIUM


def _describe_refusal(path: Path, error: Exception) -> str:
    """Return why a database cannot be opened."""
    if _is_of_medium(error):
        return f"it cannot be read here ({error})"
    is_damaged = MALFORMED in str(error)
    return name_kind(
        path, "the bag is damaged" if is_damaged else f"not a bag of rosbag2 ({error})"
    )


class SeveralFiles(MessageSource):
    """Several logs, read one after the other in the order in which they were begun."""

    def __init__(self, path: Path, sources: Sequence[MessageSource]) -> None:
        super().__init__(path)
        self._files = _sort(sources)
        self._begins: list[int] = []
        self._numbers: dict[tuple[int, int], int] = {}
        self._places: dict[int, int] = {}  # of files, by the numbers of channels
        self.size = sum(source.size for source in sources)
        for place, source in enumerate(self._files):
            self._describe(place, source)

    @property
    def files(self) -> Sequence[MessageSource]:
        """The files in the order in which they are read."""
        return self._files

    @property
    def begins(self) -> Sequence[int]:
        """The number of messages before each file."""
        return self._begins

    def find_file(self, channel: int) -> MessageSource:
        """Return the file that has a channel."""
        return self._files[self._places[channel]]

    def _read(self) -> Iterator[list[Message]]:
        """Yield messages; numbers of channels are those of this run."""
        self._begins.clear()
        for place, source in enumerate(self._files):
            begin = self.count
            self._begins.append(begin)
            for messages in source.chunks():
                self._describe(place, source)
                self.offset = sum(each.offset for each in self._files)
                yield [
                    replace(each, channel_id=self._number(place, each.channel_id))
                    for each in messages
                ]
            self.metadata = source.metadata | self.metadata  # the first of several values counts
            self.losses += [
                Loss(
                    f"{source.path.name}: {each.text}",
                    None if each.place is None else begin + each.place,
                )
                for each in source.losses
            ]

    def _describe(self, place: int, source: MessageSource) -> None:
        """Take over the channels of a file that are new."""
        for number, channel in list(source.channels.items()):
            mine = self._number(place, number)
            if mine not in self.channels:
                self.channels[mine] = replace(channel, id=mine, schema_id=mine)
            schema = source.schemas.get(channel.schema_id)
            if schema and mine not in self.schemas:
                self.schemas[mine] = replace(schema, id=mine)

    def _number(self, place: int, number: int) -> int:
        """Return the number in this run of a channel in a file."""
        mine = self._numbers.setdefault((place, number), len(self._numbers) + 1)
        self._places[mine] = place
        return mine


def _sort(sources: Sequence[MessageSource]) -> list[MessageSource]:
    """Return files in the order in which their recorders have begun them.

    The clock of a run may go back, so the times of messages decide only if the node does not say
    by the clock of its host when each recording began, and which of its files each one is.
    """
    by_messages = sorted(sources, key=_begin)
    if all(BEGUN_ENTRY in each.metadata.get(METADATA, {}) for each in sources):
        return sorted(by_messages, key=_find_order)
    return by_messages


def _find_order(source: MessageSource) -> tuple[str, int]:
    values = source.metadata[METADATA]
    number = values.get(FILE_ENTRY, "1")
    return values[BEGUN_ENTRY], int(number) if number.isdecimal() and len(number) < 10 else 0


def _begin(source: MessageSource) -> tuple[int, str]:
    """Return the time of the first message, and the name for files that begin together."""
    first = next(source.chunks(), [])
    return (first[0].log_time if first else 0), source.path.name
