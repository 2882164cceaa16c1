"""What a node costs and how steady it is, beside a bare node of rclpy with the same messages."""

from __future__ import annotations

import contextlib
import sys
import tempfile
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from symtop_ros.report.bare import TOPICS
from symtop_ros.report.listener import Listener, Traffic
from symtop_ros.report.processes import domain, node_command, running

BARE = "from symtop_ros.report.bare import main; main()"
LOAD_RATES = (200.0, 1000.0)  # Hz
RATES = (500.0, 1000.0, 1500.0, 2000.0)  # Hz, of which the highest one that is held is told
HELD = 1e-3  # share of samples that may be late then
KICKS = 100
NAME = 40  # columns
PAUSE = 0.0137  # s between kicks; no multiple of a period
Command = Callable[[float], list[str]]  # of a rate in Hz


class Figures(NamedTuple):
    """What was measured of a node at one rate.

    Attributes
    ----------
    core : float
        Share of a core.
    message : float
        us of CPU for each message.
    arrived, late : float
        Shares of the samples; late is what came more than a period after its time.
    jitter : (3,) of float
        p50, p99 and largest deviation from the period, us.
    """

    core: float
    message: float
    arrived: float
    late: float
    jitter: tuple[float, ...]


def top_node(folder: str, recording: bool = False) -> Command:
    """Command line of our node."""

    def command(rate: float) -> list[str]:
        return node_command(
            *(f"publish_rate:={rate}", f"record.enabled:={recording}".lower()),
            *(f"record.directory:={folder}", "hurry_factor:=1.0"),
        )

    return command


def bare_node(rate: float) -> list[str]:
    """Command line of the peer."""
    return [sys.executable, "-c", BARE, str(rate)]


def load(command: Command, rate: float, seconds: float) -> Figures:
    """Run a node at a rate (Hz) for some seconds."""
    with _listening(command(rate)) as (listener, pid):
        return figures(listener.listen(pid, rate, seconds), rate, seconds)


def figures(traffic: Traffic, rate: float, seconds: float) -> Figures:
    """Return what the traffic of some seconds at a rate (Hz) says."""
    period = 1 / rate
    gaps = np.diff(traffic.sent)
    off = np.abs(gaps - period) * 1e6
    return Figures(
        core=traffic.cpu / seconds,
        message=traffic.cpu / max(traffic.messages, 1) * 1e6,
        arrived=traffic.arrived,
        late=float((gaps > 2 * period).mean()),
        jitter=tuple(float(each) for each in np.percentile(off, [50, 99, 100])),
    )


def kick_latency(command: Command, rate: float) -> tuple[float, float]:
    """Return p50 and p99, in ms, of the time from a request to the first sample it governs."""
    with _listening(command(rate)) as (listener, _):
        latencies = [listener.kick(PAUSE) * 1e3 for _ in range(KICKS)]
    half, most = np.percentile(latencies, [50, 99])
    return float(half), float(most)


def highest_rate(command: Command, seconds: float) -> float:
    """Return the highest of some rates (Hz) at which hardly a sample is late; 0 for none."""
    held = [rate for rate in RATES if load(command, rate, seconds).late < HELD]
    return max(held, default=0.0)


def table(seconds: float) -> Iterator[str]:
    """Yield the lines of the comparison, as they are measured."""
    with tempfile.TemporaryDirectory() as folder:
        top, recorded = top_node(folder), top_node(folder, recording=True)
        yield f"{len(TOPICS)} topics, one subscriber each\n{'':{NAME}}{'top_node':>12}"
        yield f"{'bare rclpy':>12}{'ratio':>8}\n"
        for rate in LOAD_RATES:
            bare = load(bare_node, rate, seconds)
            yield from _rows(f"{rate:.0f} Hz", load(top, rate, seconds), bare)
            yield from _rows(f"{rate:.0f} Hz, recording", load(recorded, rate, seconds), bare)[:1]
        kicks = [kick_latency(command, 1000.0) for command in (top, bare_node)]
        for k, name in enumerate(("p50", "p99")):
            yield _row(f"1000 Hz: kick latency {name}", "ms", kicks[0][k], kicks[1][k])
        rates = [highest_rate(command, seconds / 2) for command in (top, bare_node)]
        yield _row(f"highest rate, < {HELD:.1%} late", "Hz", *rates)


def _rows(at: str, ours: Figures, bare: Figures) -> list[str]:
    return [
        _row(f"{at}: CPU of a core", "%", ours.core * 100, bare.core * 100),
        _row(f"{at}: CPU per message", "us", ours.message, bare.message),
        _row(f"{at}: samples arrived", "%", ours.arrived * 100, bare.arrived * 100),
        _row(f"{at}: samples late", "%", ours.late * 100, bare.late * 100),
        *(
            _row(f"{at}: jitter {name}", "us", *both)
            for name, *both in zip(("p50", "p99", "max"), ours.jitter, bare.jitter, strict=True)
        ),
    ]


def _row(name: str, unit: str, ours: float, bare: float) -> str:
    ratio = f"{ours / bare:8.2f}" if bare else f"{'':8}"
    return f"{name + ' (' + unit + ')':{NAME}}{ours:12.4g}{bare:12.4g}{ratio}\n"


@contextlib.contextmanager
def _listening(command: list[str]) -> Iterator[tuple[Listener, int]]:
    """Run a node, and listen to it."""
    with running(command) as node:
        listener = Listener(domain())
        try:
            yield listener, node.pid
        finally:
            listener.close()
