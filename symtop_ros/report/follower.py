"""Somebody who follows a node in another process, and counts what is lost on the way."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.report.processes import domain

PATIENCE = 30.0  # s for a node to start, and to answer
DEPTH = 5000  # samples that wait while the follower is busy


class Follower:
    """Counts the orientations of a node, and notes its diagnostics.

    Attributes
    ----------
    connection : Connection
        For requests.
    samples, missed : int
        Orientations that came, and those that the node says it had no time for.
    balance : float
        Largest part of the energy, in J, that neither friction nor a kick explains.
    """

    def __init__(self, rate: float, name: str = "/top") -> None:
        self._rate, self._context = rate, rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain())
        self.node = rclpy.create_node("follower", context=self._context, enable_rosout=False)
        self.connection = Connection(self.node, name, timeout=PATIENCE)
        self.node.create_subscription(
            QuaternionStamped, f"{name}/orientation", self._take, DEPTH, raw=True
        )
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._note, 10)
        self._facts: dict[str, str] = {}
        self._forget()

    def close(self) -> None:
        """Leave the domain."""
        rclpy.shutdown(context=self._context)

    def begin(self) -> None:
        """Wait for the node, and count from here."""
        if not self.connection.spin_until(lambda: self.samples > 0, PATIENCE):
            msg = f"no sample came within {PATIENCE:g} s"
            raise UnreachableError(msg)
        self._forget()

    def _forget(self) -> None:
        self.samples, self.balance = 0, 0.0
        self._gaps, self._stamp, self._missed_before = 0, 0, self.fact("missed")

    def spin(self, seconds: float) -> None:
        """Listen."""
        self.connection.spin_until(lambda: False, seconds)

    def fact(self, name: str) -> int:
        """Return a count from the diagnostics; 0 before they come."""
        return int(self._facts.get(name, 0))

    @property
    def missed(self) -> int:
        """Samples that the node had no time for."""
        return self.fact("missed") - self._missed_before

    @property
    def lost(self) -> int:
        """Samples that were published and did not come."""
        return max(0, self._gaps - self.missed)

    def _take(self, data: bytes) -> None:
        seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
        stamp = seconds * 1_000_000_000 + nanoseconds
        if self._stamp:
            self._gaps += round((stamp - self._stamp) * 1e-9 * self._rate) - 1
        self._stamp = stamp
        self.samples += 1

    def _note(self, message: DiagnosticArray) -> None:
        self._facts.update((pair.key, pair.value) for s in message.status for pair in s.values)
        self.balance = max(self.balance, abs(float(self._facts["energy.balance"])))


def request(connection: Connection, service: str, values: Mapping[str, Any] | bool | None) -> bool:
    """Ask for something; return whether it was granted."""
    if values is None:
        return connection.trigger(service)[0]
    if isinstance(values, bool):
        return connection.switch(service, values)[0]
    return connection.set(service, values)[0]
