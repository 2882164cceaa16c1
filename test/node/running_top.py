"""A top and its user in one process: real rclpy and Fast DDS, own context and domain."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Mapping
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import QoSDurabilityPolicy, QoSProfile

from symtop_ros.client.connection import Connection
from symtop_ros.node.top_node import TopNode
from symtop_ros.run.events import Event
from symtop_ros.run.segment import Segment

DOMAINS = itertools.cycle(range(10, 60))  # the programs take 60 to 89, fixed ones are beyond
LATCHED = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
TIMEOUT = 10.0  # s; ends a test that hangs, and is never waited for


class RunningTop:
    """A TopNode and a client node, spun together until a condition holds."""

    def __init__(self, **parameters: Any) -> None:
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=next(DOMAINS))
        overrides = [
            Parameter(name.replace("__", "."), value=value) for name, value in parameters.items()
        ]
        self.top = TopNode(context=self.context, parameter_overrides=overrides)
        self.user = rclpy.create_node("user", context=self.context)
        self.connection = _SharedConnection(self)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.top)
        self.executor.add_node(self.user)

    def close(self) -> None:
        self.executor.shutdown()
        self.user.destroy_node()
        self.top.close()
        self.top.destroy_node()
        rclpy.try_shutdown(context=self.context)

    def spin_until(self, done: Callable[[], Any], timeout: float = TIMEOUT) -> None:
        deadline = time.monotonic() + timeout
        while not done():
            assert time.monotonic() < deadline, "the condition did not come true in time"
            self.executor.spin_once(timeout_sec=0.05)

    def collect(self, kind: Any, topic: str, qos: Any = 1000, raw: bool = False) -> list[Any]:
        """Subscribe, and return the list that messages (or their bytes) come into."""
        messages: list[Any] = []
        self.user.create_subscription(kind, topic, messages.append, qos, raw=raw)
        return messages

    def set(self, service: str, **values: Any) -> tuple[bool, str]:
        return self.connection.set(service, values)

    def trigger(self, service: str) -> tuple[bool, str]:
        return self.connection.trigger(service)

    def switch(self, service: str, on: bool) -> tuple[bool, str]:
        return self.connection.switch(service, on)


class _SharedConnection(Connection):
    """The client's own code, spun together with the node."""

    def __init__(self, running: RunningTop) -> None:
        self.node, self.name, self._timeout, self._running = running.user, "/top", TIMEOUT, running
        self._clients = {}

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        self._running.spin_until(done, timeout)
        return done()


def stamp_of(message: Any) -> int:
    stamp = message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def segment_of(message: Any) -> Segment:
    """The segment that an event announces."""
    return Event(stamp_of(message), message.status[0].name, "", facts(message)).segment()


def facts(message: Any) -> Mapping[str, str]:
    """Keys and values of the first status."""
    return {pair.key: pair.value for pair in message.status[0].values}
