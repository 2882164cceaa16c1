"""The messages of a running top as they are on the wire, for playback to read."""

from __future__ import annotations

from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState

from symtop_ros.playback.batch import EVENTS, Batch, BatchReader

LATCHED = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
DEPTH = 1000  # samples; a second at 1 kHz
TYPES: dict[str, Any] = {
    "orientation": QuaternionStamped,
    "angular_velocity": TwistStamped,
    "angular_momentum": Vector3Stamped,
    "torque": WrenchStamped,
    "euler_angles": JointState,
}


class Feed:
    """Subscriptions to one top; a node that restarts is found again by itself.

    Parameters
    ----------
    node : Node
        A node of the caller's own.
    name : str
        Full name of the top's node, such as /top.
    """

    def __init__(self, node: Node, name: str) -> None:
        self._messages: list[tuple[str, bytes]] = []
        self._event: bytes | None = None  # the latest: a new recording begins with it
        self._reader = BatchReader()
        node.create_subscription(
            DiagnosticArray, f"{name}/{EVENTS}", self._take_event, LATCHED, raw=True
        )
        for topic, kind in TYPES.items():
            take = partial(self._take, topic)
            node.create_subscription(kind, f"{name}/{topic}", take, DEPTH, raw=True)

    def batch(self) -> Batch:
        """Return what has come since the last call."""
        messages, self._messages = self._messages, []
        return self._reader.read(messages)

    def start_again(self) -> None:
        """Begin the next batch with the event that holds."""
        if self._event is not None:
            self._messages.insert(0, (EVENTS, self._event))

    def _take(self, topic: str, data: bytes) -> None:
        self._messages.append((topic, data))

    def _take_event(self, data: bytes) -> None:
        self._event = data
        self._take(EVENTS, data)
