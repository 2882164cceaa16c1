"""One MCAP file from its first byte to its index; what was flushed survives any failure."""

import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from datetime import datetime, timezone
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import BinaryIO

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.well_known import MessageEncoding, Profile, SchemaEncoding
from mcap.writer import CompressionType, Writer

from symtop_ros import __version__
from symtop_ros.run.simulation.topics import DEFAULT_NAME, Topic

MAGIC = b"\x89MCAP0\r\n"
CHUNK_SIZE = 4 * 2**20  # bytes; at 1 kHz the flush every half second closes chunks earlier
METADATA = "symtop_ros"  # name of the metadata record written at the start
ENDING = "symtop_ros.end"  # name of the metadata record written at the end
REPAIR, REPAIR_LOSSES = "symtop_ros.repair", "losses"  # that of a repair, and what it has lost
# Entries of the metadata: JSON of the topics' full names by ours, the full name of the node, the
# host's time at the beginning of a recording, and the number of a file in it.
MAX_OWNER = 200  # characters; a file name has 255 at most
TOPICS_ENTRY, NODE_ENTRY, BEGUN_ENTRY, FILE_ENTRY = "topics", "node", "clock.host", "file"


class LogFile:
    """An open log."""

    def __init__(
        self,
        directory: Path,
        channels: Iterable[Topic],  # with their full names
        metadata: Mapping[str, str],
        head: Mapping[int, bytes],
    ) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        node = metadata.get(NODE_ENTRY, DEFAULT_NAME)
        self.path, self._file = _open_new(directory.absolute(), node)
        self.size = 0  # bytes of complete chunks, which a killed process does not lose
        self._head = dict(sorted(head.items()))
        self._first: int | None = None
        self._last = 0
        self._has_messages = False  # True if complete chunks have some
        self._writer = Writer(self._file, CHUNK_SIZE, CompressionType.ZSTD, enable_data_crcs=True)
        try:
            self._writer.start(Profile.ROS2, f"symtop_ros {__version__}")
            self._writer.add_metadata(METADATA, dict(metadata))
            if name := metadata.get("ros_distro"):
                # for `ros2 bag info`; it takes an empty text as no further metadata
                self._writer.add_metadata(
                    "rosbag2", {"serialized_metadata": "", "ROS_DISTRO": name}
                )
            self._ids = [self._register(channel) for channel in channels]
            self.flush()
        except Exception:
            self.abandon()
            raise

    def write(self, channel: int, stamp: int, data: bytes) -> None:
        """Append a message with its stamp (ns of the clock of the simulation)."""
        if self._first is None:
            self._first = stamp
            for index, message in self._head.items():
                self._writer.add_message(self._ids[index], stamp, message, stamp)
        self._last = stamp
        self._writer.add_message(self._ids[channel], stamp, data, stamp)

    def flush(self) -> None:
        """Close the chunk and hand everything to the operating system.

        A process that is killed afterwards loses nothing of it.
        """
        self._writer.flush()  # type: ignore[no-untyped-call]
        if not self._exists():
            raise FileNotFoundError("the file was removed")
        self.size = self._file.tell()
        self._has_messages = self._first is not None

    @property
    def duration(self) -> float:
        """Seconds between the first and the last stamp."""
        return 0.0 if self._first is None else (self._last - self._first) * 1e-9

    def finish(self, ending: Mapping[str, str]) -> None:
        """Write the index and close the file; without any message it is removed.

        A run may end before its first sample.
        """
        if self._first is None:
            self._file.close()
            self.path.unlink(missing_ok=True)
            return
        self.flush()
        self._writer.add_metadata(ENDING, dict(ending))
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._file.close()

    def abandon(self) -> None:
        """Close after an error: cut an incomplete chunk and end the file without an index.

        A file without any message is removed.
        """
        if self._file.closed:
            return
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            if not self._has_messages:
                self.path.unlink()
            os.truncate(self.path, self.size)
            with self.path.open("ab") as file:
                file.write(_end())

    def _exists(self) -> bool:
        """Return True if the path still leads to the file.

        A file that was unlinked accepts writes without an error, and they are lost.
        """
        with suppress(OSError):
            return os.path.samestat(self.path.stat(), os.fstat(self._file.fileno()))
        return False

    def _register(self, topic: Topic) -> int:
        known = load_definitions()[topic.type]
        qos = _qos_profile(topic)
        schema = self._writer.register_schema(
            topic.type, SchemaEncoding.ROS2, known["text"].encode()
        )
        metadata = {"offered_qos_profiles": qos, "topic_type_hash": known["hash"]}
        return self._writer.register_channel(topic.ros_name, MessageEncoding.CDR, schema, metadata)


@cache
def load_definitions() -> dict[str, dict[str, str]]:
    """Return "text" and "hash" of each logged type, by its name.

    The text is the .msg of the type, followed by those of all dependencies in the form of rosbag2,
    the hash that of its description (REP-2016). They are shipped, so that a log can be written
    without ROS; a test compares them with those of the installed ROS 2.
    """
    file = files("symtop_ros.run.log").joinpath("definitions.json")
    return dict(json.loads(file.read_text(encoding="utf-8")))


def _qos_profile(topic: Topic) -> str:
    """Return the quality of service in the YAML that every version of rosbag2 reads.

    Policies are numbers of rmw: history 1 keep last, reliability 1 reliable, durability 1 transient
    local or 2 volatile, liveliness 1 automatic; 9223372036.854775807 s is infinite. rosbag2 offers
    the topic with this profile when it plays the log, so late subscribers get latched messages.
    """
    infinite = "{sec: 9223372036, nsec: 854775807}"
    return (
        f"- {{history: 1, depth: {topic.depth}, reliability: 1, durability: "
        f"{1 if topic.latched else 2}, deadline: {infinite}, lifespan: {infinite}, liveliness: 1, "
        f"liveliness_lease_duration: {infinite}, avoid_ros_namespace_conventions: false}}"
    )


def _open_new(directory: Path, node: str) -> tuple[Path, BinaryIO]:
    """Return the path of a file that did not exist, and the file; its name begins with the node's.

    `node` is the full name, such as "/a/disc".
    """
    owner = node.strip("/").replace("/", "_")[:MAX_OWNER]
    name = f"{owner}_{datetime.now(timezone.utc):%Y-%m-%dT%H-%M-%SZ}"
    path = directory / f"{name}.mcap"
    number = 1
    while True:
        try:
            return path, path.open("xb")
        except FileExistsError:  # maybe of another node, a moment ago
            number += 1
            path = directory / f"{name}_{number}.mcap"


def _end() -> bytes:
    """Return the end of a valid file without an index."""
    builder = RecordBuilder()
    DataEnd(0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    return bytes(builder.end()) + MAGIC  # type: ignore[no-untyped-call]
