"""The clients of the stress test, each run in a separate process that prints JSON.

`python clients.py NAME DOMAIN ARGUMENT...` runs one of `call`, `subscribe` and `join`.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from rclpy.node import Node

from symtop_ros.client.connection import Connection, UnreachableError
from workshop.load.bare import LATCHED
from workshop.load.follower import DEPTH, TIMEOUT

SUBSCRIBED_RATE = 200.0  # Hz, of the top that `subscribe` follows
CALLS: tuple[tuple[str, Any], ...] = (
    ("hurry_precession", None),
    ("get_state", None),
    ("kick", {"precession_rate_change": float("nan")}),  # refused
    ("reset", None),
)


@contextmanager
def client_node(domain: int) -> Iterator[Node]:
    """Make a node in a domain."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    try:
        yield rclpy.create_node("load", context=context, enable_rosout=False)
    finally:
        rclpy.shutdown(context=context)


def call(domain: int, seconds: float) -> dict[str, Any]:
    """Call services as fast as they answer; return the time of each call, and the failures."""
    with client_node(domain) as node:
        connection = Connection(node, timeout=TIMEOUT)
        connection.request("get_state")
        times: list[float] = []
        unanswered, end = 0, time.monotonic() + seconds
        while (began := time.monotonic()) < end:
            try:
                connection.request(*CALLS[len(times) % len(CALLS)])
            except UnreachableError:
                unanswered += 1
            times.append(time.monotonic() - began)
    return {"seconds": times, "unanswered": unanswered}


def subscribe(domain: int, count: float, seconds: float) -> list[int]:
    """Subscribe many times to one topic; return the number of gaps of each subscription."""
    stamps: list[list[int]] = [[] for _ in range(int(count))]
    with client_node(domain) as node:
        connection = Connection(node)
        for received in stamps:
            add = partial(_add_stamp, received)
            node.create_subscription(QuaternionStamped, "/top/orientation", add, DEPTH)
        connection.spin_until(lambda: all(stamps), TIMEOUT)
        connection.spin_until(lambda: False, seconds)
    period = round(1e9 / SUBSCRIBED_RATE)
    # Only nanoseconds within the second are kept, so that a difference is taken modulo 1 s.
    return [int((np.diff(each) % 1_000_000_000 != period).sum()) for each in stamps]


def _add_stamp(stamps: list[int], message: QuaternionStamped) -> None:
    stamps.append(message.header.stamp.nanosec)


def join(domain: int, count: float, events: float) -> list[float]:
    """Subscribe to the latched events, wait for all and leave, many times; return the times."""
    received: list[DiagnosticArray] = []
    times = []
    with client_node(domain) as node:
        connection = Connection(node)
        for _ in range(int(count)):
            received.clear()
            began = time.monotonic()
            subscription = node.create_subscription(
                DiagnosticArray, "/top/events", received.append, LATCHED
            )
            if connection.spin_until(lambda: len(received) >= events, TIMEOUT):
                times.append(time.monotonic() - began)
            node.destroy_subscription(subscription)
    return times


CLIENTS: dict[str, Callable[..., Any]] = {"call": call, "subscribe": subscribe, "join": join}

if __name__ == "__main__":
    name, domain_id, *numbers = sys.argv[1:]
    print(json.dumps(CLIENTS[name](int(domain_id), *map(float, numbers))))
