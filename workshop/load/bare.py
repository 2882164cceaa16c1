"""A bare rclpy node with the topics of a top, to compare its cost with.

It makes and publishes the same five messages from a timer, as the rclpy tutorials do, and computes
nothing. With `--prepared` it publishes bytes that it has made once, in which only the stamp
changes. A service publishes an event with the time of the call.
"""

import struct
import sys
from contextlib import suppress
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from symtop_ros.base.shutdown import ros_context

TOPICS = {
    "orientation": QuaternionStamped,
    "angular_velocity": TwistStamped,
    "angular_momentum": Vector3Stamped,
    "torque": WrenchStamped,
    "euler_angles": JointState,
}
STAMP_OFFSET = 4  # bytes, after the header of the encoding
LATCHED = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class BareNode(Node):
    """Publishes at a rate in Hz."""

    def __init__(self, rate: float, is_prepared: bool) -> None:
        super().__init__("top")
        self._events = self.create_publisher(DiagnosticArray, "~/events", LATCHED)
        self._outputs = {
            name: (kind, self.create_publisher(kind, f"~/{name}", 100))
            for name, kind in TOPICS.items()
        }
        self.create_service(Trigger, "~/hurry_precession", self._kick)
        self._prepared = {
            name: bytearray(serialize_message(self._make(kind)))
            for name, (kind, _) in self._outputs.items()
        }
        self.create_timer(1 / rate, self._send_prepared if is_prepared else self._send)

    def _send(self) -> None:
        stamp = self.get_clock().now().to_msg()
        for kind, publisher in self._outputs.values():
            message = self._make(kind)
            message.header.stamp = stamp
            publisher.publish(message)

    def _send_prepared(self) -> None:
        stamp = divmod(self.get_clock().now().nanoseconds, 10**9)
        for name, (_, publisher) in self._outputs.items():
            struct.pack_into("<iI", self._prepared[name], STAMP_OFFSET, *stamp)
            publisher.publish(bytes(self._prepared[name]))

    def _make(self, kind: type) -> Any:
        message: Any = kind()
        message.header.frame_id = "world"
        self._fill(message)
        return message

    def _fill(self, message: Any) -> None:
        """Set as many numbers as a top does."""
        if isinstance(message, QuaternionStamped):
            message.quaternion.x, message.quaternion.y = 0.0, 0.1
            message.quaternion.z, message.quaternion.w = 0.2, 0.3
        elif isinstance(message, JointState):
            message.name = ["precession", "tilt", "spin"]
            message.position = [0.1, 0.2, 0.3]
            message.velocity = [0.1, 0.2, 0.3]
        else:
            vector = _vector_of(message)
            vector.x, vector.y, vector.z = 0.1, 0.2, 0.3

    def _kick(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        event = DiagnosticArray()
        event.header.stamp = self.get_clock().now().to_msg()
        self._events.publish(event)
        response.success = True
        return response


def _vector_of(message: Any) -> Any:
    if isinstance(message, TwistStamped):
        return message.twist.angular
    return message.wrench.torque if isinstance(message, WrenchStamped) else message.vector


def main() -> None:
    """Publish at the rate that is given as first argument (Hz) until a signal comes."""
    with suppress(KeyboardInterrupt, ExternalShutdownException), ros_context(sys.argv) as listen:
        node = BareNode(float(sys.argv[1]), "--prepared" in sys.argv)
        listen()
        rclpy.spin(node)


if __name__ == "__main__":
    main()
