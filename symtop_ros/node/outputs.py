"""Where messages go: to those who listen, and into the log. The same bytes, made once.

What nobody listens to and is not logged is not computed.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from symtop_ros.recording.recorder import Recorder
from symtop_ros.run.block import Block
from symtop_ros.wire import messages
from symtop_ros.wire.layout import Layout, Stamp

try:  # not on PyPI, where the rest of ROS 2 is
    from tf2_msgs.msg import TFMessage
except ImportError:
    TFMessage = None

DEPTH = 100  # samples a reliable subscriber may lag behind: 0.1 s at 1 kHz
LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
EVENTS = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
STATE_TOPICS: dict[str, tuple[Any, Callable[[str], Layout]]] = {
    "~/orientation": (QuaternionStamped, messages.quaternion),
    "~/angular_velocity": (TwistStamped, messages.twist),
    "~/angular_momentum": (Vector3Stamped, messages.vector),
    "~/torque": (WrenchStamped, messages.twist),
    "~/euler_angles": (JointState, messages.joints),
}
CLOCK = Layout(Stamp())


class Output:
    """One topic, and its channel in the log.

    Parameters
    ----------
    node : Node
    recorder : Recorder
    topic : str
    kind : type or str
        Type of its messages; a name alone where the type is not installed: then it is only logged.
    qos : QoSProfile or int

    Attributes
    ----------
    channel : int
        Its number in the log.
    published : bool
        Whether it is published at all.
    """

    def __init__(
        self,
        node: Node,
        recorder: Recorder,
        topic: str,
        kind: Any,
        qos: QoSProfile | int = DEPTH,
    ) -> None:
        self._publisher = None if isinstance(kind, str) else _publisher(node, topic, kind, qos)
        self._context = node.context
        self._latched = isinstance(qos, QoSProfile)
        self._recorder = recorder
        self.channel = recorder.channel(
            node.resolve_topic_name(topic), _name_of(kind), self._latched
        )
        self.published = True

    @property
    def wanted(self) -> bool:
        """Whether anybody listens, or a log is written."""
        return self._recorder.running or self._heard

    def send(self, stamp: int, data: bytes) -> None:
        """Publish and log a message that is serialised already; its stamp is in ns.

        Where ROS ends in the middle of a sample the log has it complete.
        """
        try:
            if self._publisher and (self._latched or self._heard):
                self._publisher.publish(data)
        except RuntimeError:
            if self._context.ok():
                raise
        self._recorder.add(self.channel, stamp, data)

    def send_message(self, stamp: int, message: Any) -> None:
        """Publish and log a message."""
        self.send(stamp, serialize_message(message))

    @property
    def _heard(self) -> bool:
        return bool(self.published and self._publisher and self._publisher.get_subscription_count())


class Sample(NamedTuple):
    """A topic that every sample has a message on."""

    output: Output
    layout: Layout


class Outputs:
    """All topics of the node.

    Parameters
    ----------
    node : Node
    recorder : Recorder
    world, top : str
        Frames.
    clock : bool
        Whether there is a /clock.
    """

    def __init__(self, node: Node, recorder: Recorder, world: str, top: str, clock: bool) -> None:
        self._recorder = recorder
        make = partial(Output, node, recorder)
        self.events = make("~/events", DiagnosticArray, EVENTS)  # first, hence first in every log
        self.description = make("/robot_description", String, LATCHED)
        layouts = {
            **{name: (kind, layout(world)) for name, (kind, layout) in STATE_TOPICS.items()},
            "/tf": (TFMessage or "tf2_msgs/msg/TFMessage", messages.transform(world, top)),
        }
        self._samples = {
            name.lstrip("~/"): Sample(make(name, kind), layout)
            for name, (kind, layout) in layouts.items()
        }
        self.diagnostics = make("/diagnostics", DiagnosticArray, 10)
        self._clock = make("/clock", Clock) if clock else None
        if not TFMessage:
            node.get_logger().info("tf2_msgs is not installed: /tf is logged, not published")

    def behind_events(self) -> AbstractContextManager[None]:
        """Let what is sent meanwhile come after the events in the log."""
        return self._recorder.behind(self.events.channel)

    def publish_tf(self, wanted: bool) -> None:
        """Publish /tf or not; it is logged in any case."""
        self._samples["tf"].output.published = wanted

    def send_sample(self, stamp: int, block: Block) -> None:
        """Publish and log the sample of a stamp (ns), where anybody wants it."""
        for name, (output, layout) in self._samples.items():
            if output.wanted:
                output.send(stamp, layout.pack(stamp, block.numbers(name, stamp)))
        if self._clock:
            self._clock.send(stamp, CLOCK.pack(stamp, ()))


def _publisher(node: Node, topic: str, kind: Any, qos: QoSProfile | int) -> Publisher[Any]:
    """Return a publisher whose QoS can be overridden by the ROS parameters for that."""
    return node.create_publisher(
        kind,
        topic,
        qos,
        qos_overriding_options=QoSOverridingOptions.with_default_policies(),
    )


def _name_of(kind: Any) -> str:
    return kind if isinstance(kind, str) else f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"
