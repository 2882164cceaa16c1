"""A subscriber on each of the five topics of a node in a separate process."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from symtop_ros.arrays import Real
from symtop_ros.client.connection import UnreachableError
from workshop.load.bare import LATCHED, TOPICS
from workshop.load.usage import cpu_seconds

TIMEOUT = 30.0  # s until every topic has a sample, and for an answer
SETTLING = 1.0  # s


class Traffic(NamedTuple):
    """The samples received from a node, and their cost.

    Attributes
    ----------
    sent : ndarray (n,)
        Times at which the samples of the first topic were published, s.
    arrived : float
        Fraction of the samples between the first and the last stamp; the lowest of all topics.
    messages : int
        Number on all topics.
    cpu : float
        User and system time of the node's process, s.
    """

    sent: Real
    arrived: float
    messages: int
    cpu: float


class Listener:
    """Subscribes to the node /top in a domain, and waits until every topic has a sample.

    Raises
    ------
    UnreachableError
        If a sample or an answer does not come in time.
    """

    def __init__(self, domain: int) -> None:
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self._node = rclpy.create_node("listener", context=self._context)
        self._got: dict[str, list[bytes]] = {name: [] for name in TOPICS}
        self._sent: list[int] = []
        for name, kind in TOPICS.items():
            receive: Any = self._receive if name == "orientation" else self._got[name].append
            self._node.create_subscription(kind, f"/top/{name}", receive, 1000, raw=True)
        self._events: list[DiagnosticArray] = []
        self._node.create_subscription(DiagnosticArray, "/top/events", self._events.append, LATCHED)
        self._kick: Any = self._node.create_client(Trigger, "/top/hurry_precession")
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._wait(lambda: all(self._got.values()))
        self._spin(SETTLING)

    def close(self) -> None:
        """Leave the domain."""
        rclpy.shutdown(context=self._context)

    def listen(self, pid: int, rate: float, seconds: float) -> Traffic:
        """Receive for some seconds from the node with this process id and publish rate (Hz)."""
        self._clear()
        cpu = cpu_seconds(pid)
        self._spin(seconds)
        cpu = cpu_seconds(pid) - cpu
        arrived = min(_arrived(messages, rate) for messages in self._got.values())
        count = sum(map(len, self._got.values()))
        return Traffic(np.array(self._sent) * 1e-9, arrived, count, cpu)

    def kick(self, pause: float) -> float:
        """Kick after a pause (s); return the time in s until the first sample of the new motion.

        The time runs from the request to the moment at which that sample is published.
        """
        self._spin(pause)
        self._events.clear()
        asked = time.time()
        answer = self._kick.call_async(Trigger.Request())
        self._wait(lambda: answer.done() and bool(self._events))
        stamp = self._events[-1].header.stamp
        begin = stamp.sec + stamp.nanosec * 1e-9
        orientations = self._got["orientation"]
        self._wait(lambda: _stamp(orientations[-1]) >= begin)
        first = next(k for k, data in enumerate(orientations) if _stamp(data) >= begin)
        latency = self._sent[first] * 1e-9 - asked
        self._clear()
        return latency

    def _clear(self) -> None:
        self._sent.clear()
        for messages in self._got.values():
            messages.clear()

    def _receive(self, data: bytes, info: dict[str, Any]) -> None:
        self._got["orientation"].append(data)
        self._sent.append(info["source_timestamp"])

    def _wait(self, done: Callable[[], bool]) -> None:
        self._spin(TIMEOUT, done)
        if not done():
            msg = f"no answer from /top within {TIMEOUT:g} s"
            raise UnreachableError(msg)

    def _spin(self, seconds: float, done: Callable[[], bool] = lambda: False) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end and not done():
            self._executor.spin_once(timeout_sec=0.1)


def _arrived(messages: list[bytes], rate: float) -> float:
    """Return the fraction of the samples between the first and the last stamp."""
    if not messages:
        return 0.0
    seconds = _stamp(messages[-1]) - _stamp(messages[0])
    return len(messages) / float(round(seconds * rate) + 1)


def _stamp(message: bytes) -> float:
    """Return the stamp in s of a serialised message that begins with a header."""
    seconds, nanoseconds = struct.unpack_from("<iI", message, 4)
    return float(seconds + nanoseconds * 1e-9)
