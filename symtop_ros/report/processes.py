"""Nodes in processes of their own, and what they take (Linux)."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

NODE = "import sys; from symtop_ros.programs import top_node; sys.exit(top_node())"


def domain() -> int:
    """ROS domain of this process, apart from tops that run already; its ports are no others'."""
    return 60 + os.getpid() % 30


def node_command(*parameters: str) -> list[str]:
    """Command line of top_node with parameters such as publish_rate:=1000.0."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    return [sys.executable, "-c", NODE, "--ros-args", *words, "--log-level", "warn"]


@contextlib.contextmanager
def running(command: list[str]) -> Iterator[subprocess.Popen[bytes]]:
    """Run a node in this process's domain, and end it."""
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain())}
    with subprocess.Popen(command, env=environment) as node:
        try:
            yield node
        finally:
            node.terminate()


def cpu_seconds(pid: int) -> float:
    """User and system time of a process."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory(pid: int) -> float:
    """Resident memory of a process in MB."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    (line,) = (line for line in lines if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def descriptors(pid: int) -> int:
    """Open files and sockets of a process."""
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))
