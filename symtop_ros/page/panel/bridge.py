"""A running node behind the page: its news to the pages, their acts to it.

Needs ROS. The page computes all else from the events, as it does for its own top.
"""

import contextlib
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rclpy
from geometry_msgs.msg import Vector3, Wrench, WrenchStamped
from rclpy.callback_groups import CallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

from symtop_ros.base.refusals import RefusedError, choice, to_double, vector
from symtop_ros.page.panel.held import HeldTorque
from symtop_ros.page.panel.news import PERIOD, Message, News, Sample
from symtop_ros.ros.client.connection import Connection, UnreachableError
from symtop_ros.ros.live.feed import DEPTH, Feed
from symtop_ros.run.simulation.settings import MAX_MOMENT
from symtop_ros.run.simulation.topics import STATE_TOPICS

DRAWN = "orientation"  # topic of the samples that are drawn
PARAMETERS = "set_parameters_atomically"
SERVICES = (
    "set_initial_conditions",
    "kick",
    "release",
    "clamp",
    "step",
    "reset",
    "pause",
    "record",
    PARAMETERS,
)
TIMEOUT = 3.0  # s for an answer
IDLE = 0.2  # s in which a page is noticed, while none is open


class Polled(CallbackGroup):
    """Group of subscriptions that the executor leaves alone.

    For each message an executor rebuilds its wait set, which takes 20 % CPU (one core) at 200 Hz.
    The bridge takes the messages itself, once for each frame.
    """

    def can_execute(self, entity: Any) -> bool:
        """Return False: the executor does not wait for an entity of this group."""
        return False


class SharedConnection(Connection):
    """A connection whose node is spun by another thread."""

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        """Wait until a condition holds; return False after `timeout` seconds."""
        deadline = time.monotonic() + timeout
        while not done() and time.monotonic() < deadline:
            time.sleep(0.002)
        return done()


class Bridge:
    """A node for the pages. Methods may be called from any thread."""

    def __init__(self, node: Node, name: str, timeout: float = TIMEOUT) -> None:
        self._connection = SharedConnection(node, name, timeout)  # s
        self.name = self._connection.name
        self._connection.prepare(*SERVICES)
        self._torque = node.create_publisher(WrenchStamped, f"{self.name}/applied_torque", 10)
        self._held = HeldTorque()
        self._node = node
        self._feed = Feed(node, self.name, ())
        self._samples: Subscription | None = None
        self._calls = threading.Lock()
        self.news = News(self.name)
        self.follow = self.news.follow
        self._ending = threading.Event()
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    # What pages ask for

    def answer(self, request: Mapping[str, Any]) -> Message:
        """Do what a page asks for; return the answer of the node."""
        try:
            if "torque" in request:
                self._turn(vector("torque", request["torque"], 3, MAX_MOMENT, "N m, world frame"))
                return {"granted": True, "answer": ""}
            if "hold" in request:
                self._held.renew()
                return {"granted": True, "answer": ""}
            name = choice("service", request.get("service"), SERVICES)
            argument = request.get("argument")
            if argument is not None and not isinstance(argument, dict | bool):
                raise RefusedError(f"argument must be named values, true or false, for {name}")
            if isinstance(argument, dict) and None in argument.values():  # ROS would read it as 0
                raise RefusedError(
                    "argument must have numbers, words and lists of numbers, got null"
                )
            with self._calls:  # one at a time: two pages may ask at once
                granted, text = self._connection.request(name, _to_doubles(argument))
        except (RefusedError, UnreachableError) as error:
            granted, text = False, str(error)
        except (TypeError, ValueError, AttributeError) as error:  # a value that ROS has no type for
            granted, text = (
                False,
                f"argument must have numbers, words and lists of numbers: {error}",
            )
        return {"granted": granted, "answer": text}

    def _turn(self, torque: Sequence[float]) -> None:
        """Apply the torque of a button; zero ends it at once."""
        self._held.take(torque)
        self._publish_torque(torque)

    def _publish_torque(self, torque: Sequence[float]) -> None:
        x, y, z = torque
        self._torque.publish(WrenchStamped(wrench=Wrench(torque=Vector3(x=x, y=y, z=z))))

    # The thread of the node

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            while rclpy.ok(context=self._node.context) and not self._ending.is_set():
                self._executor.spin_once(timeout_sec=PERIOD if self.news.pages else IDLE)
                self._subscribe(self.news.pages > 0)
                self._take()
                if torque := self._held.find_due():
                    self._publish_torque(torque)

    def _subscribe(self, wanted: bool) -> None:
        """Subscribe to the samples while a page is open; an unwatched node sends events only."""
        if wanted and self._samples is None:
            topic = STATE_TOPICS[DRAWN]
            self.news.expect()
            self._samples = self._node.create_subscription(
                topic.load_message_class(),
                topic.resolve(self.name),
                lambda _: None,
                DEPTH,
                callback_group=Polled(),
                raw=True,
            )
        elif not wanted and self._samples is not None:
            self._node.destroy_subscription(self._samples)
            self._samples = None

    def _take(self) -> None:
        """Take what has arrived, of the samples the last one, and let the pages know."""
        if (data := self._take_sample()) is not None:
            self._feed.receive(DRAWN, data)
        batch = self._feed.batch()
        columns = batch.columns.get(DRAWN)
        sample: Sample | None = None
        if columns:
            sample = int(columns.stamps[-1]), columns.numbers[-1].tolist()
        events = [event for _, event in batch.events]
        self.news.tell(events, sample, is_expected=self._samples is not None)

    def _take_sample(self) -> bytes | None:
        """Return the newest sample that has arrived, without the executor."""
        newest = None
        while samples := self._samples:
            with samples.handle:
                taken = samples.handle.take_message(samples.msg_type, True)
            if taken is None:
                break
            newest = taken[0]
        return newest

    def close(self) -> None:
        """End the thread and all pages. The node keeps running."""
        self.news.close()
        self._ending.set()
        self._thread.join(timeout=2.0)
        self._executor.shutdown(timeout_sec=0.0)


def _to_doubles(value: Any) -> Any:
    """Return a value with doubles for integers: JSON writes 200.0 as 200, and ROS is strict."""
    if isinstance(value, dict):
        return {name: _to_doubles(each) for name, each in value.items()}
    if isinstance(value, list):
        return [_to_doubles(each) for each in value]
    return to_double(value) if isinstance(value, int) and not isinstance(value, bool) else value
