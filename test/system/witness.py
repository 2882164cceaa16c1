"""A program on another host: it follows a top as top_live does, kicks it, and says what it saw.

A line `kick` or `report` on its standard input is answered by a line of JSON.
"""

import json
import queue
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from std_msgs.msg import Header

from symtop_ros.live.feed import DEPTH, LATCHED
from symtop_ros.simulation.topics import STATE_TOPICS

TYPES = {name: topic.load_message_class() for name, topic in STATE_TOPICS.items() if name != "tf"}
SECOND = 1_000_000_000
PERIOD = SECOND // 200  # of the samples of a top
KICK = Parameter("precession_rate", value=9.0).to_parameter_msg()


def summarize(samples: list[bytes]) -> dict[str, int]:
    """Count the samples of one topic as they arrived."""
    stamps = [deserialize_message(data, Header).stamp for data in samples]
    steps = [(b.sec - a.sec) * SECOND + b.nanosec - a.nanosec for a, b in pairwise(stamps)]
    lost = sum(step // PERIOD - 1 for step in steps if step > 0)
    return {"count": len(stamps), "lost": lost, "unordered": sum(step <= 0 for step in steps)}


class Witness:
    """Subscribes to all topics of a top."""

    def __init__(self) -> None:
        node = rclpy.create_node("witness")
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._samples: dict[str, list[bytes]] = {name: [] for name in TYPES}
        self._events: list[str] = []
        for name, kind in TYPES.items():
            take = self._samples[name].append
            node.create_subscription(kind, f"/top/{name}", take, DEPTH, raw=True)
        node.create_subscription(DiagnosticArray, "/top/events", self._take_event, LATCHED)
        self._client = node.create_client(SetParametersAtomically, "/top/kick")

    def report(self) -> dict[str, Any]:
        """Return statistics of the received samples by topic."""
        samples = {name: summarize(each) for name, each in self._samples.items() if each}
        return {"samples": samples, "events": self._events}

    def kick(self) -> float:
        """Kick the top, and return how long the answer took."""
        self.spin_until(self._client.service_is_ready)
        asked = time.monotonic()
        future = self._client.call_async(SetParametersAtomically.Request(parameters=[KICK]))
        self.spin_until(future.done)
        assert future.result().result.successful
        return time.monotonic() - asked

    def spin_until(self, done: Callable[[], bool]) -> None:
        while not done():
            self._executor.spin_once(timeout_sec=0.02)

    def _take_event(self, message: DiagnosticArray) -> None:
        self._events.append(message.status[0].name.removeprefix("top: "))


def main() -> None:
    rclpy.init()
    witness = Witness()
    commands = {"kick": witness.kick, "report": witness.report}
    words: queue.Queue[str] = queue.Queue()
    read = partial(iter, sys.stdin.readline, "")
    threading.Thread(target=lambda: [words.put(each) for each in read()], daemon=True).start()
    while True:
        witness.spin_until(lambda: not words.empty())
        print(json.dumps(commands[words.get().strip()]()), flush=True)


if __name__ == "__main__":
    main()
