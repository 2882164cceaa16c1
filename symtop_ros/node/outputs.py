"""The publishers of one sample of the state; a topic nobody listens to is not computed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from symtop_ros.node import messages
from symtop_ros.physics import State, Top

try:  # not on PyPI, where the rest of ROS 2 is
    from tf2_msgs.msg import TFMessage
except ImportError:
    TFMessage = None

DEPTH = 100  # samples a reliable subscriber may lag behind: 0.1 s at 1 kHz
LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
EVENTS = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)

Make = Callable[[Header, Top, State], Any]
SAMPLES: tuple[tuple[str, Any, Make], ...] = (
    ("~/orientation", QuaternionStamped, messages.orientation),
    ("~/angular_velocity", TwistStamped, messages.angular_velocity),
    ("~/angular_momentum", Vector3Stamped, messages.angular_momentum),
    ("~/torque", WrenchStamped, messages.torque),
    ("~/euler_angles", JointState, messages.euler_angles),
)


def publisher(node: Node, kind: Any, topic: str, qos: QoSProfile | int = DEPTH) -> Publisher[Any]:
    """Return a publisher whose QoS can be overridden by the ROS parameters for that.

    Without rclpy's own QoS events: each is waited for anew in every spin, which costs a tenth of a
    core at 1 kHz. A subscriber with another QoS is warned by its own side.
    """
    return node.create_publisher(
        kind,
        topic,
        qos,
        qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        event_callbacks=PublisherEventCallbacks(use_default_callbacks=False),
    )


class Outputs:
    """Publishers of everything that is a function of the state alone."""

    def __init__(self, node: Node, world_frame: str, top_frame: str) -> None:
        self._world_frame = world_frame
        self._makers: list[tuple[Publisher[Any], Make]] = [
            (publisher(node, kind, topic), make) for topic, kind, make in SAMPLES
        ]
        self._tf = publisher(node, TFMessage, "/tf") if TFMessage else None
        if not TFMessage:
            node.get_logger().info("tf2_msgs is not installed: there is no /tf")
        self._top_frame = top_frame

    def publish(self, stamp: int, top: Top, state_at: Callable[[], State], *, tf: bool) -> None:
        """Publish the sample of one stamp (ns) on the topics that are listened to."""
        wanted = [(sink, make) for sink, make in self._makers if sink.get_subscription_count()]
        with_tf = self._tf if tf and self._tf and self._tf.get_subscription_count() else None
        if not wanted and not with_tf:
            return
        header = Header(stamp=messages.time_message(stamp), frame_id=self._world_frame)
        state = state_at()
        for sink, make in wanted:
            sink.publish(make(header, top, state))
        if with_tf:
            transform = messages.transform(header, self._top_frame, state)
            with_tf.publish(TFMessage(transforms=[transform]))


def clock_message(stamp: int) -> Clock:
    """Return the message for /clock."""
    return Clock(clock=messages.time_message(stamp))
