"""The demonstration behind `make demo`: a top on cusps, hurried by its service, and its replay."""

import json
import os
import subprocess
import sys
from pathlib import Path

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.distribution import use_profile
from symtop_ros.log.reader import LogError, McapFile
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback import viewer
from symtop_ros.playback.replay import replay

SCENE = "cusps"
PROFILE = "fastdds_loopback.xml"
NODE = "import sys; from symtop_ros.programs import top_node; sys.exit(top_node())"
PATIENCE = 5.0  # s
SAMPLES = 300  # before and after the kick: 1.5 s, nine nutations of this scene


def main() -> int:
    """Run the demonstration; return the exit status."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    # The discovery range alone leaves ports open to hosts that name this one as a peer.
    use_profile(PROFILE)
    # A separate domain, so that the demonstration does not reach a top that is already running.
    os.environ["ROS_DOMAIN_ID"] = str(60 + os.getpid() % 30)
    print(f"starting top_node with the scene {SCENE!r} ...", flush=True)
    options = ["-p", f"scene:={SCENE}", "-p", "record.enabled:=true", "--log-level", "warn"]
    node = subprocess.Popen([sys.executable, "-c", NODE, "--ros-args", *options])
    rclpy.init()
    try:
        log = _show(Connection(rclpy.create_node("demo"), timeout=20.0))
    except UnreachableError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    finally:
        rclpy.try_shutdown()
        node.terminate()
        node.wait(timeout=10)
    return _replay(log)


def _show(top: Connection) -> Path:
    """Hurry the top at a lowest point, and return the log of the run.

    The motion is paused and stepped, so that the kick comes at the same instant of the motion, and
    the same samples follow, in each run.
    """
    thetas: list[float] = []
    logs: list[str] = []
    top.subscribe(DiagnosticArray, "events", lambda message: logs.extend(_list_logs(message)))
    top.subscribe(JointState, "euler_angles", lambda message: thetas.append(message.position[1]))
    top.switch("pause", True)
    top.trigger("reset")
    print(f"let go at rest:       {_watch(top, thetas)}")
    top.trigger("reset")
    state = json.loads(top.trigger("get_state")[1])
    top.set("step", {"duration": state["nutation_period"] / 2})
    print("at its lowest point:  ~/hurry_precession multiplies phi' by 1.4")
    _, answer = top.trigger("hurry_precession")
    print(f"the answer:           {answer}")
    print(f"the motion after it:  {_watch(top, thetas)}")
    top.switch("record", False)
    if not top.spin_until(lambda: bool(logs), PATIENCE):
        raise UnreachableError(f"no event of {top.name} within {PATIENCE:g} s: the log is unknown")
    return Path(logs[-1])


def _list_logs(message: DiagnosticArray) -> list[str]:
    """Return the files of the recordings that ended."""
    fields = [{each.key: each.value for each in status.values} for status in message.status]
    return [each["outcome.path"] for each in fields if each.get("outcome.kind") == "ended"]


def _replay(log: Path) -> int:
    recording = log.with_suffix(".rrd")
    try:
        replay(TopLog(McapFile(log)), recording)
    except LogError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    print(f"the log:              {log}")
    print(f"the replay:           {recording}")
    if viewer.has_screen():
        print("the viewer is open; closing it ends the demonstration", flush=True)
        viewer.show(recording, web=False)
    print("stopped; nothing is left running")
    return 0


def _watch(top: Connection, thetas: list[float]) -> str:
    """Resume the paused motion, pause it after some samples and return the range of the tilt."""
    resting = json.loads(top.trigger("get_state")[1])["euler_angles"]["theta"]
    top.spin_until(lambda: thetas[-1:] == [resting], 5.0)
    thetas.clear()
    top.switch("pause", False)
    top.spin_until(lambda: len(thetas) - thetas.count(resting) >= SAMPLES, 10.0)
    top.switch("pause", True)
    moving = [resting, *(theta for theta in thetas if theta != resting)][: SAMPLES + 1]
    return f"theta {min(moving):.3f} to {max(moving):.3f} rad in {SAMPLES} samples"


if __name__ == "__main__":
    sys.exit(main())
