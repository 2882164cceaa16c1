"""Nodes in separate processes, their use of resources (Linux), and the frame of a load program."""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

from symtop_ros.client.connection import UnreachableError
from symtop_ros.command import positive
from workshop.load.domains import claim_domain
from workshop.load.endings import bound

ROOT = Path(__file__).parents[2]
PROGRAMS = ROOT / "resource"
INTERRUPTED = 130  # exit status of a program that Ctrl-C has ended


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
    add_options: Callable[[argparse.ArgumentParser], object] = lambda _: None,
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
    add_options : callable, optional
        Adds options to the parser.

    Returns
    -------
    int
        Exit status: 0 (good), 1 (not good, or no answer from the node), 2 (usage) or 130
        (interrupted).
    """
    parser = argparse.ArgumentParser(prog=name, description=description)
    parser.add_argument("--seconds", type=positive, default=seconds, help="default: %(default)g")
    add_options(parser)
    options = parser.parse_args(args)
    # SIGTERM raises KeyboardInterrupt as well, so that the nodes that were started are ended.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        return 0 if run(options) else 1
    except KeyboardInterrupt:
        return INTERRUPTED
    except UnreachableError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
