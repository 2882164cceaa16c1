"""The peer of `top_report --node`: what a node of rclpy costs that publishes and does nothing else.

The same five messages, made and published as rclpy's tutorials do it, from a timer; and a service
that says in an event when it was called.
"""

from __future__ import annotations

import sys
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

TOPICS = {
    "orientation": QuaternionStamped,
    "angular_velocity": TwistStamped,
    "angular_momentum": Vector3Stamped,
    "torque": WrenchStamped,
    "euler_angles": JointState,
}
LATCHED = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)


class BareNode(Node):
    """Publishes at a rate in Hz."""

    def __init__(self, rate: float) -> None:
        super().__init__("top")
        self._events = self.create_publisher(DiagnosticArray, "~/events", LATCHED)
        self._outputs = {
            name: (kind, self.create_publisher(kind, f"~/{name}", 100))
            for name, kind in TOPICS.items()
        }
        self.create_service(Trigger, "~/hurry_precession", self._kick)
        self.create_timer(1 / rate, self._tick)

    def _tick(self) -> None:
        stamp = self.get_clock().now().to_msg()
        for kind, publisher in self._outputs.values():
            message: Any = kind()
            message.header.stamp = stamp
            message.header.frame_id = "world"
            self._fill(message)
            publisher.publish(message)

    def _fill(self, message: Any) -> None:
        """Numbers as many as in the messages of a top."""
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
    """Publish at the rate that is the argument, until a signal comes."""
    try:
        with rclpy.init():
            rclpy.spin(BareNode(float(sys.argv[1])))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:  # a signal in the middle of a tick
        if rclpy.ok():
            raise


if __name__ == "__main__":
    main()
