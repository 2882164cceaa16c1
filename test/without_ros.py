"""Pytest plugin: the tests run as on a machine without ROS and Rerun.

pytest -p without_ros test/run/simulation test/run/log test/page/panel
"""

import sys
from pathlib import Path

BLOCKED = (
    "rclpy",
    "rcl_interfaces",
    "rosgraph_msgs",
    "rosidl_parser",
    "builtin_interfaces",
    "std_msgs",
    "std_srvs",
    "geometry_msgs",
    "sensor_msgs",
    "diagnostic_msgs",
    "tf2_msgs",
    "rerun",
    "rerun_cli",
    "rerun_sdk",
)
# They compare with ROS itself.
WITH_ROS = ("test_definitions.py", "test_bridge.py")

for name in BLOCKED:
    sys.modules[name] = None  # an import of it raises ModuleNotFoundError


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    return True if collection_path.name in WITH_ROS else None
