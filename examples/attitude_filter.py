"""An attitude filter as a node: imu/data_raw and imu/mag in, imu/data out (REP-145).

`pip install ahrs` first. Its topics have the names that imu_tools uses. Its two methods are those
of imu_tools, too: Madgwick's (imu_filter_madgwick), and Valenti's (imu_complementary_filter), which
ahrs calls AQUA. Their world, x to the north, is turned into that of REP-103, x to the east.
"""

import sys
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import rclpy
from ahrs.common.orientation import ecompass
from ahrs.filters import AQUA, Madgwick
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Imu, MagneticField

from symtop_ros.base.arrays import Real, compose, invert

NORTH_TO_EAST = np.sqrt([0.5, 0.0, 0.0, 0.5])  # a quarter of a turn about the vertical
NANOTESLA = 1e9  # per T
DEPTH = 1000


def keep(q: Real) -> Real:
    """Return the quaternion of a filter that turns the sensor's vectors into the world."""
    return q


# By the name of a filter: its class, and what makes its quaternion turn the sensor into the world.
FILTERS: Mapping[str, tuple[Any, Callable[[Real], Real]]] = {
    "Madgwick": (Madgwick, keep),
    "AQUA": (AQUA, invert),
}


class AttitudeFilter(Node):
    """Filters the messages of a sensor and its magnetometer that have the same stamp."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__("attitude_filter", **options)
        kind, self._turn = FILTERS[name]
        self._filter = kind()
        self._q: Real | None = None  # as the filter has it
        self._last = 0  # ns
        self._waiting: dict[int, Any] = {}  # messages without a partner, by their stamps
        self._publisher = self.create_publisher(Imu, "imu/data", DEPTH)
        for topic, message in (("imu/data_raw", Imu), ("imu/mag", MagneticField)):
            self.create_subscription(message, topic, self._receive, DEPTH)

    def _receive(self, message: Imu | MagneticField) -> None:
        stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        other = self._waiting.pop(stamp, None)
        if other is None:
            self._waiting[stamp] = message
            return
        imu, magnetic = (message, other) if isinstance(message, Imu) else (other, message)
        self._q = q = self._update(stamp, imu, _vector(magnetic.magnetic_field) * NANOTESLA)
        imu.orientation.w, imu.orientation.x, imu.orientation.y, imu.orientation.z = (
            float(each) for each in compose(NORTH_TO_EAST, self._turn(q))
        )
        self._publisher.publish(imu)

    def _update(self, stamp: int, imu: Imu, field: Real) -> Real:
        force = _vector(imu.linear_acceleration)
        seconds = (stamp - self._last) * 1e-9
        self._last = stamp
        if self._q is None:
            compass = ecompass(force, field, frame="NED", representation="quaternion")
            return self._turn(np.asarray(compass, dtype=float))
        rates = _vector(imu.angular_velocity)
        found: Real = self._filter.updateMARG(self._q, rates, force, field, dt=seconds)
        return found


def _vector(message: Any) -> Real:
    return np.array([message.x, message.y, message.z])


def main() -> None:
    """Filter until a signal comes; the argument is the name of the filter."""
    try:
        rclpy.init(args=sys.argv)
        rclpy.spin(AttitudeFilter(sys.argv[1]))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
