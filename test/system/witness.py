"""A program on another host: it follows a top as top_live does, kicks it, and says what it saw.

A line `kick` or `report` on its standard input is answered by a line of JSON.
"""

import json
import os
import queue
import sys
import threading
import time
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter

sys.path += [str(each) for each in Path(__file__).parents[1:3]]
from ros.node.listener import Listener

from symtop_ros.ros.live.feed import DEPTH, LATCHED
from symtop_ros.run.simulation.topics import STATE_TOPICS
from workshop.load.follower import count_lost, read_stamp

PERIOD = 1_000_000_000 // 200  # ns between two samples of a top
KICK = Parameter("precession_rate", value=9.0).to_parameter_msg()


def summarize(samples: list[bytes]) -> dict[str, int]:
    """Count the samples of one topic as they arrived."""
    stamps = [*map(read_stamp, samples)]
    unordered = sum(after <= before for before, after in pairwise(stamps))
    return {"count": len(stamps), "lost": count_lost(stamps, PERIOD), "unordered": unordered}


class Witness(Listener):
    """Subscribes to all topics of a top."""

    def __init__(self) -> None:
        super().__init__(int(os.environ["ROS_DOMAIN_ID"]), "witness")
        kinds = {n: topic.load_message_class() for n, topic in STATE_TOPICS.items() if n != "tf"}
        self._samples = {n: self.collect(kinds[n], f"/top/{n}", DEPTH, raw=True) for n in kinds}
        self._events = self.collect(DiagnosticArray, "/top/events", LATCHED)
        self._diagnostics = self.collect(DiagnosticArray, "/diagnostics", 100)
        self._client = self.node.create_client(SetParametersAtomically, "/top/kick")

    def report(self) -> dict[str, Any]:
        """Return statistics of the samples by topic, the events, and what the node has missed."""
        samples = {name: summarize(each) for name, each in self._samples.items() if each}
        events = [each.status[0].name.removeprefix("top: ") for each in self._events]
        statuses = [status for each in self._diagnostics[-1:] for status in each.status]
        pairs = {pair.key: pair.value for status in statuses for pair in status.values}
        return {"samples": samples, "events": events, "missed": int(pairs.get("missed", 0))}

    def kick(self) -> float:
        """Kick the top, and return how long the answer took."""
        self.spin_until(self._client.service_is_ready)
        asked = time.monotonic()
        future = self._client.call_async(SetParametersAtomically.Request(parameters=[KICK]))
        self.spin_until(future.done)
        assert future.result().result.successful
        return time.monotonic() - asked


def main() -> None:
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
