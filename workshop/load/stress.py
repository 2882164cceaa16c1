"""top_node under load: many clients, many subscribers, slow and late ones, many nodes.

`make -C workshop stress`, or `python -m workshop.load.stress --seconds 10`. With `--docs docs` the
figures are written into the documentation.
"""

import argparse
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, closing, contextmanager
from dataclasses import asdict, dataclass, replace
from multiprocessing import get_context

import numpy as np
from geometry_msgs.msg import QuaternionStamped

from workshop.load.follower import (
    DEPTH,
    SUBSCRIBED_RATE,
    TIMEOUT,
    Follower,
    Subscriber,
    call,
    join,
    subscribe,
)
from workshop.load.processes import (
    DOCS,
    cpu_seconds,
    domain,
    memory,
    run_program,
    running,
    top_node,
)
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_list, format_table, publish, write_chapter

FAST = 1000.0  # Hz
USUAL = SUBSCRIBED_RATE  # Hz
CLIENTS, SUBSCRIBERS, JOINERS, TOPS = 4, 50, 200, 8
EVENTS = 20  # latched kicks that every late joiner must receive, after the start
SETTLING = 1.5  # s; diagnostics come once a second
NAME = "stress"  # of the table in the documentation


@dataclass(frozen=True)
class Outcome:
    """The effect of one load.

    Attributes
    ----------
    load : str
        Description of the load.
    rate : float
        Rate of the samples that were received, in Hz.
    lost, missed : int
        Samples that were published and not received, and those that the node reports as missed.
    cpu : float
        CPU of all nodes, as a fraction of one core.
    growth : float
        Growth of the memory of all nodes in MB.
    unanswered : int
        Requests without an answer, or late joiners that did not get every event.
    figures : str
        Further figures.
    """

    load: str
    rate: float
    lost: int
    missed: int
    cpu: float
    growth: float
    unanswered: int = 0
    figures: str = ""

    @property
    def good(self) -> bool:
        """True if nothing was lost and every request was answered."""
        return not (self.lost or self.unanswered)


HEAD = f"{'':42}{'Hz':>7}{'lost':>6}{'missed':>8}{'unanswered':>12}{'CPU':>7}{'MB more':>9}"
ROW = "{load:42}{rate:7.1f}{lost:6}{missed:8}{unanswered:12}{cpu:7.0%}{growth:9.2f}   {figures}"


def format_section(outcomes: Sequence[Outcome], seconds: float, conditions: str) -> str:
    """Return the conditions, the table and the further figures of some outcomes."""
    head = ["load", "Hz", "lost", "missed", "unanswered", "CPU", "MB more"]
    rows = [
        [
            each.load,
            f"{each.rate:.1f}",
            f"{each.lost}",
            f"{each.missed}",
            f"{each.unanswered}",
            f"{100 * each.cpu:.0f} %",
            f"{each.growth:.1f}",
        ]
        for each in outcomes
    ]
    figures = format_list(f"{each.load}: {each.figures}." for each in outcomes if each.figures)
    values = {"seconds": seconds, "conditions": conditions, "figures": figures}
    return write_chapter(NAME, **values, table=format_table(head, rows))


def stress(seconds: float) -> Iterator[Outcome]:
    """Yield the outcome of each load, of some seconds each."""
    for load in (_clients, _subscribers, _idle_subscriber, _late_joiners, _many_tops):
        yield load(seconds)


@contextmanager
def _top(rate: float, name: str = "/top") -> Iterator[tuple[Follower, int]]:
    """Run a node; give a follower of it, and its process id."""
    namespace = name.removesuffix("/top")
    renamed = ["-r", f"__ns:={namespace}"] if namespace else []
    command = [*top_node(f"publish_rate:={rate}", "scene:=hurry_slow"), *renamed]
    with running(command) as node, closing(Follower(rate, name)) as follower:
        follower.begin()
        follower.spin(SETTLING)
        yield follower, node.pid


def _measure(load: str, tops: list[tuple[Follower, int]], seconds: float) -> Outcome:
    """Follow nodes for some seconds, while the load runs in other processes."""
    cpu = sum(cpu_seconds(pid) for _, pid in tops)
    before = sum(memory(pid) for _, pid in tops)
    for follower, _ in tops:
        follower.begin()
    began = time.monotonic()
    while time.monotonic() - began < seconds:
        for follower, _ in tops:
            follower.spin(0.02)
    passed = time.monotonic() - began
    cpu = (sum(cpu_seconds(pid) for _, pid in tops) - cpu) / passed
    rate = min(follower.samples for follower, _ in tops) / passed
    for follower, _ in tops:
        follower.spin(SETTLING)
    growth = sum(memory(pid) for _, pid in tops) - before
    lost, missed = (sum(each) for each in zip(*((f.lost, f.missed) for f, _ in tops), strict=True))
    return Outcome(load, rate, lost, missed, cpu, growth)


def _clients(seconds: float) -> Outcome:
    """Clients in separate processes, each with one request after the other."""
    with _top(FAST) as top, _processes(CLIENTS) as pool:
        clients = [pool.submit(call, domain(), seconds) for _ in range(CLIENTS)]
        outcome = _measure(f"{CLIENTS} clients, {FAST:g} Hz", [top], seconds + SETTLING)
        answers = [client.result(2 * TIMEOUT) for client in clients]
    latencies = np.concatenate([each["seconds"] for each in answers]) * 1e3
    p50, p99, longest = np.percentile(latencies, [50, 99, 100])
    return replace(
        outcome,
        unanswered=sum(each["unanswered"] for each in answers),
        figures=f"{len(latencies) / seconds:.0f} calls/s; ms to an answer: "
        f"{p50:.1f} (p50), {p99:.1f} (p99), {longest:.0f} (longest)",
    )


def _subscribers(seconds: float) -> Outcome:
    """Many subscriptions to one topic, in one process."""
    with _top(USUAL) as top, _processes(1) as pool:
        before = top[0].fact("missed")
        others = pool.submit(subscribe, domain(), SUBSCRIBERS, seconds + SETTLING)
        outcome = _measure(f"{SUBSCRIBERS} subscribers, {USUAL:g} Hz", [top], seconds + SETTLING)
        gaps = others.result(2 * TIMEOUT)
        missed = top[0].fact("missed") - before  # by the node: a gap for each of them
    figures = f"gaps in all of them together: {sum(gaps)}"
    lost = outcome.lost + max(0, sum(gaps) - SUBSCRIBERS * missed)
    return replace(outcome, lost=lost, figures=figures)


def _idle_subscriber(seconds: float) -> Outcome:
    """A subscriber that is never spun, so that its queue fills up."""
    with _top(FAST) as top, closing(Subscriber(domain())) as other:
        other.node.create_subscription(QuaternionStamped, "/top/orientation", lambda _: None, DEPTH)
        return _measure(f"a subscriber that is never spun, {FAST:g} Hz", [top], seconds)


def _late_joiners(seconds: float) -> Outcome:
    """Subscribers that come after the events, one after the other."""
    with _top(FAST) as top, _processes(1) as pool:
        for _ in range(EVENTS):
            top[0].connection.request("hurry_precession")
        joining = pool.submit(join, domain(), JOINERS, EVENTS + 1)
        outcome = _measure(f"{JOINERS} late joiners, {FAST:g} Hz", [top], seconds)
        times = joining.result(JOINERS * TIMEOUT)
    figures = f"ms to all {EVENTS + 1} events: {np.median(times) * 1e3:.0f} (p50), "
    figures += f"{max(times) * 1e3:.0f} (longest)"
    return replace(outcome, unanswered=JOINERS - len(times), figures=figures)


def _many_tops(seconds: float) -> Outcome:
    """Tops in separate namespaces."""
    with ExitStack() as stack:
        tops = [stack.enter_context(_top(USUAL, f"/top{k}/top")) for k in range(TOPS)]
        return _measure(f"{TOPS} tops in {TOPS} namespaces, {USUAL:g} Hz", tops, seconds)


def _processes(count: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(count, get_context("spawn"))  # as threads of ROS do not survive fork


def _run(options: argparse.Namespace) -> bool:
    print(HEAD)
    outcomes = []
    for outcome in stress(options.seconds):
        print(ROW.format(**asdict(outcome)), flush=True)
        outcomes.append(outcome)
    if options.docs:
        section = format_section(outcomes, options.seconds, describe_conditions("rclpy"))
        publish({NAME: section}, options.docs)
    return all(outcome.good for outcome in outcomes)


def main(args: list[str] | None = None) -> int:
    """Print a line for each load; return the exit status."""
    description = (
        "top_node under five loads, of some seconds each. CPU is in % of one core. "
        "Exit status 1 if a sample was lost or a request was not answered."
    )
    return run_program("stress.py", description, 10.0, _run, args, docs=DOCS)


if __name__ == "__main__":
    sys.exit(main())
