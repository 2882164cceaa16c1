"""The demonstration behind `make demo`: a top on cusps, and a hurried precession."""

from __future__ import annotations

import os
import subprocess
import sys

import rclpy
from sensor_msgs.msg import JointState

from symtop_ros.client.connection import Connection, UnreachableError

SCENE = "cusps"
NODE = "import sys; from symtop_ros.node.main import main; sys.exit(main())"
WATCHED = 1.5  # s before and after the kick: nine nutations of this scene


def main() -> int:
    """Run the demonstration; return the exit status."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ["ROS_DOMAIN_ID"] = str(100 + os.getpid() % 100)  # apart from tops that run already
    print(f"starting top_node on the scene {SCENE!r} ...", flush=True)
    options = ["-p", f"scene:={SCENE}", "--log-level", "warn"]
    node = subprocess.Popen([sys.executable, "-c", NODE, "--ros-args", *options])
    try:
        with rclpy.init():
            return _show(Connection(rclpy.create_node("demo"), timeout=20.0))
    except UnreachableError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    finally:
        node.terminate()
        node.wait(timeout=10)


def _show(top: Connection) -> int:
    thetas: list[float] = []
    top.trigger("reset")
    top.follow(JointState, "euler_angles", lambda message: thetas.append(message.position[1]))
    top.spin_until(lambda: bool(thetas), 5.0)
    print(f"let go at rest:    {_range(top, thetas)}")
    print("asked, as it turns at the bottom: ~/hurry_precession (phi' times 1.4)")
    top.spin_until(lambda: thetas[-1] > max(thetas) - 1e-3, 1.0)
    granted, verdict = top.trigger("hurry_precession")
    print(f"the verdict said:  {verdict}")
    print(f"the top then went: {_range(top, thetas)}")
    print("stopped; nothing is left running")
    return 0 if granted else 1


def _range(top: Connection, thetas: list[float]) -> str:
    """Watch the tilt for a while."""
    thetas.clear()
    top.spin_until(lambda: False, WATCHED)
    return f"theta {min(thetas):.3f} .. {max(thetas):.3f} rad in {len(thetas)} samples"


if __name__ == "__main__":
    sys.exit(main())
