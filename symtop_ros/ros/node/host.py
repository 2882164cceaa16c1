"""The node as the host of a session: publishers, messages to the user, duplicate nodes, pace.

A thread calls for each tick at its time. A timer of rclpy would do, but an executor rebuilds its
wait set for each of its calls: at 1 kHz that takes 50 % CPU (one core). `use_real_time` asks for
real-time scheduling, so that ticks come on time on a busy machine; without it, or the right to it,
a short slice lets the thread run soon after it wakes. No other thread is changed: the process
belongs to its program.
"""

import ctypes
import os
import platform
import sys
import threading
import warnings
from collections.abc import Callable
from importlib import metadata
from typing import Any, cast

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import ROSClock
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.run.session.diagnostics import make_status
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.presets import config_folder
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import CLOCK, MARKERS, SAMPLE_TOPICS, Topic
from symtop_ros.run.wire.diagnostics import OK, WARN, Status

# s between two calls, however late they are. Python's locks are not fair: without a pause the
# thread could take the lock again before a waiting request gets it.
MIN_PAUSE = 5e-5
SLICE = 100_000  # ns; the shortest that Linux grants
# Numbers of the system call sched_setattr, for which the C library has no function, by processor.
SET_SCHEDULER = {"x86_64": 314, "aarch64": 274}
# By the major version of rclpy. ROS 2 from PyPI does not set ROS_DISTRO.
NAMES = {"3": "humble", "7": "jazzy", "9": "kilted"}
# The variables that name a file of profiles for Fast DDS: the second up to Jazzy.
VARIABLES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")


class NodePublisher:
    """Publishes bytes. When ROS shuts down in the middle of a sample, the log still gets all."""

    def __init__(self, publisher: Publisher, node: Node) -> None:
        self._publisher = publisher
        self._context = node.context

    @property
    def has_subscriber(self) -> bool:
        """True if the topic has a subscriber."""
        try:
            return bool(self._publisher.get_subscription_count())
        except RuntimeError:
            if self._context.ok():
                raise
            return False

    def publish(self, data: bytes) -> None:
        """Publish an encoded message."""
        try:
            self._publisher.publish(data)
        except RuntimeError:
            if self._context.ok():
                raise


def _check_depth(profile: QoSProfile) -> SetParametersResult:
    """Refuse a depth that the middleware would report in several lines, or read as the default."""
    if profile.depth > 0:
        return SetParametersResult(successful=True)
    return SetParametersResult(successful=False, reason=f"depth {profile.depth} (must be >= 1)")


class NodeHost:
    """The node; see `OutputHost` for the methods."""

    def __init__(self, node: Node, settings: Settings) -> None:
        self._node = node
        self._publishes_clock = settings.publish_clock
        self._levels: dict[str, int] = {}  # of the last statuses, by their names

    @property
    def is_open(self) -> bool:
        """False when ROS is shutting down."""
        return self._node.context.ok()

    def resolve(self, topic: Topic) -> str:
        """Return the full name of a topic, which may be remapped."""
        return self._node.resolve_topic_name(topic.ros_name)

    def create_publisher_of(self, topic: Topic) -> NodePublisher | None:
        """Return a publisher with the QoS of the topic, which ROS parameters may override."""
        message_class = topic.load_message_class()
        if message_class is None:
            if topic in (SAMPLE_TOPICS["tf"], MARKERS):
                self.inform(
                    f"{topic.type.partition('/')[0]} is not installed: {topic.ros_name} is only "
                    "logged"
                )
            return None
        latched, volatile = QoSDurabilityPolicy.TRANSIENT_LOCAL, QoSDurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=topic.depth, durability=latched if topic.latched else volatile)
        try:
            with warnings.catch_warnings():  # of a depth of 0, with the path of a file of rclpy
                warnings.simplefilter("ignore")
                publisher: Any = self._node.create_publisher(
                    message_class,
                    topic.ros_name,
                    qos,
                    qos_overriding_options=QoSOverridingOptions.with_default_policies(
                        callback=_check_depth
                    ),
                )
        except Exception as error:
            raise RefusedError(
                f"qos_overrides.{self.resolve(topic)}.publisher must be valid, got: "
                f"{one_line(error)}"
            ) from None
        return NodePublisher(publisher, self._node)

    def update_statuses(self) -> list[Status]:
        """Return statuses on duplicates; log when these appear and when they are gone."""
        statuses = [
            _look_for_nodes(self._node),
            _look_for_clocks(self._node, self._publishes_clock),
        ]
        for status in statuses:
            before = self._levels.get(status.name, OK)
            if status.level > before:
                self.warn(status.message)
            elif status.level < before:
                self.inform(status.message)
            self._levels[status.name] = status.level
        return statuses

    def inform(self, text: str) -> None:
        """Log a sentence. Each level needs a separate line of code, because rclpy asks for it."""
        if self._node.context.ok():
            self._node.get_logger().info(text)

    def warn(self, text: str) -> None:
        """Log a warning; none any more once ROS has ended, of which rcl would print a line."""
        if self._node.context.ok():
            self._node.get_logger().warning(text)

    def report_error(self, text: str) -> None:
        """Log an error."""
        self._node.get_logger().error(text)

    def fail(self, failure: Failure) -> None:
        """Log the end of the run, and wake the executor; nothing when ROS is shutting down."""
        if self._node.context.ok():
            self._node.get_logger().fatal(str(failure))
            if self._node.executor:
                self._node.executor.wake()


def _look_for_nodes(node: Node) -> Status:
    """Look for other nodes of the name of this node: a request reaches any of them."""
    name = node.get_fully_qualified_name()
    count = max(0, node.get_fully_qualified_node_names().count(name) - 1)
    sentence = f"no other node has the name {name}"
    if count:
        others = "another node has" if count == 1 else f"{count} other nodes have"
        sentence = (
            f"{others} the name {name}, and a request may reach any of these nodes: rename this "
            "one with --ros-args -r __node:=NAME or -r __ns:=/NAME "
            "(a killed node is listed for 20 s)"
        )
    return make_status("name", WARN if count else OK, sentence, {"name": name, "others": count})


def _look_for_clocks(node: Node, publishes_clock: bool) -> Status:
    """Look for several publishers of /clock: the time steps back and forth between them."""
    concerns = publishes_clock or cast(ROSClock, node.get_clock()).ros_time_is_active
    count = node.count_publishers(CLOCK.ros_name)
    sentence = f"no duplicate publisher of {CLOCK.ros_name} concerns this node"
    if is_doubled := concerns and count > 1:
        sentence = (
            f"{count} programs publish {CLOCK.ros_name}, and the time steps back and forth between "
            "them: end all but one, or start this node with publish_clock:=false"
        )
    return make_status("clock", WARN if is_doubled else OK, sentence, {"publishers": count})


class Pacer:
    """Calls `tick` repeatedly in a thread, with a priority of SCHED_FIFO if that is above 0."""

    def __init__(
        self,
        tick: Callable[[], float | None],
        priority: int,
        warn: Callable[[str], None],
    ) -> None:
        self._tick, self._priority, self._warn = tick, priority, warn
        self._awake = threading.Event()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="pacer", daemon=True)
        self._thread.start()

    def wake(self) -> None:
        """Call `tick` now, because the clock was set or the grid of ticks changed."""
        self._awake.set()

    def stop(self) -> None:
        """End the thread after the current tick."""
        self._ending = True
        self._awake.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _run(self) -> None:
        shorten_slice()
        if self._priority and (failure := use_real_time(self._priority)):
            self._warn(failure)
        while not self._ending:
            wait = self._tick()
            self._awake.wait(None if wait is None else max(wait, MIN_PAUSE))
            self._awake.clear()


def use_real_time(priority: int) -> str | None:
    """Have this thread, and those that it starts, scheduled with SCHED_FIFO.

    The reason is returned if the machine does not allow it: the node then runs as other programs.
    """
    if not hasattr(os, "sched_setscheduler"):
        return f"scheduling_priority {priority} has no effect: this system has no SCHED_FIFO"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError:
        return (
            f"scheduling_priority {priority} has no effect: real-time scheduling needs a right "
            "(`ulimit -r`, or CAP_SYS_NICE; see docs/ros.md)"
        )
    return None


def shorten_slice() -> None:
    """Let this thread, and those that it starts, run soon after they wake on a busy machine.

    They get no more time than before. Linux lets a thread that runs use up its slice, up to some
    ms, before one that wakes; from 6.12 on one that wakes with a shorter slice is preferred. It
    needs no right, and older systems ignore it.
    """
    number = SET_SCHEDULER.get(platform.machine())
    if sys.platform != "linux" or not number:
        return
    if os.sched_getscheduler(0) != os.SCHED_OTHER:  # SCHED_FIFO has no slices
        return
    niceness = os.getpriority(os.PRIO_PROCESS, 0)
    attributes = SchedulerAttributes(
        size=ctypes.sizeof(SchedulerAttributes), niceness=niceness, runtime=SLICE
    )
    ctypes.CDLL(None).syscall(number, 0, ctypes.byref(attributes), 0)


class SchedulerAttributes(ctypes.Structure):
    """Linux's struct sched_attr in its first version, which has 48 bytes."""

    _fields_ = (
        ("size", ctypes.c_uint32),
        ("policy", ctypes.c_uint32),
        ("flags", ctypes.c_uint64),
        ("niceness", ctypes.c_int32),
        ("priority", ctypes.c_uint32),
        ("runtime", ctypes.c_uint64),  # ns; of SCHED_OTHER the slice
        ("deadline", ctypes.c_uint64),
        ("period", ctypes.c_uint64),
    )


def distribution_name() -> str:
    """Return the name of the installed distribution; empty if it is not known."""
    return os.environ.get("ROS_DISTRO") or NAMES.get(_rclpy_major(), "")


def use_profile(name: str) -> None:
    """Let Fast DDS use a profile of config/ in this process and its children.

    Does nothing if the user has chosen a profile. Other middleware ignores it. Call it before ROS
    is initialised.
    """
    path = config_folder() / name
    if path.is_file() and not any(os.environ.get(variable) for variable in VARIABLES):
        os.environ[VARIABLES[_rclpy_major() in ("3", "7")]] = str(path)


def _rclpy_major() -> str:
    try:
        return metadata.version("rclpy").partition(".")[0]
    except metadata.PackageNotFoundError:
        return ""
