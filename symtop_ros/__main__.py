"""Versions and settings for the report of a fault: python -m symtop_ros.

Each line is found for itself, so that one that fails says so and the others are there.
"""

import os
import platform
import sys
from collections.abc import Callable
from importlib import import_module, metadata
from pathlib import Path

import symtop_ros
from symtop_ros.programs import BROKEN_PIPE, drop_output

ABSENT = "not installed"
# Variables by which programs of ROS find each other.
SHOWN = ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_DOMAIN_ID", "ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY")
PREFIXES = ("FASTDDS_", "FASTRTPS_", "RMW_", "CYCLONEDDS_", "ROS_SECURITY_")


def main() -> int:
    """Print the lines; return 0."""
    for name, find in LINES.items():
        try:
            text = find()
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
        print(f"{name:<12} {text}")
    return 0


def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ABSENT


def _module_version(name: str, package: str) -> str:
    """Return the version of a package that may come from apt, without metadata of pip."""
    try:
        module = import_module(name)
    except ModuleNotFoundError:
        return ABSENT
    return str(getattr(module, "__version__", _version(package)))


def _kernel() -> str:
    from symtop_ros.physics.kernel.bindings import kernel_version
    from symtop_ros.physics.kernel.library import digest_sources

    return f"{kernel_version()}, sources {digest_sources()[:12]}"


def _ros() -> str:
    try:
        import rclpy
    except ModuleNotFoundError:
        return ABSENT
    from symtop_ros.ros.node.host import distribution_name

    name = distribution_name() or "unknown distribution"
    return f"{name}, rclpy {_version('rclpy')} ({Path(rclpy.__file__).parent})"


def _middleware() -> str:
    try:
        from rclpy.utilities import get_rmw_implementation_identifier
    except ModuleNotFoundError:
        return ABSENT
    return str(get_rmw_implementation_identifier())


def _discovery() -> str:
    names = (name for name in sorted(os.environ) if name in SHOWN or name.startswith(PREFIXES))
    found = [f"{name}={os.environ[name]}" for name in names if os.environ[name]]
    return ", ".join(found) or "defaults (range SUBNET, domain 0)"


LINES: dict[str, Callable[[], str]] = {
    "symtop_ros": lambda: f"{symtop_ros.__version__} ({Path(symtop_ros.__file__).parent})",
    "kernel": _kernel,
    "platform": platform.platform,
    "processor": platform.machine,
    "Python": lambda: f"{platform.python_version()} ({sys.executable})",
    "NumPy": lambda: _module_version("numpy", "numpy"),
    "SciPy": lambda: _module_version("scipy", "scipy"),
    "ROS 2": _ros,
    "middleware": _middleware,
    "discovery": _discovery,
    "mcap": lambda: _module_version("mcap", "mcap"),
    "Rerun": lambda: _version("rerun-sdk"),
}

if __name__ == "__main__":
    try:
        status = main()
        sys.stdout.flush()
    except BrokenPipeError:
        drop_output()
        status = BROKEN_PIPE
    sys.exit(status)
