"""The policy for SROS2 allows what the programs use of ROS, and nothing else."""

import contextlib
import socket
import subprocess

from node.listener import Listener
from node.running_top import RunningTop
from programs import command, environment
from rclpy.node import NodeNameNonExistentError
from security.policy import Uses, allowed, used

from symtop_ros.node.outputs import TFMessage
from symtop_ros.playback import viewer

DOMAIN = 95
COMMANDS = {
    "start": ("start", "theta=0.5"),
    "kick": ("kick", "precession_rate=9"),
    "step": ("step", "duration=0.01"),
    "hurry": ("hurry",),
    "reset": ("reset",),
    "pause": ("pause",),
    "resume": ("resume",),
    "record": ("record", "on"),
    "state": ("state",),
    "watch": ("watch",),
}


@contextlib.contextmanager
def processes(*commands):
    """Run programs; they are killed at the end."""
    with contextlib.ExitStack() as stack:
        for words in commands:
            process = subprocess.Popen(
                words,
                env=environment(DOMAIN),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            stack.callback(process.wait)
            stack.callback(process.kill)
        yield


def watched(names, as_name, until):
    """What nodes use together, as soon as it is all that is expected, or after a time-out."""
    seen = Uses()

    def all_seen():
        nonlocal seen
        for name in names:
            with contextlib.suppress(NodeNameNonExistentError):
                seen |= used(listener.node, name, as_name)
        return seen == until

    with Listener(DOMAIN) as listener, contextlib.suppress(AssertionError):
        listener.spin_until(all_seen)
    return seen


def test_the_policy_allows_top_node_what_it_uses():
    seen = Uses(publish=frozenset({"/tf"}) if TFMessage is None else frozenset())
    for parameters in ({"publish_clock": True}, {"use_sim_time": True}):
        run = RunningTop(**parameters)
        try:
            seen |= used(run.user, "top")
        finally:
            run.close()
    assert seen == allowed()["/top/top_node"]


def test_the_policy_allows_top_ctl_what_its_commands_use():
    words = [
        command("top_ctl", "--timeout", "30", *each, "--ros-args", "-r", f"__node:=ctl_{name}")
        for name, each in COMMANDS.items()
    ]
    expected = allowed()["/top/top_ctl"]
    with processes(*words):
        assert watched([f"ctl_{name}" for name in COMMANDS], "top_ctl", expected) == expected


def test_the_policy_allows_top_live_what_it_uses():
    expected = allowed()["/top/top_live"]
    with socket.create_server((viewer.HOST, 0)) as taken_for_a_viewer:
        port = taken_for_a_viewer.getsockname()[1]
        with processes(command("top_live", "--port", str(port))):
            assert watched(["top_live"], "top_live", expected) == expected


def test_only_top_ctl_may_ask_the_top_for_anything():
    policy = allowed()
    assert {path for path, uses in policy.items() if uses.request} == {"/top/top_ctl"}
    torque = "/top/applied_torque"
    assert not any(torque in uses.publish for uses in policy.values())
