"""What a log says of itself: version, scene, parameters, the host's clock and the middleware."""

from __future__ import annotations

import os
from collections.abc import Mapping
from datetime import datetime, timezone
from typing import Any

from rclpy.utilities import get_rmw_implementation_identifier

from symtop_ros import __version__


def metadata(scene: str, parameters: Mapping[str, Any], stamp: int) -> dict[str, str]:
    """Return the metadata record; `stamp` is the node's clock in ns, beside the host's."""
    return {
        "version": __version__,
        "scene": scene,
        **{f"parameter.{name}": str(value) for name, value in parameters.items()},
        "clock.host": datetime.now(timezone.utc).isoformat(),
        "clock.node": str(stamp),
        "rmw": get_rmw_implementation_identifier(),
        "ros_distro": os.environ.get("ROS_DISTRO", ""),
    }
