"""`top_judge --live`: estimates on a topic, judged while the top runs."""

import argparse
import json
import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.base.shutdown import describe_failure, ros_context, spin_until
from symtop_ros.run.simulation.events import decode_events
from symtop_ros.run.simulation.topics import DEFAULT_NAME, EVENTS, Topic
from symtop_ros.run.wire.names import full_name
from symtop_ros.truth.judge.compare import Errors, compare
from symtop_ros.truth.judge.estimates import decode_estimates
from symtop_ros.truth.judge.judgement import summarize, tell_limit
from symtop_ros.truth.judge.truth import Truth

PERIOD = 1.0  # s between two lines
PATIENCE = 5.0  # s for the topic to be found
LATCHED = QoSProfile(depth=EVENTS.depth, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
# Best effort hears every publisher. 2000 messages are a second of the fastest node.
BEST_EFFORT = QoSProfile(depth=2000, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class Court:
    """Collects the events of a top and the estimates, and compares them."""

    def __init__(self, node: Node, top: str, topic: str, kind: str, frame: str | None) -> None:
        self.truth = Truth()
        self._kind, self._frame = kind, frame
        self._new: list[bytes] = []
        self._waiting: list[bytes] = []
        node.create_subscription(
            EVENTS.load_message_class(), EVENTS.resolve(top), self._hear, LATCHED, raw=True
        )
        message_class = Topic(topic, kind).load_message_class()
        node.create_subscription(message_class, topic, self._new.append, BEST_EFFORT, raw=True)

    def judge(self) -> Errors | None:
        """Return the errors of the estimates of the second before the last; None without any.

        They wait for a second because the event of a kick may arrive after the estimates of the
        motion that follows from it.
        """
        due, self._waiting = self._waiting, self._new[:]
        self._new.clear()
        if not due or self.truth.begin is None:
            return None
        errors = compare(decode_estimates(self._kind, due, self._frame), self.truth)
        return errors if len(errors.total) else None

    def _hear(self, data: bytes) -> None:
        for event in decode_events(data):
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
                errors = court.judge()
                worst = max(worst, float(errors.total.max()) if errors else 0.0)
                print(_dump(errors) if options.json else _format(errors, court.truth), flush=True)
    except ExternalShutdownException:
        pass
    except RefusedError:
        raise
    except Exception as error:
        print(f"top_judge: {describe_failure(error)}", file=sys.stderr)
        return 1
    return tell_limit(worst, limit, "was")


def _find_type(executor: SingleThreadedExecutor, node: Node, topic: str) -> str:
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        if found := dict(node.get_topic_names_and_types()).get(topic):
            return str(found[0])
        spin_until(executor, time.monotonic() + 0.1)
    raise RefusedError(f"--topic must be a topic that is published, got {one_line(topic)}")


def _dump(errors: Errors | None) -> str:
    """Return the figures of a second as a line of JSON."""
    values = errors.quantities if errors else {}
    facts = {name: summarize(each) for name, each in values.items() if name != "heading"}
    return json.dumps({"estimates": len(errors.total) if errors else 0, **facts})


def _format(errors: Errors | None, truth: Truth) -> str:
    if errors is None:
        return "no estimates" if truth.begin is not None else "no events of the top"
    rms = summarize(errors.total)["rms"]
    rate = errors.rate
    return (
        f"{len(errors.total)} estimates: attitude {rms:.2e} rad rms, "
        f"{errors.total.max():.2e} at most, tilt {errors.tilt.max():.2e}"
        f"{'' if rate is None else f', angular velocity {rate.max():.2e} rad/s'}"
    )
