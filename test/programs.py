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


def run_python(
    code: str, *arguments: object, cwd: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run some lines of Python to their end, in a process of their own."""
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def run_without(
    modules: tuple[str, ...], program: str, *arguments: str, cwd: Path
) -> subprocess.CompletedProcess[str]:
    """Run a program as where some modules are not installed."""
    code = f"import sys; sys.modules.update(dict.fromkeys({modules})); "
    code += f"from symtop_ros import programs; sys.exit(programs.{program}())"
    return run_python(code, *arguments, cwd=cwd, PYTHONPATH=str(RESOURCE.parent))


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
