"""Logs as the node writes them, without waiting for a node."""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
from mcap.writer import Writer

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Friction, Motion, State, Top, kick_verdict, regular_precession_rates
from symtop_ros.run.log.reader import MAGIC, RECORD_START, McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.log.writer import NODE_ENTRY, TOPICS_ENTRY, LogFile
from symtop_ros.run.models.urdf import robot_description
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.changes.requests import plan_kick
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import DESCRIPTION, EVENTS, STATE_TOPICS, Samples
from symtop_ros.run.wire.layout import encode_string
from symtop_ros.run.wire.messages import decode_messages

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
SLOW = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[0]
REGULAR = State.from_euler(theta=0.5, phi_dot=SLOW, psi_dot=200.0)
NO_FRICTION = Friction()
BEGIN = 1_795_000_000_000_000_000  # ns
LAYOUTS = {name: topic.layout("world", "top") for name, topic in STATE_TOPICS.items()}
TOPICS = (EVENTS, *STATE_TOPICS.values(), DESCRIPTION)
CHANNELS = {topic.name: number for number, topic in enumerate(TOPICS)}


def topic(name: str, node: str = "/top") -> str:
    return "/tf" if name == "tf" else f"{node}/{name}"


@dataclass
class Run:
    """A run of some seconds, hurried in the middle, and its messages by topic."""

    top: Top = ARTICLE
    start: State = field(default_factory=lambda: CUSPS)
    seconds: float = 2.0
    rate: float = 200.0
    hurried: bool = True
    described: bool = False
    frame: str = "top"
    friction: Friction = NO_FRICTION
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    begin: int = BEGIN  # stamp in ns
    messages: list[tuple[str, int, bytes]] = field(default_factory=list)

    def __post_init__(self) -> None:
        motion = Motion(self.top, self.start, self.friction, self.torque)
        segment = Segment.begin(motion, self.begin, 1.0)
        self._announce(Event.of(Change.begin(segment), top_frame=self.frame))
        count = int(self.seconds * self.rate)
        stamps = [self.begin + round(k * 1e9 / self.rate) for k in range(count)]
        half = count // 2 if self.hurried else count
        self._samples(segment, stamps[:half])
        if self.hurried:
            stamp = stamps[half]
            request = {"precession_rate_factor": 1.4}
            before = segment.state_at(stamp)
            kicked, hold = plan_kick(segment.motion, before, request)
            segment = segment.replace_motion(kicked, stamp)
            outcome = kick_verdict(kicked, before, hold)
            kick = Change(Act("kick", stamp, request), before, segment, outcome)
            self._announce(Event.of(kick, 2, self.frame))
            self._samples(segment, stamps[half:])

    def _announce(self, event: Event) -> None:
        self.messages.append(("events", event.stamp, event.encode("world")))

    def _samples(self, segment: Segment, stamps: list[int]) -> None:
        samples = Samples.at(segment, np.array(stamps))
        columns = {name: each.compute(samples).tolist() for name, each in STATE_TOPICS.items()}
        layouts = {name: each.layout("world", self.frame) for name, each in STATE_TOPICS.items()}
        for k, stamp in enumerate(stamps):
            for name, layout in layouts.items():
                self.messages.append((name, stamp, layout.encode(stamp, columns[name][k])))

    def places(self, name: str) -> list[int]:
        """Places of the messages of a topic."""
        return [place for place, each in enumerate(self.messages) if each[0] == name]

    def without(self, name: str) -> Self:
        """Leave the messages of a topic out."""
        self.messages = [each for each in self.messages if each[0] != name]
        return self

    def change(self, place: int, act: Callable[[Real], Real]) -> None:
        """Change the numbers of a sample."""
        name, stamp, data = self.messages[place]
        ((found,), _) = decode_messages(STATE_TOPICS[name].format, [data])
        changed = LAYOUTS[name].encode(stamp, act(found.numbers[0]).tolist())
        self.messages[place] = name, stamp, changed

    def open(self, folder: Path) -> TopLog:
        """Write the log, and open it."""
        return TopLog(McapFile(self.write(folder)))

    def write(self, folder: Path) -> Path:
        """Write the log, with a chunk for each half second, and return its path."""
        channels = [replace(each, ros_name=each.resolve("/top")) for each in TOPICS]
        names = {each.name: each.resolve("/top") for each in TOPICS}
        about = {"version": "test", NODE_ENTRY: "/top", TOPICS_ENTRY: json.dumps(names)}
        log = LogFile(folder, channels, about, {})
        flushed = self.begin
        if self.described:
            urdf = encode_string(robot_description(self.top, "world", "top"))
            log.write(CHANNELS["robot_description"], self.begin, urdf)
        for name, stamp, data in self.messages:
            if stamp - flushed >= 500_000_000:
                log.flush()
                flushed = stamp
            log.write(CHANNELS[name], stamp, data)
        log.finish({"dropped": "0"})
        return log.path


Sent = Iterable[tuple[str, str, Iterable[tuple[int, bytes]]]]


def write_mcap(path: Path, topics: Sent, encoding: str = "cdr", **options: Any) -> Path:
    """Write a log as another program would: names, types, and messages with their log times."""
    messages = []
    with path.open("wb") as stream:
        writer = Writer(stream, **options)
        writer.start("ros2")
        for name, kind, sent in topics:
            schema = writer.register_schema(kind, "ros2msg", b"")
            channel = writer.register_channel(name, encoding, schema)
            messages += [(stamp, channel, data) for stamp, data in sent]
        for stamp, channel, data in sorted(messages, key=lambda each: each[0]):
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()
    return path


def list_records(data: bytes) -> Iterable[tuple[int, int, int]]:
    """Opcode, beginning and end of the content of each record of a file."""
    place = len(MAGIC)
    while place < len(data) - len(MAGIC):
        opcode, length = RECORD_START.unpack_from(data, place)
        begin = place + RECORD_START.size
        place = begin + length
        yield opcode, begin, place
