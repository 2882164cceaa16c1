"""A node under load: many clients, many subscribers, lazy and late ones, many nodes."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from rclpy.node import Node

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.report.bare import LATCHED
from symtop_ros.report.follower import DEPTH, PATIENCE, Follower, request
from symtop_ros.report.processes import cpu_seconds, domain, memory, node_command, running

FAST, USUAL = 1000.0, 200.0  # Hz
CLIENTS, SUBSCRIBERS, JOINERS, TOPS = 4, 50, 200, 8
EVENTS = 20  # latched ones that every late joiner must get
SETTLING = 1.5  # s; diagnostics come once a second
CALLS: tuple[tuple[str, Any], ...] = (
    ("hurry_precession", None),
    ("get_state", None),
    ("kick", {"precession_rate_change": float("nan")}),  # refused
    ("reset", None),
)


@dataclass(frozen=True)
class Outcome:
    """What a load did.

    Attributes
    ----------
    load : str
        What it was.
    rate : float
        Of the samples that came, in Hz.
    lost, missed : int
        Samples that were published and did not come, and that the node had no time for.
    unanswered : int
        Requests, or late joiners, that got nothing.
    core : float
        Share of a core that the node, or all nodes, took.
    growth : float
        Of the memory of the nodes, in MB.
    figures : str
        More about it.
    """

    load: str
    rate: float
    lost: int
    missed: int
    core: float
    growth: float
    unanswered: int = 0
    figures: str = ""

    @property
    def good(self) -> bool:
        """Whether nothing was lost and nobody was left without an answer."""
        return not (self.lost or self.unanswered)


HEAD = f"{'':42}{'Hz':>7}{'lost':>6}{'missed':>8}{'unanswered':>12}{'core':>7}{'MB more':>9}"


def row(outcome: Outcome) -> str:
    """Return an outcome as a line below the head."""
    o = outcome
    return (
        f"{o.load:42}{o.rate:7.1f}{o.lost:6}{o.missed:8}{o.unanswered:12}{o.core:7.0%}"
        f"{o.growth:9.2f}   {o.figures}"
    )


def stress(seconds: float) -> Iterator[Outcome]:
    """Yield the outcome of one load after the other, each of some seconds."""
    for load in (_clients, _subscribers, _lazy, _late_joiners, _many_tops):
        yield load(seconds)


@contextmanager
def _top(rate: float, name: str = "/top") -> Iterator[tuple[Follower, int]]:
    namespace = name.removesuffix("/top")
    renamed = ["-r", f"__ns:={namespace}"] if namespace else []
    command = [*node_command(f"publish_rate:={rate}", "scene:=hurry_slow"), *renamed]
    with running(command) as node:
        follower = Follower(rate, name)
        try:
            follower.begin()
            follower.spin(SETTLING)
            yield follower, node.pid
        finally:
            follower.close()


def _measured(load: str, tops: list[tuple[Follower, int]], seconds: float) -> Outcome:
    """Follow nodes for some seconds, under a load that goes on by itself."""
    cpu = sum(cpu_seconds(pid) for _, pid in tops)
    before = sum(memory(pid) for _, pid in tops)
    for follower, _ in tops:
        follower.begin()
    began = time.monotonic()
    while time.monotonic() - began < seconds:
        for follower, _ in tops:
            follower.spin(0.02)
    passed = time.monotonic() - began
    core = (sum(cpu_seconds(pid) for _, pid in tops) - cpu) / passed
    rate = min(follower.samples for follower, _ in tops) / passed
    for follower, _ in tops:
        follower.spin(SETTLING)
    growth = sum(memory(pid) for _, pid in tops) - before
    lost, missed = (sum(each) for each in zip(*((f.lost, f.missed) for f, _ in tops), strict=True))
    return Outcome(load, rate, lost, missed, core, growth)


def _clients(seconds: float) -> Outcome:
    """Clients in processes of their own, each as fast as it is answered."""
    with _top(FAST) as top:
        clients = [_python("call", domain(), seconds) for _ in range(CLIENTS)]
        outcome = _measured(f"{CLIENTS} clients, {FAST:g} Hz", [top], seconds + SETTLING)
        answers = [json.loads(client.communicate(timeout=2 * PATIENCE)[0]) for client in clients]
    latencies = np.concatenate([each["seconds"] for each in answers]) * 1e3
    half, most, longest = np.percentile(latencies, [50, 99, 100])
    return replace(
        outcome,
        unanswered=sum(each["unanswered"] for each in answers),
        figures=f"{len(latencies) / seconds:.0f} calls/s; ms to an answer: "
        f"{half:.1f} (p50), {most:.1f} (p99), {longest:.0f} (longest)",
    )


def _subscribers(seconds: float) -> Outcome:
    """Many subscriptions to one topic, in one process."""
    with _top(USUAL) as top:
        others = _python("subscribe", domain(), SUBSCRIBERS, seconds + SETTLING)
        outcome = _measured(f"{SUBSCRIBERS} subscribers, {USUAL:g} Hz", [top], seconds + SETTLING)
        gaps = json.loads(others.communicate(timeout=2 * PATIENCE)[0])
    figures = f"all of them got all but {sum(gaps)} samples"
    return replace(outcome, lost=outcome.lost + sum(gaps), figures=figures)


def _lazy(seconds: float) -> Outcome:
    """A subscriber that never takes what comes."""
    with _top(FAST) as top, _idle_node() as node:
        node.create_subscription(QuaternionStamped, "/top/orientation", lambda _: None, DEPTH)
        return _measured(f"a subscriber that never takes, {FAST:g} Hz", [top], seconds)


def _late_joiners(seconds: float) -> Outcome:
    """Subscribers that come after the events, all within the time, one after the other."""
    with _top(FAST) as top:
        for _ in range(EVENTS):
            top[0].connection.trigger("hurry_precession")
        joining = _python("join", domain(), JOINERS, EVENTS + 1)
        outcome = _measured(f"{JOINERS} late joiners, {FAST:g} Hz", [top], seconds)
        waited = json.loads(joining.communicate(timeout=JOINERS * PATIENCE)[0])
    figures = f"ms to all {EVENTS + 1} events: {np.median(waited) * 1e3:.0f} (p50), "
    figures += f"{max(waited) * 1e3:.0f} (longest)"
    return replace(outcome, unanswered=JOINERS - len(waited), figures=figures)


def _many_tops(seconds: float) -> Outcome:
    """Tops in namespaces of their own."""
    with ExitStack() as stack:
        tops = [stack.enter_context(_top(USUAL, f"/top{k}/top")) for k in range(TOPS)]
        return _measured(f"{TOPS} tops in {TOPS} namespaces, {USUAL:g} Hz", tops, seconds)


@contextmanager
def _idle_node(domain_id: int | None = None) -> Iterator[Node]:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain() if domain_id is None else domain_id)
    try:
        yield rclpy.create_node("load", context=context, enable_rosout=False)
    finally:
        rclpy.shutdown(context=context)


# what runs in other processes; each prints JSON


def _python(function: str, *arguments: float) -> subprocess.Popen[bytes]:
    words = ", ".join(map(repr, arguments))
    program = f"from symtop_ros.report.stress import {function}; {function}({words})"
    return subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE)


def call(domain_id: int, seconds: float) -> None:
    """Call services as fast as they answer; print how long each took, and how many did not."""
    with _idle_node(domain_id) as node:
        connection = Connection(node, timeout=PATIENCE)
        connection.trigger("get_state")
        taken: list[float] = []
        unanswered, end = 0, time.monotonic() + seconds
        while (began := time.monotonic()) < end:
            try:
                request(connection, *CALLS[len(taken) % len(CALLS)])
            except UnreachableError:
                unanswered += 1
            taken.append(time.monotonic() - began)
    print(json.dumps({"seconds": taken, "unanswered": unanswered}))


def subscribe(domain_id: int, count: int, seconds: float) -> None:
    """Subscribe many times; print how many samples each subscription has lost."""
    stamps: list[list[int]] = [[] for _ in range(count)]
    with _idle_node(domain_id) as node:
        connection = Connection(node)
        for taken in stamps:
            connection.follow(QuaternionStamped, "orientation", partial(_note_stamp, taken))
        connection.spin_until(lambda: all(stamps), PATIENCE)
        connection.spin_until(lambda: False, seconds)
    period = round(1e9 / USUAL)
    gaps = [int((np.diff(each) % 1_000_000_000 != period).sum()) for each in stamps]
    print(json.dumps(gaps))


def _note_stamp(stamps: list[int], message: QuaternionStamped) -> None:
    stamps.append(message.header.stamp.nanosec)


def join(domain_id: int, count: int, events: int) -> None:
    """Subscribe to the latched events, wait for them and leave, again and again; print times."""
    got: list[DiagnosticArray] = []
    waited = []
    with _idle_node(domain_id) as node:
        connection = Connection(node)
        for _ in range(count):
            got.clear()
            began = time.monotonic()
            latecomer = node.create_subscription(
                DiagnosticArray, "/top/events", got.append, LATCHED
            )
            if connection.spin_until(lambda: len(got) >= events, PATIENCE):
                waited.append(time.monotonic() - began)
            node.destroy_subscription(latecomer)
    print(json.dumps(waited))
