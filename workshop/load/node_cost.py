"""Cost and steadiness of top_node, compared with bare rclpy nodes with the same messages.

`make -C workshop node-cost`, or `python -m workshop.load.node_cost --seconds 5 --runs 3`. With
`--docs docs` the figures are written into the documentation.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing
from statistics import median
from typing import Any

import numpy as np

from workshop.load import alone
from workshop.load.bare import TOPICS
from workshop.load.listener import LOOK, Listener, Traffic
from workshop.load.processes import DOCS, domain, run_program, running, script, top_node
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_table, format_tables, publish, write_chapter

COST_RATES = (200.0, 1000.0)  # Hz
RATES = (500.0, 1000.0, 1500.0, 2000.0)  # Hz, tried for the highest one without late samples
LATE = 1e-3  # fraction of late samples below which a rate counts as reached
KICKS = 100
PAUSE = 0.013  # s between kicks at least
GOLDEN = 0.6180339887498949  # its multiples are spread evenly modulo 1
TOP, RECORDING, BARE, PREPARED = "top_node", "top_node, recording", "bare rclpy", "prepared bytes"
TOP_FIFO, BARE_FIFO = "top_node, SCHED_FIFO", "bare rclpy, SCHED_FIFO"
PRIORITY = 50
CPU, LATE_SAMPLES, JITTER = "CPU, % (one core)", "late samples, %", "jitter p99, ms"
KICK, SLOW_KICK = "kick to first sample, ms", "kick to first sample p99, ms"
HIGHEST = f"highest rate with < {100 * LATE:g} % late, Hz"

Command = Callable[[float], list[str]]  # command line for a rate in Hz
NAME = "node cost"  # of the table in the documentation
MEASURED = "measured node"  # of that in the README
Runs = dict[str, dict[str, list[float]]]  # values of each run, by the row and the node


def list_commands(folder: str) -> dict[str, Command]:
    """Return the command line of each node as a function of the rate; logs go to a folder."""

    def top(rate: float, recording: bool = False, priority: int = 0) -> list[str]:
        return top_node(
            f"publish_rate:={rate}",
            f"record.enabled:={recording}".lower(),
            f"scheduling_priority:={priority}",
            f"record.directory:={folder}",
            "hurry_factor:=1.0",
        )

    commands: dict[str, Command] = {
        TOP: top,
        RECORDING: lambda rate: top(rate, recording=True),
        BARE: lambda rate: script("bare", rate),
        PREPARED: lambda rate: script("bare", rate, "--prepared"),
    }
    if _may_use_real_time():
        chrt = ["chrt", "--fifo", str(PRIORITY)]
        commands[TOP_FIFO] = lambda rate: top(rate, priority=PRIORITY)
        commands[BARE_FIFO] = lambda rate: [*chrt, *script("bare", rate)]
    return commands


def _may_use_real_time() -> bool:
    """Return True if this machine grants real-time scheduling."""
    command = ["chrt", "--fifo", str(PRIORITY), "true"]
    try:
        return subprocess.run(command, capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        return False


def measure(command: Command, rate: float, seconds: float) -> dict[str, float]:
    """Return the figures of a node at a rate (Hz) in some seconds."""
    with running(command(rate)) as node, closing(Listener(domain())) as listener:
        return summarize(listener.listen(node.pid, rate, seconds), rate, seconds)


def summarize(traffic: Traffic, rate: float, seconds: float) -> dict[str, float]:
    """Return the figures of the traffic of some seconds at a rate (Hz).

    A sample is late if it comes more than a period after its time, and lost ones are late.
    """
    period = 1 / rate
    gaps = np.diff(traffic.sent)
    late = max(float((gaps > 2 * period).mean()), 1 - traffic.arrived)
    return {
        CPU: 100 * traffic.cpu / seconds,
        LATE_SAMPLES: 100 * late,
        JITTER: 1e3 * float(np.percentile(np.abs(gaps - period), 99)),
    }


def measure_kicks(command: Command, rate: float) -> tuple[float, float]:
    """Return p50 and p99, in ms, of the time from a request to the first sample after it."""
    with running(command(rate)), closing(Listener(domain())) as listener:
        latencies = [listener.kick(pause) * 1e3 for pause in list_pauses(rate)]
    p50, p99 = np.percentile(latencies, [50, 99])
    return float(p50), float(p99)


def list_pauses(rate: float) -> list[float]:
    """Return the pauses in s before each kick, so that they come at all phases of a period.

    A pause begins with a sample: after equal ones half of the kicks of a bare node came within a
    fifth of its period.
    """
    return [PAUSE + (k * GOLDEN % 1) / rate for k in range(KICKS)]


def find_highest_rate(command: Command, seconds: float) -> float:
    """Return the highest of `RATES` (Hz) with less than `LATE` of the samples late, or 0."""
    reached = [rate for rate in RATES if measure(command, rate, seconds)[LATE_SAMPLES] < 100 * LATE]
    return max(reached, default=0.0)


def compare(seconds: float, runs: int) -> Runs:
    """Measure every node several times, in turn, and print each figure when it is there."""
    values: Runs = {}
    with tempfile.TemporaryDirectory() as folder:
        for run in range(1, runs + 1):
            for node, command in list_commands(folder).items():
                for row, value in _measure_all(node, command, seconds):
                    values.setdefault(row, {}).setdefault(node, []).append(value)
                    print(f"run {run}: {node}: {row}: {value:.3g}", flush=True)
    return values


def _measure_all(node: str, command: Command, seconds: float) -> Iterator[tuple[str, float]]:
    # At 1000 Hz a bare node with SCHED_FIFO takes both processors, and no other program runs.
    is_real_time = node in (TOP_FIFO, BARE_FIFO)
    rates = COST_RATES[:1] if is_real_time else COST_RATES
    for rate in rates:
        for row, value in measure(command, rate, seconds).items():
            yield f"{rate:.0f} Hz: {row}", value
    if node != RECORDING:
        for row, value in zip((KICK, SLOW_KICK), measure_kicks(command, rates[-1]), strict=True):
            yield f"{rates[-1]:.0f} Hz: {row}", value
    if node == TOP:
        yield from alone.measure().items()
    if not (node == RECORDING or is_real_time):
        yield HIGHEST, find_highest_rate(command, seconds / 2)


def format_sections(facts: dict[str, Any]) -> dict[str, str]:
    """Return the table of docs/reliability_tables.md with its conditions, and the README's."""
    runs: Runs = facts["runs"]
    nodes = tuple(dict.fromkeys(node for row in runs.values() for node in row))
    rows = [[row, *(_format_cell(row, of.get(node)) for node in nodes)] for row, of in runs.items()]
    values = {
        "messages": len(TOPICS),
        "look": LOOK,
        "rates": ", ".join(f"{rate:g}" for rate in RATES),
        "alone": alone.KICKS,
        "pause": alone.PAUSE,
    }
    table = format_tables(["", *nodes], rows)
    return {NAME: write_chapter(NAME, **facts, **values, table=table), MEASURED: format_few(runs)}


def format_few(runs: Runs) -> str:
    """Return the README's figures: what the node takes, and where a bare node is ahead."""
    cpu = runs[f"{COST_RATES[0]:.0f} Hz: {CPU}"]
    rows = (
        (f"CPU (one core) at {COST_RATES[0]:g} Hz, five topics", cpu, ".2g", " %"),
        ("highest rate", runs[HIGHEST], "g", " Hz"),
    )
    return format_table(
        ["", "`top_node`", "bare rclpy", "bare rclpy, messages serialized in advance"],
        [
            [name, *(f"{median(of[node]):{form}}{unit}" for node in (TOP, BARE, PREPARED))]
            for name, of, form, unit in rows
        ],
    )


def _format_cell(row: str, values: list[float] | None) -> str:
    if not values:
        return ""
    middle, *ends = (_format_value(row, each(values)) for each in (median, min, max))
    return middle if set(ends) == {middle} else f"{middle} ({' to '.join(ends)})"


def _format_value(row: str, value: float) -> str:
    if row == HIGHEST:
        return f"{value:g}" if value else f"below {RATES[0]:g}"
    return f"{value:.3g}"


def whole(text: str) -> int:
    """Return an argument that counts something."""
    if not (text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"must be a whole number above 0, got {text!r:.40}")
    return int(text)


def _run(options: argparse.Namespace) -> bool:
    facts = {"conditions": describe_conditions("rclpy"), "count": options.runs}
    sections = format_sections({**facts, "runs": compare(options.seconds, options.runs)})
    print(sections[NAME])
    if options.docs:
        publish(sections, options.docs)
    return True


def main(args: list[str] | None = None) -> int:
    """Print the comparison; return the exit status."""
    description = "CPU, jitter and kick latency of top_node, compared with bare rclpy nodes."
    runs = {"type": whole, "default": 3, "help": "default: %(default)d"}
    return run_program("node_cost.py", description, 5.0, _run, args, runs=runs, docs=DOCS)


if __name__ == "__main__":
    sys.exit(main())
