"""Markers for rviz: three vectors as arrows, and the trace of the axis.

They are drawn from the samples, when somebody subscribes, and are not logged.
"""

from collections import deque
from collections.abc import Sequence
from math import hypot
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from rclpy.node import Node

from symtop_ros.models.urdf import LENGTH
from symtop_ros.simulation.block import Block
from symtop_ros.wire.layout import NANOSECONDS

try:
    from visualization_msgs.msg import Marker, MarkerArray
except ModuleNotFoundError:
    Marker = MarkerArray = None

PERIOD = NANOSECONDS // 30  # ns between two sets of markers
TRACE_LENGTH = 150  # points of the trace: 5 s
# By topic: colour, and length of the arrow for the largest vector so far, in lengths of the top.
ARROWS = {
    "angular_velocity": ((0.2, 0.55, 0.95), 1.4),
    "angular_momentum": ((0.95, 0.6, 0.1), 1.2),
    "torque": ((0.85, 0.2, 0.25), 0.7),
}
TRACE_COLOR = (0.95, 0.95, 0.95)
WIDTH = 0.02  # of shafts and of the trace, in lengths of the top
MISSING = (
    "visualization_msgs is not installed: ~/markers is not published "
    "(ros-DISTRO-visualization-msgs, from apt or PyPI)"
)


class Markers:
    """The topic `~/markers`."""

    def __init__(self, node: Node, frame: str) -> None:
        self._frame = frame
        self._largest = dict.fromkeys(ARROWS, 0.0)
        self._trace: deque[Point] = deque(maxlen=TRACE_LENGTH)
        self._next = 0
        self._publisher: Any = None
        if MarkerArray is None:
            node.get_logger().warning(MISSING)
        else:
            self._publisher = node.create_publisher(MarkerArray, "~/markers", 10)

    def send(self, stamp: int, block: Block) -> None:
        """Publish the markers of a sample (stamp in ns) if they are due and have a subscriber."""
        early = self._next - PERIOD <= stamp < self._next  # a clock may also jump back
        if early or not self._publisher or not self._publisher.get_subscription_count():
            return
        self._next = (stamp // PERIOD + 1) * PERIOD  # on a grid: the rate is 30 Hz for any other
        time = Time(sec=stamp // NANOSECONDS, nanosec=stamp % NANOSECONDS)
        self._trace.append(_axis_end(block.numbers("orientation", stamp)))
        markers = [self._line(time)]
        for name in ARROWS:
            # the last three: messages with six numbers have zeros before the vector
            vector = block.numbers(name, stamp)[-3:]
            markers.append(self._arrow(name, vector, time))
        self._publisher.publish(MarkerArray(markers=markers))

    def _arrow(self, name: str, vector: Sequence[float], time: Time) -> Any:
        (color, length), size = ARROWS[name], hypot(*vector)
        self._largest[name] = max(self._largest[name], size)
        scale = LENGTH * length / self._largest[name] if size else 0.0
        arrow = self._marker(name, Marker.ARROW, color, time)
        x, y, z = (scale * each for each in vector)
        arrow.points = [Point(), Point(x=x, y=y, z=z)]
        arrow.scale.x, arrow.scale.y = WIDTH * LENGTH, 2.5 * WIDTH * LENGTH  # shaft, head
        return arrow

    def _line(self, time: Time) -> Any:
        line = self._marker("trace", Marker.LINE_STRIP, TRACE_COLOR, time)
        line.points, line.scale.x = list(self._trace), 0.5 * WIDTH * LENGTH
        return line

    def _marker(self, name: str, kind: int, color: Sequence[float], time: Time) -> Any:
        marker = Marker(ns=name, type=kind, action=Marker.ADD)
        marker.header.frame_id, marker.header.stamp = self._frame, time
        marker.pose.orientation.w = 1.0
        marker.color.r, marker.color.g, marker.color.b = color
        marker.color.a = 1.0
        return marker


def _axis_end(quaternion: Sequence[float]) -> Point:
    """Return the upper end of the axis for an orientation x, y, z, w."""
    x, y, z, w = quaternion
    up = 1.0 - 2.0 * (x * x + y * y)
    return Point(x=2 * LENGTH * (x * z + w * y), y=2 * LENGTH * (y * z - w * x), z=LENGTH * up)
