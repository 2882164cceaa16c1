"""A subscriber on each of the five topics of a node in a separate process.

It must not take the processor from the node that it measures. With a callback for each message it
took 0.8 of a core at 1000 Hz; so the samples stay in the queues of the middleware, which notes when
each was published, and are taken from there from time to time.
"""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Trigger

from symtop_ros.base.arrays import Real
from symtop_ros.ros.client.connection import UnreachableError
from workshop.load.bare import LATCHED, TOPICS
from workshop.load.follower import TIMEOUT, Subscriber, read_stamp, to_nanoseconds
from workshop.load.processes import cpu_seconds

SETTLING = 1.0  # s
DEPTH = 1000  # samples of a topic in the queue
LOOK = 0.05  # s between two looks into the queues while nothing else is awaited
LOOK_SOON = 1e-3  # s, while a sample is awaited


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
        # No executor spins this node: nothing runs when a sample comes.
        self._quiet = rclpy.create_node("samples", context=self.node.context, enable_rosout=False)
        self._queues: dict[str, Any] = {
            name: self._quiet.create_subscription(kind, f"/top/{name}", print, DEPTH, raw=True)
            for name, kind in TOPICS.items()
        }
        self._got: dict[str, list[bytes]] = {name: [] for name in TOPICS}
        self._sent: list[int] = []  # times in ns at which the orientations were published
        self._events: list[DiagnosticArray] = []
        self.node.create_subscription(DiagnosticArray, "/top/events", self._events.append, LATCHED)
        self._kick: Any = self.node.create_client(Trigger, "/top/hurry_precession")
        self._await(lambda: all(self._got.values()))
        self.spin(SETTLING)

    def close(self) -> None:
        """Leave the domain."""
        self._quiet.destroy_node()
        super().close()

    def spin(self, seconds: float) -> None:
        """Let samples come for some seconds."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            time.sleep(min(left, LOOK))
            self._take()

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
        self._await(lambda: bool(orientations) and read_stamp(orientations[-1]) >= begin)
        first = next(k for k, data in enumerate(orientations) if read_stamp(data) >= begin)
        latency = self._sent[first] * 1e-9 - asked
        self._clear()
        return latency

    def _clear(self) -> None:
        self._sent.clear()
        for messages in self._got.values():
            messages.clear()

    def _await(self, done: Callable[[], bool]) -> None:
        end = time.monotonic() + TIMEOUT
        while not done():
            if time.monotonic() > end:
                raise UnreachableError(
                    f"no sample from {self.connection.name} within {TIMEOUT:g} s"
                )
            time.sleep(LOOK_SOON)
            self._take()

    def _take(self) -> None:
        """Take all samples out of the queues."""
        for name, queue in self._queues.items():
            while (taken := queue.handle.take_message(queue.msg_type, True)) is not None:
                data, info = taken
                self._got[name].append(data)
                if name == "orientation":
                    self._sent.append(info["source_timestamp"])


def _arrived(messages: list[bytes], rate: float) -> float:
    """Return the fraction of the samples between the first and the last stamp."""
    if not messages:
        return 0.0
    seconds = 1e-9 * (read_stamp(messages[-1]) - read_stamp(messages[0]))
    return len(messages) / float(round(seconds * rate) + 1)
