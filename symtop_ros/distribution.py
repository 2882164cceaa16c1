"""The ROS 2 distribution: its name, and what differs between distributions."""

import os
from importlib import metadata

from symtop_ros.simulation.presets import config_folder

# By the major version of rclpy. ROS 2 from PyPI does not set ROS_DISTRO.
NAMES = {"3": "humble", "7": "jazzy", "9": "kilted"}
# The variables that name a file of profiles for Fast DDS: the second up to Jazzy.
VARIABLES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")


def distribution_name() -> str:
    """Return the name of the installed distribution; empty if it is not known."""
    return os.environ.get("ROS_DISTRO") or NAMES.get(_rclpy_major(), "")


def use_profile(name: str) -> None:
    """Let Fast DDS use a profile of config/ in this process and its children.

    Does nothing if the user has chosen a profile. Other middleware ignores it. Call it before ROS
    is initialised.
    """
    path = config_folder() / name
    if path.is_file() and not any(os.environ.get(variable) for variable in VARIABLES):
        os.environ[VARIABLES[_rclpy_major() in ("3", "7")]] = str(path)


def _rclpy_major() -> str:
    try:
        return metadata.version("rclpy").partition(".")[0]
    except metadata.PackageNotFoundError:
        return ""
