"""The topics of a run: each message is encoded once, and goes to its publisher and to the log.

A topic without a subscriber is not computed unless it is logged. Markers are for viewers that draw
no vectors themselves: three arrows, and the trace of the axis.
"""

from collections import deque
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from functools import partial
from math import hypot
from typing import Protocol

from symtop_ros.base.arrays import Real, Stamps, Vector
from symtop_ros.physics import Body
from symtop_ros.run.log.recorder import Recorder
from symtop_ros.run.models.urdf import LENGTH, robot_description
from symtop_ros.run.simulation.block import Block
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.host import Host
from symtop_ros.run.simulation.sensor.imu import ALONG, Imu
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import (
    APPLIED_TORQUE,
    CLOCK,
    DESCRIPTION,
    DIAGNOSTICS,
    EVENTS,
    MARKERS,
    POINTS,
    SAMPLE_TOPICS,
    TF_STATIC,
    Topic,
    centre_frame,
    imu_frame,
)
from symtop_ros.run.wire import messages
from symtop_ros.run.wire.diagnostics import Status, encode_statuses
from symtop_ros.run.wire.layout import NANOSECONDS, Writer, encode_string
from symtop_ros.run.wire.messages import Transform

PERIOD = NANOSECONDS // 30  # ns between two sets of markers
TRACE_LENGTH = 150  # points of the trace: 5 s
# By topic: colour, and length of the arrow for the largest vector so far, in lengths of the top.
ARROWS = {
    "angular_velocity": ((0.2, 0.55, 0.95), 1.4),
    "angular_momentum": ((0.95, 0.6, 0.1), 1.2),
    "torque": ((0.85, 0.2, 0.25), 0.7),
}
TRACE_COLOR = (0.95, 0.95, 0.95)
# of the shaft and the head of an arrow, and of the trace
ARROW_WIDTHS = (0.02 * LENGTH, 0.05 * LENGTH, 0.0)
TRACE_WIDTHS = (0.01 * LENGTH, 0.0, 0.0)
ARROW, LINE_STRIP, ADD = 0, 4, 0  # constants of visualization_msgs/Marker
POSE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # in the world frame itself
ORIGIN = (0.0, 0.0, 0.0)


class Publisher(Protocol):
    """Sends the bytes of messages to subscribers."""

    @property
    def has_subscriber(self) -> bool:
        """True if somebody subscribes to the topic."""

    def publish(self, data: bytes) -> None:
        """Publish an encoded message."""


class OutputHost(Host, Protocol):
    """A host with publishers."""

    def resolve(self, topic: Topic) -> str:
        """Return the full name of a topic."""

    def create_publisher_of(self, topic: Topic) -> Publisher | None:
        """Return a publisher, or None if the topic is only logged."""

    def update_statuses(self) -> list[Status]:
        """Bring its own part of the diagnostics up to date, and return it."""


class Output:
    """One topic: its publisher and its channel in the log."""

    def __init__(self, topic: Topic, host: OutputHost, recorder: Recorder) -> None:
        self._publisher = host.create_publisher_of(topic)
        self._latched = topic.latched
        self._recorder = recorder
        self.channel = recorder.add_channel(host.resolve(topic), topic)
        self.enabled = True  # set to False to log the topic without publishing it

    @property
    def is_published(self) -> bool:
        """True if it has a publisher and is enabled."""
        return self.enabled and self._publisher is not None

    def send(self, stamp: int, encode: Callable[[], bytes]) -> None:
        """Publish and log a message with its stamp (ns); it is encoded if it is needed."""
        to, recorder = self._publisher, self._recorder
        if to and not (self._latched or (self.enabled and to.has_subscriber)):
            to = None
        if to or self._latched or recorder.running:
            data = encode()
            if to:
                to.publish(data)
            if self._latched:
                recorder.latched[self.channel] = data
            if recorder.running:
                recorder.add(self.channel, stamp, data)


class Outputs:
    """All topics of a run; the sink of its simulation."""

    def __init__(
        self,
        settings: Settings,
        host: OutputHost,
        recorder: Recorder,
        name: str,
        points: str = "",  # JSON of measured points, which the log keeps
    ) -> None:
        add = partial(Output, host=host, recorder=recorder)
        self._recorder, self._name = recorder, name
        self._frame = settings.world_frame
        self._events = add(EVENTS)
        self._description = add(DESCRIPTION)
        topics = {
            n: each
            for n, each in SAMPLE_TOPICS.items()
            if not each.switch or settings.values[each.switch]
        }
        self._samples = {name: add(topic) for name, topic in topics.items()}
        self._layouts = {
            name: topic.layout(settings.world_frame, settings.top_frame)
            for name, topic in topics.items()
        }
        self._fixed_frames = add(TF_STATIC) if settings.imu or settings.odometry else None
        self._diagnostics = add(DIAGNOSTICS)
        self._clock = add(CLOCK) if settings.publish_clock else None
        self._markers = Markers(settings.world_frame)
        self._marker_output = add(MARKERS) if settings.publish_markers else None
        self._torque = recorder.add_channel(host.resolve(APPLIED_TORQUE), APPLIED_TORQUE)
        if points:
            add(POINTS).send(0, lambda: encode_string(points))
        self.enable_tf(settings.publish_tf)

    def enable_tf(self, enabled: bool) -> None:
        """Publish /tf or not; it is always logged."""
        self._samples["tf"].enabled = enabled

    def encode(self, topic: str, stamps: Stamps, numbers: Real) -> list[bytes]:
        """Encode samples of a topic from their stamps (n,) in ns and their doubles (n, width)."""
        return self._layouts[topic].encode_many(stamps, numbers)

    def send_sample(self, stamp: int, block: Block) -> None:
        """Publish and log the sample of a stamp (ns) on the topics that are needed."""
        for name, output in self._samples.items():
            output.send(stamp, partial(block.message, name, stamp))
        if self._marker_output and self._markers.is_due(stamp):
            self._marker_output.send(stamp, partial(self._markers.encode, stamp, block))
        self.send_clock(stamp)

    def send_clock(self, now: int) -> None:
        """Publish and log /clock (ns), if that is asked for."""
        if self._clock:
            self._clock.send(now, lambda: messages.CLOCK.encode(now, ()))

    def log_torque(self, stamp: int, data: bytes) -> None:
        """Log an encoded torque that was received."""
        self._recorder.add(self._torque, stamp, data)

    def send_event(self, event: Event) -> None:
        """Publish and log an event."""
        self._events.send(event.stamp, lambda: event.encode(self._frame, self._name))

    def send_description(self, stamp: int, settings: Settings) -> None:
        """Publish and log the URDF of the top, and the frames on its body."""
        urdf = robot_description(
            settings.top,
            settings.world_frame,
            settings.top_frame,
            tf_moves_it=self._samples["tf"].is_published,
            body=settings.body,
        )
        self._description.send(stamp, lambda: encode_string(urdf))
        if self._fixed_frames:
            body = settings.odometry and settings.body
            transforms = list_fixed_frames(settings.top_frame, settings.imu, body or None)
            self._fixed_frames.send(stamp, lambda: messages.encode_transforms(stamp, transforms))

    def send_diagnostics(self, stamp: int, collect: Callable[[], list[Status]]) -> None:
        """Publish and log diagnostics if needed; each status bears the name of the node."""

        def encode() -> bytes:
            prefix = f"{self._name.lstrip('/')}: "
            named = [each._replace(name=prefix + each.name) for each in collect()]
            return encode_statuses(stamp, self._frame, named, self._name)

        self._diagnostics.send(stamp, encode)

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""
        recorder = self._recorder
        return recorder.put_first(self._events.channel) if recorder.running else nullcontext()


def list_fixed_frames(frame: str, imu: Imu | None, body: Body | None) -> list[Transform]:
    """Return the frames on the body: that of the sensor, and that in the centre of mass."""
    transforms = []
    if imu:
        transforms.append(Transform(frame, imu_frame(frame), imu.position, imu.orientation))
    if body:
        transforms.append(Transform(frame, centre_frame(frame), (0.0, 0.0, body.arm), ALONG))
    return transforms


@dataclass
class Markers:
    """The content of `~/markers`, in a fixed frame."""

    frame: str
    next: int = 0  # stamp (ns) from which on the next set is due
    largest: dict[str, float] = field(default_factory=lambda: dict.fromkeys(ARROWS, 0.0))
    trace: deque[Vector] = field(default_factory=lambda: deque(maxlen=TRACE_LENGTH))

    def is_due(self, stamp: int) -> bool:
        """Return True thirty times a second, on a grid: for any rate of the samples."""
        if self.next - PERIOD <= stamp < self.next:  # a clock may also jump back
            return False
        self.next = (stamp // PERIOD + 1) * PERIOD
        return True

    def encode(self, stamp: int, block: Block) -> bytes:
        """Encode the MarkerArray of a sample (stamp in ns)."""
        self.trace.append(_axis_end(block.numbers("orientation", stamp)))
        writer = Writer()
        trace = list(self.trace)
        writer.integer(1 + len(ARROWS))
        _write(writer, stamp, (self.frame, "trace"), LINE_STRIP, TRACE_WIDTHS, TRACE_COLOR, trace)
        for name, (color, length) in ARROWS.items():
            # the last three numbers: messages with six have zeros before the vector
            vector = block.numbers(name, stamp)[-3:]
            self.largest[name] = max(self.largest[name], hypot(*vector))
            scale = LENGTH * length / (self.largest[name] or 1.0)
            x, y, z = (scale * each for each in vector)
            points = (ORIGIN, (x, y, z))
            _write(writer, stamp, (self.frame, name), ARROW, ARROW_WIDTHS, color, points)
        return writer.data


def _write(
    writer: Writer,
    stamp: int,
    names: tuple[str, str],  # the frame and the namespace
    kind: int,
    widths: Vector,
    color: Vector,
    points: Sequence[Vector],
) -> None:
    """Write a visualization_msgs/Marker; its textures, texts and meshes are empty."""
    writer.stamp(stamp)
    writer.strings(names)
    writer.numbers((0, kind, ADD), "i")  # id, type, action
    writer.numbers([*POSE, *widths])
    writer.numbers([*color, 1.0], "f")
    writer.stamp(0)  # lifetime: for ever
    writer.integer(0, "B")  # frame_locked
    writer.integer(len(points))
    writer.numbers([each for point in points for each in point])
    writer.integer(0)  # colors
    writer.strings([""])  # texture_resource
    writer.stamp(0)  # of the texture, then its frame, format and data
    writer.strings(["", ""])
    writer.numbers((0, 0), "I")  # the latter's length, and that of uv_coordinates
    writer.strings(["", "", ""])  # text, mesh_resource, and the name of mesh_file
    writer.integer(0)  # its data
    writer.integer(0, "B")  # mesh_use_embedded_materials


def _axis_end(quaternion: Sequence[float]) -> Vector:
    """Return the upper end of the axis for an orientation x, y, z, w."""
    x, y, z, w = quaternion
    return (
        2 * LENGTH * (x * z + w * y),
        2 * LENGTH * (y * z - w * x),
        LENGTH * (1.0 - 2.0 * (x * x + y * y)),
    )
