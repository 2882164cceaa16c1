"""The installed programs as processes in a given ROS domain."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from workshop.load.endings import bound

RESOURCE = Path(__file__).parents[1] / "resource"
# Options of top_ctl: a node that is starting on a loaded machine may take longer than 5 s.
PATIENT = "--timeout", "60"
# Fast DDS 3 has renamed an element.
LOSSY_PROFILES = {"jazzy": "fastdds_lossy.xml", "kilted": "fastdds_lossy_kilted.xml"}


def command(name: str, *arguments: str) -> list[str]:
    """Command line of a program, with the Python of the tests."""
    return bound([sys.executable, str(RESOURCE / name), *arguments])


def environment(domain: int) -> dict[str, str]:
    """Environment of a program."""
    return {**os.environ, "ROS_DOMAIN_ID": str(domain)}


def run(name: str, *arguments: str, domain: int) -> subprocess.CompletedProcess[str]:
    """Run a program to its end."""
    return subprocess.run(
        command(name, *arguments),
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=environment(domain),
    )


@contextlib.contextmanager
def running_node(
    domain: int, *parameters: str, name: str = "top"
) -> Iterator[subprocess.Popen[bytes]]:
    """Run top_node with parameters such as publish_rate:=1000, and end it."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    options = ["--ros-args", *words, "-r", f"__node:={name}", "--log-level", "warn"]
    node = subprocess.Popen(command("top_node", *options), env=environment(domain))
    try:
        yield node
    finally:
        node.terminate()
        node.wait(timeout=60)
