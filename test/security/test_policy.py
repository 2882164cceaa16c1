"""The policy for SROS2 allows what the programs use of ROS, and nothing else."""

import contextlib
import re
import socket
import subprocess
import urllib.request

import pytest
from programs import PATIENT, command, judge_live, running, running_node
from rclpy.node import NodeNameNonExistentError
from ros.node.listener import Listener
from ros.node.running_top import RunningTop
from security.policy import allowed, used
from waiting import TIMEOUT

from symtop_ros.replay import viewer
from symtop_ros.run.session.services import SERVICES
from symtop_ros.run.simulation.topics import STATE_TOPICS
from workshop.load.domains import claim_domain

pytestmark = pytest.mark.untraced
DOMAIN = claim_domain()
GIVEN = {"start": ["theta=0.5"], "kick": ["precession_rate=9"], "step": ["duration=0.01"]}
GIVEN |= {"record": ["on"], "clamp": ["on"]}
NAMES = (*(each.command for each in SERVICES.values()), "watch")
COMMANDS = {name: (name, *GIVEN.get(name, ())) for name in NAMES}


@contextlib.contextmanager
def processes(*commands):
    """Run programs; they are killed at the end."""
    with contextlib.ExitStack() as stack:
        for words in commands:
            silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            stack.enter_context(running(words, DOMAIN, **silent))
        yield


def assert_allowed(program, *names):
    """Assert that the nodes of these names, or of the program's, use what it is allowed to."""
    seen = set()
    expected = allowed()[f"/top/{program}"]

    def all_seen():
        nonlocal seen
        for name in names or [program]:
            with contextlib.suppress(NodeNameNonExistentError):
                seen |= used(listener.node, name, program)
        return seen == expected

    with Listener(DOMAIN) as listener, contextlib.suppress(AssertionError):
        listener.spin_until(all_seen)
    assert seen == expected


def test_the_policy_allows_top_node_what_it_uses():
    seen = set()
    if STATE_TOPICS["tf"].load_message_class() is None:
        seen = {("publish", "/tf"), ("publish", "/tf_static")}
    switches = ("imu__enabled", "magnetic_field__enabled", "odometry__enabled")
    sensors = dict.fromkeys(switches, True)
    shown = {"publish_clock": True, "publish_markers": True, **sensors}
    for parameters in (shown, {"use_sim_time": True}):
        with RunningTop(realtime=True, **parameters) as run:
            seen |= used(run.user, "top")
    assert seen == allowed()["/top/top_node"]


@pytest.mark.slow
def test_the_policy_allows_top_ctl_what_its_commands_use():
    words = [
        command("top_ctl", *PATIENT, *each, "--ros-args", "-r", f"__node:=ctl_{name}")
        for name, each in COMMANDS.items()
    ]
    with processes(*words):
        assert_allowed("top_ctl", *(f"ctl_{name}" for name in COMMANDS))


@pytest.mark.slow
def test_the_policy_allows_top_live_what_it_uses():
    with socket.create_server((viewer.HOST, 0)) as taken_for_a_viewer:
        port = taken_for_a_viewer.getsockname()[1]
        with processes(command("top_live", "--port", str(port))):
            assert_allowed("top_live")


@pytest.mark.slow
def test_the_policy_allows_top_judge_what_it_uses():
    words = judge_live("--topic", "/top/imu")
    with running_node(DOMAIN, "imu.enabled:=true"), processes(words):
        assert_allowed("top_judge")


@pytest.mark.slow
def test_the_policy_allows_top_panel_what_it_uses():
    """It takes samples while a page is open only."""
    words = command("top_panel", "--node", "/top", "--port", "0", "--no-browser")
    with running(words, DOMAIN) as panel:
        url = re.search(r"http://\S+", panel.stdout.readline())[0]
        with urllib.request.urlopen(f"{url.rstrip('/')}/news", timeout=TIMEOUT):
            assert_allowed("top_panel")


def test_only_two_programs_may_ask_the_top_for_anything():
    policy = allowed()
    asking = {path for path, uses in policy.items() if "request" in dict(uses)}
    assert asking == {"/top/top_ctl", "/top/top_panel"}
    torque = ("publish", "/top/applied_torque")
    assert {path for path, uses in policy.items() if torque in uses} == {"/top/top_panel"}
