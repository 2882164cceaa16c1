"""The load of a real node in another process: what arrives, and how much of a core it takes."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import rclpy
from geometry_msgs.msg import QuaternionStamped, TwistStamped, Vector3Stamped, WrenchStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

TOPICS = {
    "orientation": QuaternionStamped,
    "angular_velocity": TwistStamped,
    "angular_momentum": Vector3Stamped,
    "torque": WrenchStamped,
    "euler_angles": JointState,
}
NODE = "import sys; from symtop_ros.node.main import main; sys.exit(main())"
STARTING = 30.0  # s that the node may take until every topic has a sample
SETTLING = 1.0  # s


class Load(NamedTuple):
    """What one rate cost: share of the samples that arrived, and of a core."""

    arrived: float
    core: float


def measure(rate: float, seconds: float, recording: bool) -> Load:
    """Run a node at a rate (Hz), with one subscriber on every topic, for some seconds."""
    with tempfile.TemporaryDirectory() as folder:
        return _measure(rate, seconds, recording, folder)


def _measure(rate: float, seconds: float, recording: bool, folder: str) -> Load:
    domain = 100 + os.getpid() % 100
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    options = ["--ros-args", "-p", f"publish_rate:={rate}", "--log-level", "warn"]
    options += ["-p", f"record.enabled:={recording}".lower(), "-p", f"record.directory:={folder}"]
    with subprocess.Popen([sys.executable, "-c", NODE, *options], env=environment) as node:
        try:
            return _listen(node.pid, domain, rate, seconds)
        finally:
            node.terminate()


def _listen(pid: int, domain: int, rate: float, seconds: float) -> Load:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    try:
        listener = rclpy.create_node("listener", context=context)
        got: dict[str, list[bytes]] = {name: [] for name in TOPICS}
        for name, kind in TOPICS.items():
            take: Any = got[name].append
            listener.create_subscription(kind, f"/top/{name}", take, 1000, raw=True)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(listener)
        _spin(executor, STARTING, lambda: all(got.values()))
        _spin(executor, SETTLING)
        for messages in got.values():
            messages.clear()
        cpu, began = _cpu_seconds(pid), time.monotonic()
        _spin(executor, seconds)
        core = (_cpu_seconds(pid) - cpu) / (time.monotonic() - began)
        shares = [_arrived(messages, TOPICS[name], rate) for name, messages in got.items()]
        return Load(min(shares), core)
    finally:
        rclpy.shutdown(context=context)


def _spin(
    executor: SingleThreadedExecutor, seconds: float, done: Callable[[], bool] = lambda: False
) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end and not done():
        executor.spin_once(timeout_sec=0.1)


def _cpu_seconds(pid: int) -> float:
    """User and system time of a process (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _arrived(messages: list[bytes], kind: Any, rate: float) -> float:
    """Share of the samples between the first and the last stamp."""
    if not messages:
        return 0.0
    first, last = (deserialize_message(messages[i], kind).header.stamp for i in (0, -1))
    seconds = last.sec - first.sec + (last.nanosec - first.nanosec) * 1e-9
    return len(messages) / float(round(seconds * rate) + 1)
