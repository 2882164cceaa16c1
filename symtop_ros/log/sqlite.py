"""Bags of rosbag2's sqlite3 storage."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

from mcap.records import Channel, Message, Schema

from symtop_ros.log.reader import MAX_MESSAGES, LogError

# In the order in which they arrived: simulated times may go back.
MESSAGES = "SELECT topic_id, timestamp, data FROM messages ORDER BY id"
TOPICS = "SELECT id, name, type, serialization_format FROM topics"


class SqliteBag:
    """A bag of rosbag2's sqlite3 storage, read with the attributes of an `McapFile`."""

    def __init__(self, path: Path) -> None:
        self.path, self.offset = path, 0
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.problems: list[str] = []
        self.metadata: dict[str, dict[str, str]] = {}  # a bag has none
        try:
            self.size = path.stat().st_size
            for number, name, kind, encoding in self._rows(TOPICS):
                self._add_topic(int(number), str(name), str(kind), str(encoding))
        except OSError as error:
            raise LogError(f"cannot open {path}: {error.strerror}") from None
        except (sqlite3.Error, ValueError) as error:
            raise LogError(f"cannot open {path}: not a bag of rosbag2 ({error})") from None

    def _add_topic(self, number: int, name: str, kind: str, encoding: str) -> None:
        self.schemas[number] = Schema(number, b"", "ros2msg", kind)
        self.channels[number] = Channel(number, name, encoding, {}, number)

    def chunks(self) -> Iterator[list[Message]]:
        """Yield messages in the order of their arrival."""
        self.problems.clear()
        messages: list[Message] = []
        try:
            for number, time, data in self._rows(MESSAGES):
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
