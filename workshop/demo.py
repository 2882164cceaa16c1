"""The demonstration behind `make demo`: a top on cusps, hurried by its service, and its replay."""

import json
import os
import secrets
import shlex
import signal
import socket
import subprocess
import sys
from contextlib import closing, suppress
from functools import partial
from pathlib import Path

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import ExternalShutdownException
from sensor_msgs.msg import JointState

from symtop_ros.base.command import has_screen
from symtop_ros.base.shutdown import describe_failure, ros_context
from symtop_ros.programs import INTERRUPTED
from symtop_ros.replay import viewer
from symtop_ros.replay.viewer import replay
from symtop_ros.ros.client.connection import Connection, UnreachableError
from symtop_ros.ros.node.host import use_profile
from symtop_ros.run.log.reader import LogError, McapFile
from symtop_ros.run.log.top_log import TopLog

SCENE = "cusps"
PROFILE = "fastdds_loopback.xml"
NODE = "import sys; from symtop_ros.programs import top_node; sys.exit(top_node())"
SAMPLES = 300  # before and after the kick: 1.5 s, nine nutations of this scene
DOMAINS = range(60, 90)
FIRST_PORT, PORTS = 7400, 250  # of domain 0, and of each domain
USED = 60  # ports of a domain that 25 participants use
LOCAL_HOST = "127.0.0.1"
TIMEOUT = 60.0  # s; on a busy machine each step may take long


_say = partial(print, flush=True)  # at once, also into a pipe: it takes some seconds


class DemoError(Exception):
    """The demonstration failed; the text says why."""


def main() -> int:
    """Run the demonstration; return the exit status."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_LOG_DIR", str(Path("logs", "ros").absolute()))  # not in the home
    # The discovery range alone leaves ports open to hosts that name this one as a peer.
    use_profile(PROFILE)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that the node is ended too
    try:
        # A separate domain, so that the demonstration does not reach a top that is already running.
        domain, claim = claim_domain()
        os.environ["ROS_DOMAIN_ID"] = str(domain)
        with claim:
            log = _run(domain)
        return _replay(log)
    except (DemoError, UnreachableError, LogError) as error:
        print(f"demo: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        return INTERRUPTED


def claim_domain() -> tuple[int, socket.socket]:
    """Return a ROS domain without any program on this machine, and the socket that claims it.

    Until the socket is closed no other demonstration takes the domain: each binds a TCP port of
    it, and Fast DDS uses UDP ports only.
    """
    for domain in DOMAINS:
        claim = socket.socket()
        with suppress(OSError):
            claim.bind((LOCAL_HOST, FIRST_PORT + PORTS * domain))
            _bind_all(domain)
            return domain, claim
        claim.close()
    span = f"{DOMAINS[0]} to {DOMAINS[-1]}"
    raise DemoError(f"one of the ROS domains {span} must be free, got none on this machine")


def _bind_all(domain: int) -> None:
    """Raise OSError if a ROS program of this machine uses the domain."""
    for port in range(FIRST_PORT + PORTS * domain, FIRST_PORT + PORTS * domain + USED):
        with socket.socket(type=socket.SOCK_DGRAM) as probe:
            probe.bind(("", port))


def _run(domain: int) -> Path:
    """Start a node, show it and end it; return the log.

    Its namespace is a random one, so that no other node can answer in its place.
    """
    space = f"/demo_{secrets.token_hex(4)}"
    _say(f"starting top_node with the scene {SCENE!r} in the ROS domain {domain} ...")
    options = [
        "-p",
        f"scene:={SCENE}",
        "-p",
        "record.enabled:=true",
        "-p",
        "start_paused:=true",
        "-r",
        f"__ns:={space}",
    ]
    command = [sys.executable, "-c", NODE, "--ros-args", *options, "--log-level", "warn"]
    node = None
    try:
        with ros_context(["demo"]) as listen:
            node = subprocess.Popen(command)
            with closing(Connection(rclpy.create_node("demo"), f"{space}/top", TIMEOUT)) as top:
                listen()
                names = top.node.get_fully_qualified_node_names
                top.spin_until(lambda: node.poll() is not None or top.name in names(), TIMEOUT)
                if node.poll() is not None:
                    raise DemoError(f"top_node ended with status {node.returncode}")
                return _show(top)
    except RuntimeError as error:
        raise DemoError(describe_failure(error)) from None
    finally:
        if node:
            node.terminate()
            node.wait(timeout=TIMEOUT)


def _show(top: Connection) -> Path:
    """Hurry the top at a lowest point, and return the log of the run.

    The motion is paused and stepped, so that the kick comes at the same instant of the motion, and
    the same samples follow, in each run.
    """
    thetas: list[float] = []
    logs: list[str] = []
    top.subscribe(DiagnosticArray, "events", lambda message: logs.extend(_list_logs(message)))
    top.subscribe(JointState, "euler_angles", lambda message: thetas.append(message.position[1]))
    _say(f"let go at rest:       {_watch(top, thetas)}")
    top.request("reset")
    state = json.loads(top.request("get_state")[1])
    top.request("step", {"duration": state["nutation_period"] / 2})
    _say("at its lowest point:  ~/hurry_precession multiplies phi' by 1.4")
    _, answer = top.request("hurry_precession")
    _say(f"the answer:           {answer}")
    _say(f"the motion after it:  {_watch(top, thetas)}")
    return _end_log(top, logs)


def _end_log(top: Connection, logs: list[str]) -> Path:
    """End the recording and return its path; DemoError if the disk is full, for example."""
    _, answer = top.request("record", False)
    if not top.spin_until(lambda: bool(logs), TIMEOUT):
        raise DemoError(f"the log must be complete, got: {answer} (top_node has reported why)")
    return Path(logs[-1])


def _list_logs(message: DiagnosticArray) -> list[str]:
    """Return the files of the recordings that were ended by request."""
    fields = [{each.key: each.value for each in status.values} for status in message.status]
    return [each["outcome.path"] for each in fields if each.get("outcome.kind") == "ended"]


def _replay(log: Path) -> int:
    """Write the replay, say how to open it and the log, and show it on a screen."""
    recording = log.with_suffix(".rrd")
    replay(TopLog(McapFile(log)), recording)
    _say(f"the log:              {log}")
    _say(f"the replay:           {recording}")
    _say(f"to open the log:      {_command('top_replay', log)}")
    _say(f"  without a screen:   {_command('top_replay', log, '--web')}")
    _say(f"to check it:          {_command('top_replay', log, '--check')}")
    if has_screen():
        _say("the viewer is open; closing it ends the demonstration")
        viewer.show(recording, web=False)
    _say("stopped; nothing is left running")
    return 0


def _command(program: str, file: Path, *options: str) -> str:
    """Return the command line of an installed program, as it can be typed here."""
    path = Path(sys.executable).with_name(program)
    return shlex.join([os.path.relpath(path), os.path.relpath(file), *options])


def _watch(top: Connection, thetas: list[float]) -> str:
    """Resume the paused motion, pause it after some samples and return the range of the tilt."""
    resting = json.loads(top.request("get_state")[1])["euler_angles"]["theta"]
    top.spin_until(lambda: thetas[-1:] == [resting], TIMEOUT)
    thetas.clear()
    top.request("pause", False)
    top.spin_until(lambda: len(thetas) - thetas.count(resting) >= SAMPLES, TIMEOUT)
    top.request("pause", True)
    moving = [resting, *(theta for theta in thetas if theta != resting)][: SAMPLES + 1]
    return f"theta {min(moving):.3f} to {max(moving):.3f} rad in {SAMPLES} samples"


if __name__ == "__main__":
    sys.exit(main())
