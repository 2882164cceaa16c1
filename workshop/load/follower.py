"""Subscribers to a node in a separate process, and the clients of the stress test.

One of the subscribers counts the samples that are lost. Each client runs in a separate process.
"""

import struct
import time
from collections.abc import Callable, Iterable
from contextlib import closing
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.ros.client.connection import Connection, UnreachableError
from workshop.load.bare import LATCHED
from workshop.load.processes import domain

TIMEOUT = 300.0  # s; ends what hangs: on a core that busy programs share a start may take a minute
DEPTH = 5000  # samples in the queue while the follower is busy
SUBSCRIBED_RATE = 200.0  # Hz, of the top that `subscribe` follows
CALLS: tuple[tuple[str, Any], ...] = (
    ("hurry_precession", None),
    ("get_state", None),
    ("kick", {"precession_rate_change": float("nan")}),  # refused
    ("reset", None),
)


def read_stamp(data: bytes) -> int:
    """Return the stamp in ns of a serialised message that begins with a header."""
    seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
    return int(seconds * 1_000_000_000 + nanoseconds)


def count_lost(stamps: Iterable[int], period: int) -> int:
    """Return how many stamps of a grid (period in ns) are missing between those that arrived."""
    steps = (after - before for before, after in pairwise(sorted(stamps)))
    return sum(max(0, round(step / period) - 1) for step in steps)


def to_nanoseconds(stamp: Any) -> int:
    """Return a time of a message in ns."""
    return int(stamp.sec * 1_000_000_000 + stamp.nanosec)


class Subscriber:
    """A node of a load in a domain, with a connection to a top."""

    def __init__(self, domain: int, name: str = "/top") -> None:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain)
        self.node = rclpy.create_node("load", context=context, enable_rosout=False)
        self.connection = Connection(self.node, name, timeout=TIMEOUT)

    def close(self) -> None:
        """Leave the domain.

        A node that is not destroyed keeps its participant, whose subscriptions receive the samples
        of every node that is measured later.
        """
        self.node.destroy_node()
        rclpy.shutdown(context=self.node.context)

    def spin(self, seconds: float) -> None:
        """Receive for some seconds."""
        self.connection.spin_until(lambda: False, seconds)

    def wait(self, done: Callable[[], bool], wanted: str, timeout: float = TIMEOUT) -> None:
        """Receive until a condition holds; UnreachableError if it does not in time (s)."""
        if not self.connection.spin_until(done, timeout):
            raise UnreachableError(f"no {wanted} from {self.connection.name} within {timeout:g} s")


class Follower(Subscriber):
    """Counts the orientations that a node publishes, and reads its diagnostics.

    Attributes
    ----------
    samples : int
        Orientations received.
    lost : int
        Orientations that were published and not received, by the latest diagnostics.
    balance : float
        Largest imbalance of energy in J, as the node reports it.
    """

    def __init__(self, rate: float, name: str = "/top") -> None:
        super().__init__(domain(), name)
        self._rate = rate
        self.node.create_subscription(
            QuaternionStamped, f"{name}/orientation", self.receive, DEPTH, raw=True
        )
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self.read_diagnostics, 100)
        self._facts: dict[str, str] = {}
        self.reset_counts()

    def begin(self) -> None:
        """Wait for a sample and for diagnostics, and count from then on.

        The counts of the node up to here must be known: samples that it missed before would
        otherwise hide samples that are lost later.

        Raises
        ------
        UnreachableError
            If nothing comes in time.
        """
        self._facts = {}
        self.samples = 0
        self.wait(lambda: bool(self.samples and self._facts), "sample and diagnostics")
        self.reset_counts()

    def reset_counts(self) -> None:
        """Count from now on."""
        self.samples, self.lost, self.balance = 0, 0, 0.0
        self._gaps: dict[int, int] = {}  # samples that did not come, by the stamp of the next one
        self._stamp = 0
        self._missed_before = self.fact("missed")

    def fact(self, name: str) -> int:
        """Return a count from the diagnostics; 0 before the first of them."""
        return int(self._facts.get(name, 0))

    @property
    def missed(self) -> int:
        """Samples that the node reports as missed."""
        return self.fact("missed") - self._missed_before

    def receive(self, data: bytes) -> None:
        """Count an encoded sample, and those between it and the one before."""
        stamp = read_stamp(data)
        if self._stamp and (gap := round((stamp - self._stamp) * 1e-9 * self._rate) - 1):
            self._gaps[stamp] = gap
        self._stamp = stamp
        self.samples += 1

    def read_diagnostics(self, message: DiagnosticArray) -> None:
        """Compare the gaps with what the node reports as missed."""
        facts = {pair.key: pair.value for status in message.status for pair in status.values}
        if facts["name"] != self.connection.name:  # all nodes of a domain share the topic
            return
        self._facts = facts
        # The node counts what it has missed before the stamp of its diagnostics: later gaps are of
        # the next ones.
        until = to_nanoseconds(message.header.stamp)
        gaps = sum(count for stamp, count in self._gaps.items() if stamp < until)
        self.lost = max(0, gaps - self.missed)
        self.balance = max(self.balance, abs(float(self._facts["energy.balance"])))


def call(domain: int, seconds: float) -> dict[str, Any]:
    """Call services as fast as they answer; return the time of each call, and the failures."""
    with closing(Subscriber(domain)) as user:
        user.connection.request("get_state")
        times: list[float] = []
        unanswered = 0
        end = time.monotonic() + seconds
        while (began := time.monotonic()) < end:
            try:
                user.connection.request(*CALLS[len(times) % len(CALLS)])
            except UnreachableError:
                unanswered += 1
            times.append(time.monotonic() - began)
    return {"seconds": times, "unanswered": unanswered}


def subscribe(domain: int, count: int, seconds: float) -> list[int]:
    """Subscribe many times to one topic; return the number of gaps of each subscription."""
    stamps: list[list[int]] = [[] for _ in range(count)]
    with closing(Subscriber(domain)) as user:
        for received in stamps:
            add = partial(_add_stamp, received)
            user.node.create_subscription(QuaternionStamped, "/top/orientation", add, DEPTH)
        user.connection.spin_until(lambda: all(stamps), TIMEOUT)
        user.spin(seconds)
    period = round(1e9 / SUBSCRIBED_RATE)
    # Only nanoseconds within the second are kept, so that a difference is taken modulo 1 s.
    return [int((np.diff(each) % 1_000_000_000 != period).sum()) for each in stamps]


def _add_stamp(stamps: list[int], message: QuaternionStamped) -> None:
    stamps.append(message.header.stamp.nanosec)


def join(domain: int, count: int, events: int) -> list[float]:
    """Subscribe to the latched events, wait for all and leave, many times; return the times."""
    received: list[DiagnosticArray] = []
    times = []
    with closing(Subscriber(domain)) as user:
        for _ in range(count):
            received.clear()
            began = time.monotonic()
            subscription = user.node.create_subscription(
                DiagnosticArray, "/top/events", received.append, LATCHED
            )
            if user.connection.spin_until(lambda: len(received) >= events, TIMEOUT):
                times.append(time.monotonic() - began)
            user.node.destroy_subscription(subscription)
    return times
