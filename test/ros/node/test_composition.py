"""The node in the process of a user: with other nodes in one executor, of one thread or several."""

import gc
import os
import platform
import signal
import sys
import threading
import time
import warnings
from functools import partial

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from ros.node.running_top import status_of
from ros.node.scheduling import GET_SCHEDULER, read_scheduling
from std_srvs.srv import Trigger
from waiting import TIMEOUT

from symtop_ros.ros.node.top_node import TopNode
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from workshop.load.domains import claim_domain, release_domain

KICK = Parameter("precession_rate_factor", value=1.25).to_parameter_msg()
KICKS = 12


class Kicker(Node):
    """A node of the user: it counts samples of a top, and kicks it from a timer."""

    def __init__(self, name, top, context):
        super().__init__(name, context=context)
        group = ReentrantCallbackGroup()
        self.samples, self.answers = 0, []
        self.client = self.create_client(
            SetParametersAtomically, f"{top}/kick", callback_group=group
        )
        self.create_subscription(
            QuaternionStamped, f"{top}/orientation", self.count, 100, callback_group=group
        )
        self.create_timer(0.01, self.kick, callback_group=group)

    def count(self, _):
        self.samples += 1

    def kick(self):
        if self.client.service_is_ready() and len(self.answers) < KICKS:
            request = SetParametersAtomically.Request(parameters=[KICK])
            self.answers.append(self.client.call_async(request))

    @property
    def is_done(self):
        return len(self.answers) == KICKS and all(each.done() for each in self.answers)


def make_top(context, name, folder):
    """A top that records; its arguments are those of a node."""
    values = {"scene": "hurry_slow", "record.enabled": True, "record.directory": str(folder)}
    return TopNode(
        context=context,
        cli_args=["--ros-args", "-r", f"__node:={name}"],
        parameter_overrides=[Parameter(key, value=value) for key, value in values.items()],
    )


@pytest.fixture(name="context")
def _context():
    domain = claim_domain()
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    yield context
    rclpy.try_shutdown(context=context)
    release_domain(domain)


# As many threads as the machine has processors would be one on some, of which rclpy warns.
# An EventsExecutor works by `spin_once` with a time-out: docs/ros_reference.md says why.
EXECUTORS = [
    SingleThreadedExecutor,
    partial(MultiThreadedExecutor, num_threads=2),
    EventsExecutor,
]
KINDS = ["one thread", "two threads", "events"]


@pytest.mark.parametrize("kind", EXECUTORS, ids=KINDS)
def test_two_tops_and_two_nodes_of_a_user_share_an_executor(kind, context, tmp_path):
    folders = [tmp_path / name for name in ("one", "two")]
    tops = [make_top(context, folder.name, folder) for folder in folders]
    users = [Kicker(f"user_of_{folder.name}", f"/{folder.name}", context) for folder in folders]
    executor = kind(context=context)
    for node in (*tops, *users):
        executor.add_node(node)
    try:
        deadline = time.monotonic() + TIMEOUT
        while not all(user.is_done and user.samples > 20 for user in users):
            assert time.monotonic() < deadline, [(u.samples, len(u.answers)) for u in users]
            executor.spin_once(timeout_sec=0.1)
    finally:
        executor.shutdown()
        for node in (*users, *tops):
            node.destroy_node()
    assert all(each.result().result.successful for user in users for each in user.answers)
    for folder, top in zip(folders, tops, strict=True):
        assert top.failure is None
        log = TopLog(open_run([*folder.iterdir()]))
        found = check_run(log)
        assert (found.mismatches, found.samples_agree, found.laws_hold) == ([], True, True)
        assert log.catalog.problems == ()
        assert [each.name for each in log.catalog.events] == ["start", *["kick"] * KICKS]


# Faults of a top, and its manners as a guest

FAILURE = "failed: ZeroDivisionError: by a bug (the top has stopped: start the node again)"


def fail(*_):
    raise ZeroDivisionError("by a\nbug")


def break_tick(top):
    """The next sample of the thread of the top fails."""
    top.session._outputs.send_sample = fail
    return f"a tick {FAILURE}"


def break_request(top):
    """What is done before a request, in the executor of the user, fails."""
    top._pacer.stop()  # else a tick may come first
    top.simulation.settle = fail
    return f"~/get_state {FAILURE}"


class Asker(Node):
    """A node of the user: it hears a top, and asks it."""

    def __init__(self, top, context):
        super().__init__("asker", context=context)
        self.diagnostics, self.samples = [], []
        self.create_subscription(DiagnosticArray, "/diagnostics", self.diagnostics.append, 100)
        self.create_subscription(QuaternionStamped, f"/{top}/orientation", self.samples.append, 100)
        self._state = self.create_client(Trigger, f"/{top}/get_state")
        self._parameters = self.create_client(
            SetParametersAtomically, f"/{top}/set_parameters_atomically"
        )

    def is_ready(self):
        return all(each.service_is_ready() for each in (self._state, self._parameters))

    def ask_state(self):
        return self._state.call_async(Trigger.Request())

    def change_factor(self):
        change = Parameter("hurry_factor", value=2.0).to_parameter_msg()
        return self._parameters.call_async(SetParametersAtomically.Request(parameters=[change]))

    def find_status(self, name):
        """The latest of a name; None if none has come."""
        arrays = [each for each in self.diagnostics if any(s.name == name for s in each.status)]
        return status_of(arrays[-1], name) if arrays else None


def spin_until(executor, done):
    deadline = time.monotonic() + TIMEOUT
    while not done():
        assert time.monotonic() < deadline, "the condition did not come true in time"
        executor.spin_once(timeout_sec=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("break_it", [break_tick, break_request])
@pytest.mark.parametrize("kind", EXECUTORS, ids=KINDS)
def test_a_top_that_fails_says_so_and_the_others_continue(kind, break_it, context, tmp_path, capfd):
    """The executor and the context of the user keep working; so does the other top."""
    folders = [tmp_path / name for name in ("ill", "well")]
    ill, well = [make_top(context, folder.name, folder) for folder in folders]
    asker, user = Asker("ill", context), Kicker("user", "/well", context)
    executor = kind(context=context)
    for node in (ill, well, asker, user):
        executor.add_node(node)
    try:
        spin_until(executor, lambda: asker.samples and asker.is_ready())
        reason = break_it(ill)
        if break_it is break_tick:  # a request would publish the sample that fails
            spin_until(executor, lambda: ill.failure)
        answer = asker.ask_state()
        spin_until(executor, answer.done)
        assert (answer.result().success, answer.result().message) == (False, reason)
        assert str(ill.failure) == reason
        number = ill.simulation.event_number
        last = ill.simulation.last
        change = asker.change_factor()
        spin_until(executor, change.done)
        result = change.result().result
        assert (result.successful, result.reason) == (False, reason)
        spin_until(
            executor,
            lambda: (found := asker.find_status("ill: motion")) and found.level == b"\2",
        )
        status = asker.find_status("ill: motion")
        found = {pair.key: pair.value for pair in status.values}
        assert (status.message, found) == (reason, {"running": "false", "event": str(number)})
        spin_until(executor, lambda: user.is_done and user.samples > 20)
        spin_until(executor, lambda: asker.find_status("well: motion"))
        assert asker.find_status("well: motion").level == b"\0"
        assert all(each.result().result.successful for each in user.answers)
        assert well.failure is None
        assert ill.simulation.last == last
        assert context.ok()
        told = [line for line in capfd.readouterr().err.splitlines() if "[FATAL]" in line]
        assert [line.rpartition("[ill]: ")[2] for line in told] == [reason]
        # The log is complete before the node is destroyed.
        log = TopLog(open_run([*folders[0].iterdir()]))
        assert check_run(log).mismatches == []
        assert log.catalog.problems == ()
        event = log.catalog.events[-1]
        assert (event.name, event.verdict, event.number) == ("failure", reason, number)
        assert (event.stamp > last, event.segment().running) == (True, False)
    finally:
        executor.shutdown()
        for node in (user, asker, ill, well):
            node.destroy_node()


def describe_process():
    """What a node could set for the whole process, or for the threads of its user."""
    return {
        "environment": dict(os.environ),
        "switch interval": sys.getswitchinterval(),
        "collector": (gc.isenabled(), gc.get_threshold(), gc.get_freeze_count()),
        "signals": {each: signal.getsignal(each) for each in signal.valid_signals()},
        "warnings": list(warnings.filters),
        "hooks": (sys.excepthook, threading.excepthook, sys.unraisablehook),
        "streams": (sys.stdout.errors, sys.stderr.errors),
        "folder": os.getcwd(),
        "scheduling": (os.sched_getscheduler(0), os.sched_getparam(0), os.sched_getaffinity(0)),
        "niceness": os.getpriority(os.PRIO_PROCESS, 0),
        "slice": read_scheduling() if platform.machine() in GET_SCHEDULER else None,
    }


def test_a_node_in_the_process_of_a_user_sets_nothing_of_the_process(context, tmp_path):
    """What `top_node` sets for itself; the thread of the user keeps its scheduling."""
    before = describe_process()
    values = {"scheduling_priority": 50, "record.directory": str(tmp_path)}
    overrides = [Parameter(key, value=value) for key, value in values.items()]
    top = TopNode(context=context, parameter_overrides=overrides)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(top)
    try:
        first = top.simulation.last
        spin_until(executor, lambda: top.simulation.last > first)
        assert describe_process() == before
    finally:
        executor.shutdown()
        top.destroy_node()
    assert describe_process() == before
