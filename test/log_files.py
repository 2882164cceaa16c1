"""Logs as the node writes them, without waiting for it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from rclpy.serialization import serialize_message
from std_msgs.msg import String

from symtop_ros.node.urdf import robot_description
from symtop_ros.physics import Friction, State, Top, hurry, motion
from symtop_ros.recording.log_file import Channel, LogFile
from symtop_ros.run.events import PREFIX, Event
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment
from symtop_ros.wire import messages
from symtop_ros.wire.diagnostics import OK, Status, packed

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
NO_FRICTION = Friction()
BEGIN = 1_795_000_000_000_000_000  # ns
LAYOUTS = {
    "orientation": messages.quaternion("world"),
    "angular_velocity": messages.twist("world"),
    "angular_momentum": messages.vector("world"),
    "torque": messages.twist("world"),
    "euler_angles": messages.joints("world"),
    "tf": messages.transform("world", "top"),
}


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
    friction: Friction = NO_FRICTION
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)
    messages: list[tuple[str, int, bytes]] = field(default_factory=list)

    def __post_init__(self) -> None:
        path = motion(self.top, self.start, self.friction, self.torque)
        segment = Segment.begin(path, BEGIN, 1.0)
        self._announce("start", self.start, segment, BEGIN)
        count = int(self.seconds * self.rate)
        stamps = [BEGIN + round(k * 1e9 / self.rate) for k in range(count)]
        half = count // 2 if self.hurried else count
        self._samples(segment, stamps[:half])
        if self.hurried:
            before = segment.state_at(stamps[half])
            segment = segment.restarted(hurry(self.top, before, factor=1.4), stamps[half])
            self._announce("kick", before, segment, stamps[half])
            self._samples(segment, stamps[half:])

    def _announce(self, name: str, before: State, segment: Segment, stamp: int) -> None:
        event = Event.of(stamp, name, "as told", {}, before, segment)
        data = packed(stamp, "world", [Status(stamp, OK, PREFIX + name, "as told", event.values)])
        self.messages.append(("events", stamp, data))

    def _samples(self, segment: Segment, stamps: list[int]) -> None:
        state = segment.state_at(np.array(stamps))
        columns = {name: SAMPLES[name](segment.path, state).tolist() for name in LAYOUTS}
        for k, stamp in enumerate(stamps):
            for name, layout in LAYOUTS.items():
                self.messages.append((name, stamp, layout.pack(stamp, columns[name][k])))

    def write(self, folder: Path) -> Path:
        """Write the log, with a chunk of each half second, and return its path."""
        kinds = {"events": "diagnostic_msgs/msg/DiagnosticArray", **messages.KINDS}
        channels = [Channel(topic(name), kind) for name, kind in kinds.items()]
        channels.append(Channel("/robot_description", "std_msgs/msg/String"))
        numbers = {name: number for number, name in enumerate(kinds)}
        log = LogFile(folder, channels, {"version": "test"}, {})
        flushed = BEGIN
        if self.described:
            text = robot_description(self.top, "world", "top")
            log.write(len(kinds), BEGIN, serialize_message(String(data=text)))
        for name, stamp, data in self.messages:
            if stamp - flushed >= 500_000_000:
                log.flush()
                flushed = stamp
            log.write(numbers[name], stamp, data)
        log.finish({"dropped": "0"})
        return log.path
