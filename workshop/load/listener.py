"""A subscriber on each of the five topics of a node in a separate process."""

import time
from typing import Any, NamedTuple

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Trigger

from symtop_ros.base.arrays import Real
from workshop.load.bare import LATCHED, TOPICS
from workshop.load.follower import Subscriber, read_stamp, to_nanoseconds
from workshop.load.processes import cpu_seconds

SETTLING = 1.0  # s


class Traffic(NamedTuple):
    """The samples received from a node, and their cost.

    Attributes
    ----------
    sent : ndarray (n,)
        Times at which the samples of the first topic were published, s.
    arrived : float
        Fraction of the samples between the first and the last stamp; the lowest of all topics.
    cpu : float
        User and system time of the node's process, s.
    """

    sent: Real
    arrived: float
    cpu: float


class Listener(Subscriber):
    """Subscribes to the node /top in a domain, and waits until every topic has a sample.

    Raises
    ------
    UnreachableError
        If a sample or an answer does not come in time.
    """

    def __init__(self, domain: int) -> None:
        super().__init__(domain)
        self._got: dict[str, list[bytes]] = {name: [] for name in TOPICS}
        self._sent: list[int] = []
        for name, kind in TOPICS.items():
            receive: Any = self._receive if name == "orientation" else self._got[name].append
            self.node.create_subscription(kind, f"/top/{name}", receive, 1000, raw=True)
        self._events: list[DiagnosticArray] = []
        self.node.create_subscription(DiagnosticArray, "/top/events", self._events.append, LATCHED)
        self._kick: Any = self.node.create_client(Trigger, "/top/hurry_precession")
        self.wait(lambda: all(self._got.values()), "answer")
        self.spin(SETTLING)

    def listen(self, pid: int, rate: float, seconds: float) -> Traffic:
        """Receive for some seconds from the node with this process id and publish rate (Hz)."""
        self._clear()
        cpu = cpu_seconds(pid)
        self.spin(seconds)
        cpu = cpu_seconds(pid) - cpu
        arrived = min(_arrived(messages, rate) for messages in self._got.values())
        return Traffic(np.array(self._sent) * 1e-9, arrived, cpu)

    def kick(self, pause: float) -> float:
        """Kick after a pause (s); return the time in s until the first sample of the new motion.

        The time runs from the request to the moment at which that sample is published.
        """
        self.spin(pause)
        self._events.clear()
        asked = time.time()
        answer = self._kick.call_async(Trigger.Request())
        self.wait(lambda: answer.done() and bool(self._events), "answer")
        begin = to_nanoseconds(self._events[-1].header.stamp)
        orientations = self._got["orientation"]
        self.wait(lambda: read_stamp(orientations[-1]) >= begin, "answer")
        first = next(k for k, data in enumerate(orientations) if read_stamp(data) >= begin)
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


def _arrived(messages: list[bytes], rate: float) -> float:
    """Return the fraction of the samples between the first and the last stamp."""
    if not messages:
        return 0.0
    seconds = 1e-9 * (read_stamp(messages[-1]) - read_stamp(messages[0]))
    return len(messages) / float(round(seconds * rate) + 1)
