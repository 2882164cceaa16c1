"""A user of a top on another host, who follows its samples, kicks it, and prints what was seen.

Prints a line when samples arrive, waits for a line on its standard input, and ends with one of
JSON. `links` runs it.
"""

import json
import os
import sys
import time
from contextlib import closing
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray

from symtop_ros.ros.client.connection import UnreachableError
from workshop.load.bare import TOPICS
from workshop.load.follower import DEPTH, Subscriber, count_lost, read_stamp

PAUSE = 0.2  # s between two kicks
UNDER_WAY = 3.0  # s for what was sent and has not arrived

Received = list[tuple[int, float]]  # stamp in ns, and seconds from it to the arrival


def read_missed(message: DiagnosticArray) -> int:
    """Return how many samples the node has missed, which are not lost on the link."""
    pairs = (pair for status in message.status for pair in status.values)
    return next(int(pair.value) for pair in pairs if pair.key == "missed")


def follow(rate: float, seconds: float) -> dict[str, Any]:
    """Follow a top for some seconds; return counts, delays in s and the times of kicks in s."""
    received: dict[str, Received] = {name: [] for name in TOPICS}
    with closing(Subscriber(int(os.environ["ROS_DOMAIN_ID"]))) as user:
        for name, kind in TOPICS.items():
            note: Any = partial(_note, received[name])
            user.node.create_subscription(kind, f"/top/{name}", note, DEPTH, raw=True)
        missed: list[int] = []
        user.node.create_subscription(
            DiagnosticArray, "/diagnostics", lambda each: missed.append(read_missed(each)), 100
        )
        user.wait(lambda: bool(missed and all(received.values())), "sample and diagnostics")
        user.connection.request("hurry_precession")
        print("ready", flush=True)
        sys.stdin.readline()
        for each in received.values():
            each.clear()
        before = missed[-1]
        kicks = _kick(user, seconds)
        user.spin(UNDER_WAY)
    stamps = ([stamp for stamp, _ in each] for each in received.values())
    gaps = sum(count_lost(each, round(1e9 / rate)) for each in stamps)
    return {
        "lost": max(0, gaps - len(received) * (missed[-1] - before)),
        "count": sum(map(len, received.values())),
        "delays": [delay for each in received.values() for _, delay in each],
        "kicks": kicks,
    }


def _kick(user: Subscriber, seconds: float) -> list[float]:
    """Kick again and again; return the times in s until the answers."""
    kicks = []
    end = time.monotonic() + seconds
    while (began := time.monotonic()) < end:
        user.connection.request("hurry_precession")
        kicks.append(time.monotonic() - began)
        user.spin(PAUSE)
    return kicks


def _note(received: Received, data: bytes) -> None:
    stamp = read_stamp(data)
    received.append((stamp, (time.time_ns() - stamp) * 1e-9))


if __name__ == "__main__":
    try:
        print(json.dumps(follow(float(sys.argv[1]), float(sys.argv[2]))), flush=True)
    except UnreachableError as error:
        sys.exit(f"link_user: {error}")
