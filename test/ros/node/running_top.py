"""A top and its user in one process: real rclpy and Fast DDS, own context and domain.

Time is simulated unless a test is about real time: it advances while the test spins.
"""

import contextlib
import itertools
import json
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.clock_type import ClockType
from rclpy.parameter import Parameter
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.time import Time
from ros.node.listener import Listener
from waiting import TIMEOUT

from symtop_ros.ros.client.connection import Connection
from symtop_ros.ros.node.top_node import TopNode
from symtop_ros.run.simulation import simulation
from symtop_ros.run.simulation.budget import ComputeBudget
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from workshop.load.domains import claim_domain, release_domain

LATCHED = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
TURN = 0.002  # s of real time between two advances of the simulated clock, at least
STEP = 5_000_000  # ns; an advance of the simulated clock


@contextlib.contextmanager
def _steady_machine() -> Iterator[None]:
    """Let a node that is made meanwhile integrate 100 steps in 1 ms of its budget, always."""
    clock = itertools.count(step=1e-3).__next__
    with patch.object(simulation, "ComputeBudget", partial(ComputeBudget, clock)):
        yield


class RunningTop(Listener):
    """A TopNode and a client node, spun together until a condition holds.

    With `realtime` the node follows the clock of the system, else a simulated clock that begins
    at 0 and advances by 5 ms at most every 2 ms while the test spins; its budget of work is then
    counted in steps. With `record` it records into this folder.
    """

    def __init__(
        self,
        realtime: bool = False,
        arguments: list[str] | None = None,
        record: Path | None = None,
        **parameters: Any,
    ) -> None:
        self.domain = claim_domain()
        super().__init__(self.domain, "user")
        self.now = 0
        self._advanced = 0.0
        self._frozen = realtime
        if record:
            parameters |= {"record__enabled": True, "record__directory": str(record)}
        if not realtime:
            parameters = {"use_sim_time": True, **parameters}
        overrides = [Parameter(k.replace("__", "."), value=v) for k, v in parameters.items()]
        try:
            named = {"cli_args": arguments, "parameter_overrides": overrides}
            with contextlib.nullcontext() if realtime else _steady_machine():
                self.top = TopNode(context=self.context, **named)
        except Exception:
            rclpy.try_shutdown(context=self.context)
            release_domain(self.domain)
            raise
        self.user = self.node
        self.connection = _SharedConnection(self)
        self.executor.add_node(self.top)

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        try:
            self.executor.shutdown()
            self.user.destroy_node()
            self.top.close()
            self.top.destroy_node()
            rclpy.try_shutdown(context=self.context)
        finally:
            release_domain(self.domain)

    def freeze(self) -> None:
        """Stop the simulated clock; `set_clock` still sets it."""
        self._frozen = True

    def set_clock(self, stamp: int) -> None:
        """Set the simulated clock to a stamp in ns."""
        self.now = stamp
        moment = Time(nanoseconds=stamp, clock_type=ClockType.ROS_TIME)
        self.top.get_clock().set_ros_time_override(moment)

    def spin_until(self, done: Callable[[], Any], timeout: float = TIMEOUT) -> None:
        deadline = time.monotonic() + timeout
        while not done():
            assert time.monotonic() < deadline, "the condition did not come true in time"
            if not self._frozen and time.monotonic() - self._advanced >= TURN:
                self._advanced = time.monotonic()
                self.set_clock(self.now + STEP)
            self.executor.spin_once(timeout_sec=0.05 if self._frozen else TURN)

    def collect_events(self) -> list[Any]:
        """Subscribe to the events, wait for the first, and return the list that they come into."""
        events = self.collect(DiagnosticArray, "/top/events", LATCHED)
        self.spin_until(lambda: events)
        return events

    def publisher(self, kind: Any, topic: str) -> Any:
        """Create a publisher to the top and wait until messages arrive."""
        publisher = self.user.create_publisher(kind, topic, 10)
        self.match(publisher)
        return publisher

    def match(self, publisher: Any) -> None:
        """Wait until publisher and top know each other: an earlier message would be lost."""

        def is_matched() -> bool:
            name = publisher.topic_name
            ends = [each for each in self.top.subscriptions if each.topic_name == name]
            is_known = any(each.get_publisher_count() for each in ends)
            return bool(is_known and publisher.get_subscription_count())

        self.spin_until(is_matched)

    @property
    def log(self) -> Path:
        """The file of the recording."""
        path = self.top.session.recording.path
        assert path
        return path

    def end_log(self) -> Path:
        """End the recording; return its file."""
        path = self.log
        granted, answer = self.switch("record", False)
        assert granted, answer
        return path

    def state(self) -> Any:
        """The answer of ~/get_state."""
        granted, text = self.trigger("get_state")
        assert granted, text
        return json.loads(text)

    def change(self, values: Mapping[str, Any]) -> tuple[bool, str]:
        """Set parameters."""
        return self.connection.request("set_parameters_atomically", values)

    def set(self, service: str, **values: Any) -> tuple[bool, str]:
        return self.connection.request(service, values)

    def send(self, service: str, parameters: list[Any]) -> list[tuple[bool, str]]:
        """Send unchanged parameters to a service of named values; return its answers."""
        each = service == "set_parameters"
        kind = SetParameters if each else SetParametersAtomically
        answer = self.connection.call(kind, service, kind.Request(parameters=parameters))
        results = answer.results if each else [answer.result]
        assert len(results) == (len(parameters) if each else 1)
        return [(result.successful, result.reason) for result in results]

    def trigger(self, service: str) -> tuple[bool, str]:
        return self.connection.request(service)

    def switch(self, service: str, on: bool) -> tuple[bool, str]:
        return self.connection.request(service, on)


class _SharedConnection(Connection):
    """The client of the package, spun together with the node."""

    def __init__(self, running: RunningTop) -> None:
        self.node = running.user
        self.name = "/top"
        self._timeout = TIMEOUT
        self._running = running
        self._clients = {}
        self._unknown = set()
        self._question = None

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        # The client asks again after a second, in which a busy machine may answer nothing.
        deadline = time.monotonic() + timeout
        self._running.spin_until(lambda: done() or time.monotonic() >= deadline)
        return bool(done())


def torque_of(x: float = 0.0, y: float = 0.0, z: float = 0.0, frame: str = "") -> WrenchStamped:
    """The message of a torque in N m."""
    message = WrenchStamped()
    message.header.frame_id = frame
    torque = message.wrench.torque
    torque.x, torque.y, torque.z = x, y, z
    return message


def vector(message: Any) -> list[float]:
    """Components of a vector."""
    return [message.x, message.y, message.z]


def stamp_of(message: Any) -> int:
    stamp = message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def segment_of(message: Any) -> Segment:
    """The segment that an event announces."""
    return Event(stamp_of(message), message.status[0].name, "", facts(message)).segment()


def facts(message: Any, status: str | None = None) -> Mapping[str, str]:
    """Keys and values of the status with a name, of the first one without."""
    return {pair.key: pair.value for pair in status_of(message, status).values}


def status_of(message: Any, name: str | None = None) -> Any:
    """The status with a name; the first one without."""
    return next(each for each in message.status if name in (None, each.name))


def events_named(events: list[Any], name: str) -> list[Any]:
    return [each for each in events if each.status[0].name == f"top: {name}"]
