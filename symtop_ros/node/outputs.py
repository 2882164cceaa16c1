"""Publishers, and the channels of the log: both get the same bytes, which are encoded once.

A topic without a subscriber is not computed unless it is logged.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions

from symtop_ros.log.recorder import Recorder
from symtop_ros.node.markers import Markers
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.topics import (
    CLOCK,
    DESCRIPTION,
    DIAGNOSTICS,
    EVENTS,
    SAMPLE_TOPICS,
    TF_STATIC,
    Topic,
)
from symtop_ros.wire import messages
from symtop_ros.wire.cdr import encode_string
from symtop_ros.wire.diagnostics import Status, encode_statuses
from symtop_ros.wire.messages import Transform


class Output:
    """One topic: its publisher and its channel in the log."""

    def __init__(self, node: Node, recorder: Recorder, topic: Topic) -> None:
        message_class = topic.load_message_class()
        # false if its message type is not installed: then it is only logged
        self.is_installed = message_class is not None
        self._publisher = _create_publisher(node, topic, message_class) if message_class else None
        self._context = node.context
        self._latched = topic.latched
        self._recorder = recorder
        # index of its channel in the log
        self.channel = recorder.add_channel(node.resolve_topic_name(topic.ros_name), topic)
        self.enabled = True  # set to False to log the topic without publishing it

    @property
    def is_needed(self) -> bool:
        """True if there is a subscriber or a recording."""
        return self._recorder.running or self._has_subscriber

    def send(self, stamp: int, data: bytes) -> None:
        """Publish and log an encoded message with its stamp (ns).

        If ROS shuts down in the middle of a sample, the log still gets the whole sample.
        """
        try:
            if self._publisher and (self._latched or self._has_subscriber):
                self._publisher.publish(data)
        except RuntimeError:
            if self._context.ok():
                raise
        self._recorder.add(self.channel, stamp, data)

    @property
    def _has_subscriber(self) -> bool:
        return bool(self.enabled and self._publisher and self._publisher.get_subscription_count())


class Outputs:
    """All topics of the node; the sink of its simulation."""

    def __init__(self, node: Node, recorder: Recorder, settings: Settings) -> None:
        self._node, self._recorder = node, recorder
        self._frame = settings.world_frame
        frames = settings.world_frame, settings.top_frame
        self._events = Output(node, recorder, EVENTS)
        self._description = Output(node, recorder, DESCRIPTION)
        self._samples = {
            name: (Output(node, recorder, topic), topic.layout(*frames))
            for name, topic in SAMPLE_TOPICS.items()
            if settings.enables(topic.switch)
        }
        has_frames = bool(settings.imu or settings.odometry)
        self._fixed_frames = Output(node, recorder, TF_STATIC) if has_frames else None
        self._diagnostics = Output(node, recorder, DIAGNOSTICS)
        self._clock = Output(node, recorder, CLOCK) if settings.publish_clock else None
        self._markers = Markers(node, self._frame) if settings.publish_markers else None
        self.enable_tf(settings.publish_tf)
        if not self._samples["tf"][0].is_installed:
            node.get_logger().info("tf2_msgs is not installed: /tf is logged, not published")

    @property
    def is_open(self) -> bool:
        """False when ROS is shutting down."""
        return self._node.context.ok()

    @property
    def publishes_tf(self) -> bool:
        """True if /tf is published."""
        tf = self._samples["tf"][0]
        return tf.enabled and tf.is_installed

    def enable_tf(self, enabled: bool) -> None:
        """Publish /tf or not; it is always logged."""
        self._samples["tf"][0].enabled = enabled

    def send_sample(self, stamp: int, block: Block) -> None:
        """Publish and log the sample of a stamp (ns) on the topics that are needed."""
        for name, (output, layout) in self._samples.items():
            if output.is_needed:
                output.send(stamp, layout.encode(stamp, block.numbers(name, stamp)))
        if self._clock:
            self._clock.send(stamp, messages.CLOCK.encode(stamp, ()))
        if self._markers:
            self._markers.send(stamp, block)

    def send_event(self, event: Event) -> None:
        """Publish and log an event."""
        self._events.send(event.stamp, event.encode(self._frame))

    def send_description(self, stamp: int, urdf: str) -> None:
        """Publish and log the URDF of the top."""
        self._description.send(stamp, encode_string(urdf))

    def send_fixed_frames(self, stamp: int, transforms: Sequence[Transform]) -> None:
        """Publish and log the frames on the body."""
        if self._fixed_frames:
            self._fixed_frames.send(stamp, messages.encode_transforms(stamp, transforms))

    @property
    def need_diagnostics(self) -> bool:
        """True if diagnostics have a subscriber or are logged."""
        return self._diagnostics.is_needed

    def send_diagnostics(self, stamp: int, statuses: list[Status]) -> None:
        """Publish and log diagnostics."""
        self._diagnostics.send(stamp, encode_statuses(stamp, self._frame, statuses))

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""
        return self._recorder.put_first(self._events.channel)

    def warn(self, text: str) -> None:
        """Log a warning."""
        self._node.get_logger().warning(text)

    def report_error(self, text: str) -> None:
        """Log an error."""
        self._node.get_logger().error(text)


def _create_publisher(node: Node, topic: Topic, message_class: Any) -> Publisher:
    """Return a publisher with the QoS of the topic, which ROS parameters may override."""
    latched, volatile = QoSDurabilityPolicy.TRANSIENT_LOCAL, QoSDurabilityPolicy.VOLATILE
    qos = QoSProfile(depth=topic.depth, durability=latched if topic.latched else volatile)
    overriding = QoSOverridingOptions.with_default_policies()
    return node.create_publisher(
        message_class, topic.ros_name, qos, qos_overriding_options=overriding
    )
