"""Starts of top_node, alone and many at once, compared with bare rclpy nodes.

`make -C workshop starts`, or `python -m workshop.load.starts --seconds 2 --runs 1 --nodes 3`. With
`--docs docs` the figures are written into the documentation.
"""

import argparse
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing
from statistics import median
from typing import Any

import numpy as np
from geometry_msgs.msg import QuaternionStamped
from std_srvs.srv import Trigger

from workshop.load.follower import SUBSCRIBED_RATE, TIMEOUT, Subscriber
from workshop.load.node_cost import BARE, TOP, whole
from workshop.load.processes import (
    DOCS,
    cpu_seconds,
    domain,
    memory,
    run_program,
    running,
    script,
    top_node,
)
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_table, publish, write_chapter

COMMANDS = {
    TOP: top_node(f"publish_rate:={SUBSCRIBED_RATE}", "hurry_factor:=1.0"),
    BARE: script("bare", SUBSCRIBED_RATE),
}
ANSWERS = 20  # later ones after a start
REQUESTS = 5  # to each of many nodes
NAME = "starts"  # of the table in the documentation
Values = dict[str, float]  # by the row
Runs = dict[str, dict[str, list[float]]]  # values of each run, by the row and the node


class User(Subscriber):
    """A program that waits for nodes in namespaces: an empty name is the root namespace."""

    def __init__(self, *namespaces: str) -> None:
        super().__init__(domain())
        self.samples: list[bytes] = []
        self._clients: list[Any] = [
            self.node.create_client(Trigger, f"{each}/top/hurry_precession") for each in namespaces
        ]

    def subscribe(self) -> None:
        """Receive the samples of the node in the root namespace."""
        receive: Any = self.samples.append
        self.node.create_subscription(QuaternionStamped, "/top/orientation", receive, 100, raw=True)

    def find_all(self) -> None:
        """Wait until the service of each node is found."""
        patience = TIMEOUT * max(1.0, len(self._clients) / 5)  # many nodes start side by side
        self.wait(
            lambda: all(each.service_is_ready() for each in self._clients), "service", patience
        )

    def ask(self, number: int = 0) -> float:
        """Send a request to a node; return the time in ms until its answer."""
        began = time.monotonic()
        answer = self._clients[number].call_async(Trigger.Request())
        self.wait(answer.done, "answer")
        return 1e3 * (time.monotonic() - began)


def measure_start(command: list[str]) -> Values:
    """Return the figures of one start, from the start of the process on."""
    with closing(User("")) as user:
        user.subscribe()
        began = time.monotonic()
        with running(command) as node:
            user.wait(lambda: bool(user.samples), "sample")
            passed, cpu = time.monotonic() - began, cpu_seconds(node.pid)
            user.find_all()
            first, *later = (user.ask() for _ in range(1 + ANSWERS))
    return {
        "CPU to the first sample, s": cpu,
        "first sample after, s": passed,
        "first answer, ms": first,
        "later answers, ms": median(later),
    }


def measure_many(command: list[str], count: int, seconds: float) -> Values:
    """Return the figures of nodes that are started together and have no subscriber."""
    namespaces = [f"/at{k}" for k in range(count)]
    with ExitStack() as stack:
        user = stack.enter_context(closing(User(*namespaces)))
        began = time.monotonic()
        nodes = [stack.enter_context(running(_place(command, each))) for each in namespaces]
        user.find_all()
        passed = time.monotonic() - began
        before = sum(cpu_seconds(node.pid) for node in nodes)
        user.spin(seconds)
        cpu = sum(cpu_seconds(node.pid) for node in nodes) - before
        room = sum(memory(node.pid) for node in nodes)
        times = [user.ask(number) for number in range(count) for _ in range(REQUESTS)]
    p50, p99 = np.percentile(times, [50, 99])
    return {
        f"{count} nodes: all found after, s": passed,
        f"{count} nodes: CPU of each, % of one core": 100 * cpu / seconds / count,
        f"{count} nodes: memory of each, MB": room / count,
        f"{count} nodes: answer p50, ms": float(p50),
        f"{count} nodes: answer p99, ms": float(p99),
    }


def _place(command: list[str], namespace: str) -> list[str]:
    """Return the command line of a node in a namespace."""
    return [*command, "--ros-args", "-r", f"__ns:={namespace}"]


def compare(seconds: float, runs: int, nodes: int) -> Runs:
    """Measure both nodes several times, in turn, and print each figure when it is there."""
    values: Runs = {}
    for run in range(1, runs + 1):
        for node in COMMANDS:
            for row, value in _measure(node, seconds, nodes if run == 1 else 0):
                values.setdefault(row, {}).setdefault(node, []).append(value)
                print(f"run {run}: {node}: {row}: {value:.3g}", flush=True)
    return values


def _measure(node: str, seconds: float, nodes: int) -> Iterator[tuple[str, float]]:
    """Yield the figures of a start, and of many if there are to be some."""
    yield from measure_start(COMMANDS[node]).items()
    if nodes:
        yield from measure_many(COMMANDS[node], nodes, seconds).items()


def format_section(runs: Runs, **facts: Any) -> str:
    """Return the conditions and the table of docs/reliability_tables.md."""
    rows = [[row, *(_format_cell(of[node]) for node in COMMANDS)] for row, of in runs.items()]
    rows.sort(key=lambda row: "nodes" in row[0])
    return write_chapter(NAME, **facts, table=format_table(["", *COMMANDS], rows))


def _format_cell(values: list[float]) -> str:
    middle, *ends = (f"{each(values):.3g}" for each in (median, min, max))
    return middle if len(values) == 1 else f"{middle} ({' to '.join(ends)})"


def _run(options: argparse.Namespace) -> bool:
    runs = compare(options.seconds, options.runs, options.nodes)
    facts = {"seconds": options.seconds, "count": options.runs, "requests": REQUESTS}
    section = format_section(runs, conditions=describe_conditions("rclpy"), **facts)
    print(section)
    if options.docs:
        publish({NAME: section}, options.docs)
    return True


def main(args: list[str] | None = None) -> int:
    """Print the comparison; return the exit status."""
    description = "Starts of top_node, alone and many at once, compared with bare rclpy nodes."
    runs = {"type": whole, "default": 8, "help": "default: %(default)d"}
    nodes = {"type": whole, "default": 30, "help": "started at once; default: %(default)d"}
    options = {"runs": runs, "nodes": nodes, "docs": DOCS}
    return run_program("starts.py", description, 5.0, _run, args, **options)


if __name__ == "__main__":
    sys.exit(main())
