"""The topics of a run: each message is encoded once, and goes to its publisher and to the log.

A topic without a subscriber is not computed unless it is logged.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial
from typing import Protocol

from symtop_ros.arrays import Real, Stamps
from symtop_ros.log.recorder import Recorder
from symtop_ros.models.urdf import robot_description
from symtop_ros.physics import Body
from symtop_ros.session.markers import Markers
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.host import Host
from symtop_ros.simulation.sensor.imu import ALONG, Imu, find_body
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.topics import (
    APPLIED_TORQUE,
    CLOCK,
    DIAGNOSTICS,
    EVENTS,
    MARKERS,
    SAMPLE_TOPICS,
    TF_STATIC,
    Topic,
    centre_frame,
    choose_description,
    imu_frame,
)
from symtop_ros.wire import messages
from symtop_ros.wire.diagnostics import Status, encode_statuses
from symtop_ros.wire.layout import encode_string
from symtop_ros.wire.messages import Transform


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
        self._latched, self._recorder = topic.latched, recorder
        self.channel = recorder.add_channel(host.resolve(topic), topic)
        self.enabled = True  # set to False to log the topic without publishing it

    @property
    def is_published(self) -> bool:
        """True if it has a publisher and is enabled."""
        return self.enabled and self._publisher is not None

    def send(self, stamp: int, encode: Callable[[], bytes]) -> None:
        """Publish and log a message with its stamp (ns); it is encoded if it is needed."""
        to, is_kept = self._publisher, self._latched or self._recorder.running
        if to and not (self._latched or (self.enabled and to.has_subscriber)):
            to = None
        if to or is_kept:
            data = encode()
            if to:
                to.publish(data)
            if is_kept:
                self._recorder.add(self.channel, stamp, data)


class Outputs:
    """All topics of a run; the sink of its simulation."""

    def __init__(self, settings: Settings, host: OutputHost, recorder: Recorder, name: str) -> None:
        add = partial(Output, host=host, recorder=recorder)
        self._recorder, self._name = recorder, name
        self._frame = settings.world_frame
        frames = settings.world_frame, settings.top_frame
        self._events, self._description = add(EVENTS), add(choose_description(name))
        topics = {n: each for n, each in SAMPLE_TOPICS.items() if settings.enables(each.switch)}
        self._samples = {name: add(topic) for name, topic in topics.items()}
        self._layouts = {name: topic.layout(*frames) for name, topic in topics.items()}
        has_frames = bool(settings.imu or settings.odometry)
        self._fixed_frames = add(TF_STATIC) if has_frames else None
        self._diagnostics = add(DIAGNOSTICS)
        self._clock = add(CLOCK) if settings.publish_clock else None
        self._markers = Markers(settings.world_frame)
        self._marker_output = add(MARKERS) if settings.publish_markers else None
        self._torque = recorder.add_channel(host.resolve(APPLIED_TORQUE), APPLIED_TORQUE)
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
            body=find_body(settings.top, settings.gravity),
        )
        self._description.send(stamp, lambda: encode_string(urdf))
        if self._fixed_frames:
            body = settings.odometry and find_body(settings.top, settings.gravity)
            transforms = list_fixed_frames(settings.top_frame, settings.imu, body or None)
            self._fixed_frames.send(stamp, lambda: messages.encode_transforms(stamp, transforms))

    def send_diagnostics(self, stamp: int, collect: Callable[[], list[Status]]) -> None:
        """Publish and log diagnostics if needed; each status bears the name of the node."""
        prefix = self._name.lstrip("/")

        def encode() -> bytes:
            named = [each._replace(name=f"{prefix}: {each.name}") for each in collect()]
            return encode_statuses(stamp, self._frame, named, self._name)

        self._diagnostics.send(stamp, encode)

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""
        return self._recorder.put_first(self._events.channel)


def list_fixed_frames(frame: str, imu: Imu | None, body: Body | None) -> list[Transform]:
    """Return the frames on the body: that of the sensor, and that in the centre of mass."""
    transforms = []
    if imu:
        transforms.append(Transform(frame, imu_frame(frame), imu.position, imu.orientation))
    if body:
        place = (0.0, 0.0, body.arm)
        transforms.append(Transform(frame, centre_frame(frame), place, ALONG))
    return transforms
