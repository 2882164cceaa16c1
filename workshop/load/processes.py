"""Nodes in separate processes, their use of resources (Linux), and the frame of a load program."""

import argparse
import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from symtop_ros.base.command import positive
from symtop_ros.programs import INTERRUPTED
from symtop_ros.ros.client.connection import UnreachableError
from workshop.load.domains import claim_domain
from workshop.load.endings import bound

ROOT = Path(__file__).parents[2]
PROGRAMS = ROOT / "resource"
DOCS = {"type": Path, "help": "folder of the documentation to update"}  # an option


@cache
def domain() -> int:
    """Return the ROS domain of this process, which no other test process uses."""
    return claim_domain()


def script(name: str, *arguments: object) -> list[str]:
    """Return the command line of a module of this folder, from whatever folder it is started."""
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    start = ["/usr/bin/env", f"PYTHONPATH={path}", sys.executable, "-m", f"{__package__}.{name}"]
    return bound([*start, *map(str, arguments)])


def program(name: str, *arguments: str) -> list[str]:
    """Return the command line of a program of the package."""
    return bound([sys.executable, str(PROGRAMS / name), *arguments])


def top_node(*parameters: str) -> list[str]:
    """Return the command line of top_node with parameters such as publish_rate:=1000.0."""
    words = [word for parameter in parameters for word in ("-p", parameter)]
    return program("top_node", "--ros-args", *words, "--log-level", "warn")


def cpu_seconds(pid: int) -> float:
    """Return the user and system time of a process in s."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory(pid: int) -> float:
    """Return the resident memory of a process in MB."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    (line,) = (line for line in lines if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def descriptors(pid: int) -> int:
    """Return the number of open files and sockets of a process."""
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))


@contextlib.contextmanager
def running(command: list[str]) -> Iterator[subprocess.Popen[bytes]]:
    """Run a node in the domain of this process, and end it."""
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain())}
    with subprocess.Popen(command, env=environment) as node:
        try:
            yield node
        finally:
            node.terminate()


def run_program(
    name: str,
    description: str,
    seconds: float,
    run: Callable[[argparse.Namespace], bool],
    args: list[str] | None,
    **options: Mapping[str, Any],
) -> int:
    """Run a load program with the option --seconds and its own options.

    Parameters
    ----------
    name, description : str
        For --help.
    seconds : float
        Default of the option in s.
    run : callable
        Takes the options, prints its figures, returns True if they are good.
    args : list of str or None
        Arguments of the command line.
    options : mappings
        Further options by their names, as `add_argument` takes them.

    Returns
    -------
    int
        Exit status: 0 (good), 1 (not good, or no answer from the node), 2 (usage) or 130
        (interrupted).
    """
    parser = argparse.ArgumentParser(prog=name, description=description)
    parser.add_argument("--seconds", type=positive, default=seconds, help="default: %(default)g")
    for option, facts in options.items():
        parser.add_argument(f"--{option}", **facts)
    chosen = parser.parse_args(args)
    # SIGTERM raises KeyboardInterrupt as well, so that the nodes that were started are ended.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        return 0 if run(chosen) else 1
    except KeyboardInterrupt:
        return INTERRUPTED
    except UnreachableError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
