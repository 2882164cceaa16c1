"""A running node as the top of the page: its topics and services. Needs ROS."""

import contextlib
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import rclpy
from geometry_msgs.msg import WrenchStamped
from rclpy.callback_groups import CallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.subscription import Subscription

from symtop_ros.arrays import Vector
from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.live.feed import DEPTH, Feed
from symtop_ros.log.batch import Batch
from symtop_ros.panel.source import Argument
from symtop_ros.session.session import Answer
from symtop_ros.simulation.topics import STATE_TOPICS
from symtop_ros.web.run import DRAWN

USED = ("set_initial_conditions", "kick", "step", "reset", "pause", "record")
PARAMETERS = "set_parameters_atomically"
TIMEOUT = 3.0  # s for an answer
SILENCE = 2.0  # s without samples after which the page says so


class Polled(CallbackGroup):
    """Group of subscriptions that the executor leaves alone.

    For each message an executor rebuilds its wait set, which takes 20 % CPU (one core) at 200 Hz.
    The page takes the messages itself, once for each frame.
    """

    def can_execute(self, entity: Any) -> bool:
        """Return False: the executor does not wait for an entity of this group."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Return False, as nothing is executed."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Do nothing, as nothing is executed."""


class SharedConnection(Connection):
    """A connection whose node is spun by another thread."""

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        """Wait until a condition holds; return False after `timeout` seconds."""
        deadline = time.monotonic() + timeout
        while not done() and time.monotonic() < deadline:
            time.sleep(0.002)
        return done()


class NodeTop:
    """A running node; see `Source` for the methods."""

    is_own = False

    def __init__(self, node: Node, name: str) -> None:
        self._connection = SharedConnection(node, name, TIMEOUT)
        self.name = self._connection.name
        self._connection.prepare(*USED, PARAMETERS)
        self._torque = node.create_publisher(WrenchStamped, f"{self.name}/applied_torque", 10)
        self._node, self._feed = node, Feed(node, self.name, ())
        self._samples: Subscription | None = None
        self._watched, self._heard, self._silent = False, time.monotonic(), False
        self._is_paused = False
        self._reports: list[str] = []
        self._calls, self._ending = threading.Lock(), threading.Event()
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._thread = threading.Thread(target=self._spin, args=(node,), daemon=True)
        self._thread.start()

    def request(self, name: str, argument: Argument = None) -> Answer:
        """Call a service."""
        try:
            with self._calls:  # one at a time: two pages may ask at once
                return self._connection.request(name, argument)
        except UnreachableError as error:
            return False, str(error)

    def set_parameters(self, values: Mapping[str, Any]) -> Answer:
        """Set parameters of the node."""
        return self.request(PARAMETERS, values)

    def hold_torque(self, torque: Vector) -> None:
        """Publish a torque; the node applies it until its time-out."""
        message = WrenchStamped()
        vector = message.wrench.torque
        vector.x, vector.y, vector.z = torque
        self._torque.publish(message)

    def watch(self, watched: bool) -> None:
        """Subscribe to the samples, or to the events only."""
        self._watched, self._heard = watched, time.monotonic()
        if watched and self._samples is None:
            topic = STATE_TOPICS[DRAWN]
            self._samples = self._node.create_subscription(
                topic.load_message_class(),
                topic.resolve(self.name),
                lambda _: None,
                DEPTH,
                callback_group=Polled(),
                raw=True,
            )
        elif not watched and self._samples is not None:
            self._node.destroy_subscription(self._samples)
            self._samples = None

    def batch(self) -> Batch:
        """Return what was received since the last call."""
        self._take_samples()
        batch = self._feed.batch()
        for _, event in batch.events:
            self._is_paused = not event.segment().running
        if batch.columns or self._is_paused:  # with publish_clock a pause has no samples
            self._heard = time.monotonic()
            if self._silent:
                self._reports.append(f"samples from {self.name} again")
            self._silent = False
        elif self._watched and not self._silent and time.monotonic() > self._heard + SILENCE:
            self._silent = True
            self._reports.append(
                f"no samples from {self.name} for {SILENCE:g} s: is top_node running, with the "
                "same ROS_DOMAIN_ID and --node?"
            )
        return batch

    def _take_samples(self) -> None:
        """Take all samples that have arrived, without the executor."""
        while samples := self._samples:
            with samples.handle:
                taken = samples.handle.take_message(samples.msg_type, True)
            if taken is None:
                return
            self._feed.receive(DRAWN, taken[0])

    def reports(self) -> list[str]:
        """Return a sentence when the node is gone and one when it is back."""
        reports, self._reports = self._reports, []
        return reports

    @property
    def log(self) -> Path | None:
        """None: the log is where the node runs, and its answer names it."""
        return None

    def close(self) -> None:
        """End the thread. The node keeps running."""
        self._ending.set()
        self._thread.join(timeout=2.0)
        self._executor.shutdown(timeout_sec=0.0)

    def _spin(self, node: Node) -> None:
        with contextlib.suppress(ExternalShutdownException):
            while rclpy.ok(context=node.context) and not self._ending.is_set():
                self._executor.spin_once(timeout_sec=0.1)
