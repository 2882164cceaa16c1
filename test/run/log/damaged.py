"""Logs of sessions, as messages that tests take out, repeat or damage and write again."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Self

from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Message, Schema
from mcap.writer import Writer
from run.session.test_outputs import SECOND, Program, advance, start

from symtop_ros.run.log.reader import McapFile

CHUNK = SECOND // 4  # ns of the chunks that are written; the node flushes twice a second
RATE = 100.0


class Named(Program):
    """A host whose topics may be remapped."""

    def __init__(self, names: Mapping[str, str] | None = None) -> None:
        super().__init__(publishes=False)
        self.names = names or {}

    def resolve(self, topic: Any) -> str:
        """Return the full name of a topic."""
        return self.names.get(topic.ros_name, topic.resolve("/top"))


class Recorded:
    """A session that is recorded while its clock is moved."""

    def __init__(
        self,
        folder: Path,
        names: Mapping[str, str] | None = None,
        scene: str = "hurry_slow",
        **changes: Any,
    ) -> None:
        self.folder = folder
        options = {"record__enabled": True, "record__directory": str(folder), "publish_rate": RATE}
        self.session, self.clock = start(Named(names), scene, **{**options, **changes})

    def run(self, seconds: float) -> None:
        """Let the clock run, with diagnostics once a second of it."""
        end = self.clock.now + round(seconds * SECOND)
        while self.clock.now < end:
            before = self.clock.now
            advance(self.session, self.clock, min(SECOND // 10, end - before) / SECOND)
            if self.clock.now // SECOND > before // SECOND:
                self.session.keep_up()

    def ask(self, service: str, value: Any = None) -> None:
        """Have a request carried out."""
        granted, text = self.session.answer(service, lambda: value)
        assert granted, text

    def kick(self) -> None:
        """Make the top precess faster."""
        self.ask("kick", {"precession_rate_factor": 1.2})

    def jump(self, time: float) -> None:
        """Set the clock to a time in s."""
        self.session.simulation.begin_jump()
        self.clock.now = round(time * SECOND)
        self.session.simulation.end_jump(True)
        advance(self.session, self.clock, 0.0)

    def stop(self, seconds: float) -> None:
        """Let the clock run while the process is stopped: samples are missed."""
        advance(self.session, self.clock, seconds)

    def close(self) -> list[Path]:
        """End the recording; return the files in the order of their names."""
        self.session.close()
        return sorted(self.folder.glob("*.mcap"))


@dataclass
class Log:
    """The messages of a file, and all else that it has."""

    messages: list[Message]
    channels: dict[int, Channel]
    schemas: dict[int, Schema]
    metadata: dict[str, dict[str, str]]
    attachments: list[Attachment] = field(default_factory=list)

    @classmethod
    def read(cls, path: Path) -> Self:
        """Return the contents of a file that is sound."""
        file = McapFile(path)
        messages = [each for chunk in file.chunks() for each in chunk]
        assert not file.problems
        return cls(messages, file.channels, file.schemas, file.metadata)

    def places(self, topic: str) -> list[int]:
        """Return the places of the messages of a topic, by the end of its full name."""
        return [k for k, each in enumerate(self.messages) if self.topic(each).endswith(topic)]

    def topic(self, message: Message) -> str:
        """Return the full name of the topic of a message."""
        return self.channels[message.channel_id].topic

    def find_time(self, time: int) -> int:
        """Return the first place that was logged at a time (ns) or later."""
        return next(k for k, each in enumerate(self.messages) if each.log_time >= time)

    def without(self, places: Iterable[int]) -> Self:
        """Return the log without some messages."""
        lost = set(places)
        kept = [each for k, each in enumerate(self.messages) if k not in lost]
        return replace(self, messages=kept)

    def split(self, places: Iterable[int]) -> list[Self]:
        """Return files that end before places, each with the latest event first, as recorded."""
        parts: list[Self] = []
        latest: list[Message] = []
        ends = pairwise((0, *places, len(self.messages)))
        for number, (begin, end) in enumerate(ends, start=1):
            part = self.messages[begin:end]
            head = [replace(each, log_time=part[0].log_time) for each in latest]
            file = self.metadata["symtop_ros"] | {"file": str(number)}
            about = {**self.metadata, "symtop_ros": file}
            parts.append(replace(self, messages=head + part, metadata=about))
            events = [each for each in part if self.topic(each).endswith(("/events", "/ev"))]
            latest = events[-1:] or latest
        return parts

    def change(self, place: int, act: Callable[[bytes], bytes]) -> Self:
        """Return the log with other bytes in a message."""
        changed = replace(self.messages[place], data=act(bytes(self.messages[place].data)))
        messages = [changed if k == place else each for k, each in enumerate(self.messages)]
        return replace(self, messages=messages)

    def write(self, path: Path, chunk: int = CHUNK, **options: Any) -> Path:
        """Write the log with chunks of a length in ns, or with one that ends at each jump."""
        with path.open("xb") as stream:
            writer = Writer(stream, enable_data_crcs=True, **options)
            writer.start("ros2", "a test")
            numbers = {n: self.register(writer, each) for n, each in self.channels.items()}
            for name in [each for each in self.metadata if not each.endswith(".end")]:
                writer.add_metadata(name, self.metadata[name])
            before = None
            for each in self.messages:
                if before is not None and each.log_time // chunk != before // chunk:
                    writer.flush()
                before = each.log_time
                number = numbers[each.channel_id]
                writer.add_message(number, each.log_time, each.data, each.publish_time)
            writer.flush()
            for each in self.attachments:
                writer.add_attachment(0, 0, each.name, each.media_type, each.data)
            for name in [each for each in self.metadata if each.endswith(".end")]:
                writer.add_metadata(name, self.metadata[name])
            writer.finish()
        return path

    def register(self, writer: Writer, channel: Channel) -> int:
        schema = self.schemas[channel.schema_id]
        number = writer.register_schema(schema.name, schema.encoding, schema.data)
        return writer.register_channel(
            channel.topic, channel.message_encoding, number, channel.metadata
        )


def cut_end(path: Path) -> Path:
    """Cut a file behind its last chunk, as the end of the process leaves it."""
    path.write_bytes(path.read_bytes()[: list_chunks(path)[-1][1]])
    return path


def list_chunks(path: Path) -> list[tuple[int, int, int, int]]:
    """Return begin and end of each chunk's content in a file, and its first and last log time."""
    data = path.read_bytes()
    found = []
    place = 8
    while place + 9 <= len(data):
        opcode = data[place]
        length = int.from_bytes(data[place + 1 : place + 9], "little")
        begin = place + 9
        if opcode == Opcode.CHUNK:
            times = (int.from_bytes(data[k : k + 8], "little") for k in (begin, begin + 8))
            found.append((begin, begin + length, *times))
        place = begin + length
    return found


def zero(path: Path, begin: int, count: int = 40) -> None:
    """Overwrite bytes of a file by zeros."""
    data = bytearray(path.read_bytes())
    data[begin : begin + count] = bytes(count)
    path.write_bytes(data)


def zero_chunk(path: Path, time: int) -> None:
    """Damage the chunk of a log time."""
    begin, end, *_ = next(c for c in list_chunks(path) if c[2] <= time <= c[3])
    zero(path, (begin + end) // 2)
