"""The demonstration behind `make demo`: a top on cusps, a hurried precession, and its replay."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import rclpy
from sensor_msgs.msg import JointState

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.node.scene import scene_folder
from symtop_ros.playback import viewer
from symtop_ros.playback.mcap_file import LogError, McapFile
from symtop_ros.playback.replay import replay
from symtop_ros.playback.top_log import TopLog
from symtop_ros.report.processes import NODE, domain

SCENE = "cusps"
PROFILE = "fastdds_loopback.xml"
WATCHED = 1.5  # s before and after the kick: nine nutations of this scene


def main() -> int:
    """Run the demonstration; return the exit status."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    # which alone leaves ports open to hosts that name this one as a peer
    os.environ.setdefault("FASTDDS_DEFAULT_PROFILES_FILE", str(scene_folder() / PROFILE))
    os.environ["ROS_DOMAIN_ID"] = str(domain())
    print(f"starting top_node on the scene {SCENE!r} ...", flush=True)
    options = ["-p", f"scene:={SCENE}", "-p", "record.enabled:=true", "--log-level", "warn"]
    node = subprocess.Popen([sys.executable, "-c", NODE, "--ros-args", *options])
    try:
        with rclpy.init():
            log = _show(Connection(rclpy.create_node("demo"), timeout=20.0))
    except UnreachableError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    finally:
        node.terminate()
        node.wait(timeout=10)
    return _replay(log)


def _show(top: Connection) -> Path:
    """Hurry the top, and return the log of it."""
    thetas: list[float] = []
    top.trigger("reset")
    top.follow(JointState, "euler_angles", lambda message: thetas.append(message.position[1]))
    top.spin_until(lambda: bool(thetas), 5.0)
    print(f"let go at rest:    {_range(top, thetas)}")
    print("asked, as it turns at the bottom: ~/hurry_precession (phi' times 1.4)")
    top.spin_until(lambda: thetas[-1] > max(thetas) - 1e-3, 1.0)
    _, verdict = top.trigger("hurry_precession")
    print(f"the verdict said:  {verdict}")
    print(f"the top then went: {_range(top, thetas)}")
    _, answer = top.switch("record", False)
    return Path(answer.removeprefix("recorded to "))


def _replay(log: Path) -> int:
    recording = log.with_suffix(".rrd")
    try:
        replay(TopLog(McapFile(log)), recording)
    except LogError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    print(f"the log:           {log}")
    print(f"the replay:        {recording}")
    if viewer.has_screen():
        print("the viewer is open; closing it ends the demonstration", flush=True)
        viewer.show(recording, web=False)
    print("stopped; nothing is left running")
    return 0


def _range(top: Connection, thetas: list[float]) -> str:
    """Watch the tilt for a while."""
    thetas.clear()
    top.spin_until(lambda: False, WATCHED)
    return f"theta {min(thetas):.3f} .. {max(thetas):.3f} rad in {len(thetas)} samples"


if __name__ == "__main__":
    sys.exit(main())
