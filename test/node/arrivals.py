"""Write the times at which the samples of a top arrive, in a process that nothing delays."""

from __future__ import annotations

import sys
import time

import rclpy
from geometry_msgs.msg import QuaternionStamped
from rclpy.executors import ExternalShutdownException


def main() -> None:
    """Write nanoseconds of the monotonic clock, one in a line, until a signal."""
    rclpy.init()
    node = rclpy.create_node("arrivals")
    node.create_subscription(
        QuaternionStamped,
        "/top/orientation",
        lambda _: print(time.monotonic_ns(), flush=True),
        1000,
        raw=True,
    )
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        sys.stdout.close()


if __name__ == "__main__":
    main()
