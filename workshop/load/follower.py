"""A subscriber to a node in a separate process, which counts the samples that are lost."""

from __future__ import annotations

import struct

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.client.connection import Connection, UnreachableError
from workshop.load.processes import domain

TIMEOUT = 30.0  # s for a node to start, and to answer
DEPTH = 5000  # samples in the queue while the follower is busy


class Follower:
    """Counts the orientations that a node publishes, and reads its diagnostics.

    Attributes
    ----------
    connection : Connection
        Client for requests.
    samples : int
        Orientations received.
    lost : int
        Orientations that were published and not received, by the latest diagnostics.
    balance : float
        Largest imbalance of energy in J, as the node reports it.
    """

    def __init__(self, rate: float, name: str = "/top") -> None:
        self._rate, self._context = rate, rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain())
        self.node = rclpy.create_node("follower", context=self._context, enable_rosout=False)
        self.connection = Connection(self.node, name, timeout=TIMEOUT)
        self.node.create_subscription(
            QuaternionStamped, f"{name}/orientation", self._receive, DEPTH, raw=True
        )
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._read_diagnostics, 100)
        self._facts: dict[str, str] = {}
        self._reset_counts()

    def close(self) -> None:
        """Leave the domain."""
        rclpy.shutdown(context=self._context)

    def begin(self) -> None:
        """Wait for a sample and for diagnostics, and count from then on.

        The counts of the node up to here must be known: samples that it missed before would
        otherwise hide samples that are lost later.

        Raises
        ------
        UnreachableError
            If nothing comes in time.
        """
        self._facts, self.samples = {}, 0
        if not self.connection.spin_until(lambda: bool(self.samples and self._facts), TIMEOUT):
            msg = f"no sample and diagnostics from {self.connection.name} within {TIMEOUT:g} s"
            raise UnreachableError(msg)
        self._reset_counts()

    def _reset_counts(self) -> None:
        self.samples, self.lost, self.balance = 0, 0, 0.0
        self._gaps, self._stamp, self._missed_before = 0, 0, self.fact("missed")

    def spin(self, seconds: float) -> None:
        """Receive for some seconds."""
        self.connection.spin_until(lambda: False, seconds)

    def fact(self, name: str) -> int:
        """Return a count from the diagnostics; 0 before the first of them."""
        return int(self._facts.get(name, 0))

    @property
    def missed(self) -> int:
        """Samples that the node reports as missed."""
        return self.fact("missed") - self._missed_before

    def _receive(self, data: bytes) -> None:
        seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
        stamp = seconds * 1_000_000_000 + nanoseconds
        if self._stamp:
            self._gaps += round((stamp - self._stamp) * 1e-9 * self._rate) - 1
        self._stamp = stamp
        self.samples += 1

    def _read_diagnostics(self, message: DiagnosticArray) -> None:
        facts = {pair.key: pair.value for status in message.status for pair in status.values}
        if facts["name"] != self.connection.name:  # all nodes of a domain share the topic
            return
        self._facts = facts
        # Both counts belong to one moment here. Later, gaps that the node reports only with its
        # next diagnostics would be taken for lost samples.
        self.lost = max(0, self._gaps - self.missed)
        self.balance = max(self.balance, abs(float(self._facts["energy.balance"])))
