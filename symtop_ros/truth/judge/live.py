"""`top_judge --live`: estimates on a topic, judged while the top runs."""

import argparse
import json
import sys
import time
from dataclasses import dataclass

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.base.shutdown import describe_failure, ros_context, spin_until
from symtop_ros.run.simulation.events import decode_events
from symtop_ros.run.simulation.topics import DEFAULT_NAME, EVENTS, Topic
from symtop_ros.run.wire.names import full_name
from symtop_ros.truth.judge.compare import Errors, compare
from symtop_ros.truth.judge.summary import summarize
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.testset.score import enforce_limit
from symtop_ros.truth.topics.estimates import decode_estimates

PERIOD = 1.0  # s between two lines
PATIENCE = 5.0  # s for the topic to be found
LATCHED = QoSProfile(depth=EVENTS.depth, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
# A best-effort subscription is compatible with every publisher. 2000 messages are a second of the
# fastest node.
BEST_EFFORT = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.BEST_EFFORT)
NO_EVENTS = "no events of the top"


@dataclass(frozen=True, eq=False)
class Second:
    """The estimates of a second: those that are left out and why, and errors of the others."""

    left_out: int
    reason: str
    errors: Errors | None = None  # None: there is none

    def dump(self) -> str:
        """Return the figures as a line of JSON."""
        values = self.errors.quantities if self.errors else {}
        facts = {name: summarize(each) for name, each in values.items() if name != "heading"}
        count = len(self.errors.total) if self.errors else 0
        return json.dumps({"estimates": count, "left_out": self.left_out, **facts})

    def format(self) -> str:
        """Return the figures as a line of text."""
        if self.errors is None:
            left_out = f"{write_count(self.left_out, 'estimate')} left out: {self.reason}"
            return left_out if self.left_out else self.reason
        errors = self.errors
        rms = summarize(errors.total)["rms"]
        rate = errors.rate
        more = f" ({self.left_out} left out)" if self.left_out else ""
        return (
            f"{write_count(len(errors.total), 'estimate')}{more}: attitude {rms:.2e} rad rms, "
            f"{errors.total.max():.2e} at most, tilt {errors.tilt.max():.2e}"
            f"{'' if rate is None else f', angular velocity {rate.max():.2e} rad/s'}"
        )


class Court:
    """Collects the events of a top and the estimates, and compares them."""

    def __init__(self, node: Node, top: str, topic: str, kind: str, frame: str | None) -> None:
        self.truth = Truth()
        self._kind, self._frame = kind, frame
        self._new: list[bytes] = []
        self._waiting: list[bytes] = []
        self._has_gone_back = False  # True if the clock of the run has, since the last line
        node.create_subscription(
            EVENTS.load_message_class(), EVENTS.resolve(top), self._hear, LATCHED, raw=True
        )
        message_class = Topic(topic, kind).load_message_class()
        node.create_subscription(message_class, topic, self._new.append, BEST_EFFORT, raw=True)

    def judge(self) -> Second:
        """Return the judgement of the estimates of the second before the last.

        They wait for a second because the event of a kick may arrive after the estimates of the
        motion that follows from it. When the clock goes back, estimates of that second and of the
        second before may belong to either of two motions.
        """
        due, self._waiting = self._waiting, self._new[:]
        self._new.clear()
        if self._has_gone_back:
            due, self._waiting = due + self._waiting, []
        found = decode_estimates(self._kind, due, self._frame)
        count = len(found) + found.left_out
        if self._has_gone_back:
            self._has_gone_back = False
            return Second(count, "the clock of the run went back")
        if not count or self.truth.begin is None:
            return Second(0, "no estimates" if self.truth.begin is not None else NO_EVENTS)
        errors = compare(found, self.truth)
        if len(errors.total):
            return Second(count - len(errors.total), "", errors)
        return Second(count, "their stamps are not within the run, or they have no attitude")

    def _hear(self, data: bytes) -> None:
        for event in decode_events(data):
            latest = self.truth.latest
            is_back = latest is not None and event.stamp < max(latest, event.previous_end)
            self._has_gone_back |= is_back
            self.truth.add(event)


def judge_live(options: argparse.Namespace, arguments: list[str]) -> int:
    """Print a line each second; return 0, or 1 if the attitude was further off than allowed."""
    topic = options.topic[0]
    seconds = options.seconds
    limit = options.max_error
    worst = 0.0
    try:
        with ros_context(arguments) as listen:
            node = rclpy.create_node("top_judge", start_parameter_services=False)
            executor = SingleThreadedExecutor()
            executor.add_node(node)
            listen()
            top = full_name(options.node or DEFAULT_NAME)
            kind = _find_type(executor, node, topic)
            court = Court(node, top, topic, kind, options.frame)
            end = time.monotonic() + (seconds or float("inf"))
            while time.monotonic() < end:
                spin_until(executor, min(end, time.monotonic() + PERIOD))
                found = court.judge()
                worst = max(worst, float(found.errors.total.max()) if found.errors else 0.0)
                print(found.dump() if options.json else found.format(), flush=True)
    except ExternalShutdownException:
        pass
    except RefusedError:
        raise
    except Exception as error:
        print(f"top_judge: {describe_failure(error)}", file=sys.stderr)
        return 1
    enforce_limit(worst, limit, "was")
    return 0


def _find_type(executor: SingleThreadedExecutor, node: Node, topic: str) -> str:
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        if found := dict(node.get_topic_names_and_types()).get(topic):
            return str(found[0])
        spin_until(executor, time.monotonic() + 0.1)
    raise RefusedError(f"--topic must be a topic that is published, got {one_line(topic)}")
