"""Mistakes of our own in every callback: the motion goes on and it is told, or the node ends."""

import subprocess
import sys
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact
from geometry_msgs.msg import QuaternionStamped, WrenchStamped
from node.running_top import LATCHED
from programs import environment

from symtop_ros.node.course import Course
from symtop_ros.node.outputs import Output

DOMAIN = 97
MISTAKE = "ZeroDivisionError: by a mistake"


def mistake(*_):
    raise ZeroDivisionError("by a\nmistake")


@pytest.fixture
def run(start_top, tmp_path):
    return start_top(publish_rate=500.0, record__enabled=True, record__directory=str(tmp_path))


@pytest.fixture
def failures(run):
    """The events that tell of mistakes."""
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: events)
    return lambda: [
        each.status[0].message for each in events if each.status[0].name == "top: failure"
    ]


def assert_goes_on(run):
    """Samples come, requests are answered, and the log is what its events say."""
    samples = run.collect(QuaternionStamped, "/top/orientation")
    run.spin_until(lambda: len(samples) > 20)
    assert run.trigger("hurry_precession")[0]
    run.spin_until(lambda: len(samples) > 40)
    granted, answer = run.switch("record", False)
    assert granted, answer
    assert_exact(Path(answer.removeprefix("recorded to ")))
    assert run.top.failure is None


def push(run):
    publisher = run.user.create_publisher(WrenchStamped, "/top/applied_torque", 10)
    run.spin_until(lambda: publisher.get_subscription_count() > 0)
    message = WrenchStamped()
    message.wrench.torque.z = 1e-4
    publisher.publish(message)


def test_one_in_a_torque_is_told_and_the_motion_goes_on(run, failures, monkeypatch):
    monkeypatch.setattr(Course, "hold_torque", mistake)
    push(run)
    run.spin_until(failures)
    assert failures() == [f"~/applied_torque failed: {MISTAKE}"]
    monkeypatch.undo()
    push(run)
    run.spin_until(lambda: run.top.course.segment.path.driven)
    assert_goes_on(run)


def test_one_after_a_torque_acts_already_leaves_the_log_exact(run, failures, monkeypatch):
    def driven_then_mistaken(course, stamp, _verdict):
        course.segment = course.segment.changed(stamp, torque=(0.0, 0.0, 1e-4))
        mistake()

    monkeypatch.setattr(Course, "_drive", driven_then_mistaken)
    push(run)
    run.spin_until(failures)
    monkeypatch.undo()
    assert_goes_on(run)


def test_one_that_comes_every_second_in_the_diagnostics_is_told_once(run, failures, monkeypatch):
    monkeypatch.setattr("symtop_ros.node.top_node.diagnostics", mistake)
    run.spin_until(failures)
    for _ in range(3):
        run.top._diagnose()
    heard = run.collect(DiagnosticArray, "/diagnostics")
    monkeypatch.undo()
    run.spin_until(lambda: heard)
    assert failures() == [f"/diagnostics failed: {MISTAKE}"]
    assert_goes_on(run)


def test_one_in_the_check_of_parameters_refuses_them(run, failures, monkeypatch):
    monkeypatch.setattr("symtop_ros.node.top_node.checked", mistake)
    told = f"a check of parameters failed: {MISTAKE}"
    values = {"hurry_factor": 1.2}
    assert run.connection.set("set_parameters_atomically", values) == (False, told)
    run.spin_until(failures)
    monkeypatch.undo()
    assert failures() == [told]
    assert run.connection.set("set_parameters_atomically", values)[0]
    assert_goes_on(run)


def test_one_in_the_change_of_parameters_is_told_and_the_motion_goes_on(run, failures, monkeypatch):
    monkeypatch.setattr(Course, "_describe", mistake)
    run.connection.set("set_parameters_atomically", {"top.Mgl": 0.05})
    run.spin_until(failures)
    monkeypatch.undo()
    assert failures() == [f"a change of parameters failed: {MISTAKE}"]
    assert_goes_on(run)


def test_one_in_a_request_that_was_half_done_leaves_the_log_exact(run, failures, monkeypatch):
    monkeypatch.setattr("symtop_ros.node.requests.kick_verdict", mistake)
    for _ in range(2):
        assert run.trigger("hurry_precession") == (False, f"~/hurry_precession failed: {MISTAKE}")
    run.spin_until(lambda: len(failures()) == 2)
    monkeypatch.undo()
    assert_goes_on(run)


def test_the_log_has_the_sample_complete_in_which_ros_ends(run, tmp_path, monkeypatch):
    heard = run.collect(QuaternionStamped, "/top/orientation")
    run.spin_until(lambda: len(heard) > 10)
    first = run.top._outputs._samples["orientation"].output
    send = Output.send

    def ended(output, stamp, data):
        send(output, stamp, data)
        if output is first and run.context.ok():
            run.context.handle.shutdown()

    monkeypatch.setattr(Output, "send", ended)
    while run.context.ok():
        pass
    run.top.close()
    (path,) = tmp_path.iterdir()
    assert_exact(path)


# as processes, in which a mistake is made from outside

FAILING = """
import sys
from symtop_ros.node.{module} import {name}
from symtop_ros.programs import top_node
calls = []
original = {name}.{method}
def mistaken(*arguments):
    calls.append(1)
    if len(calls) > 300:
        raise ZeroDivisionError("by a\\nmistake")
    return original(*arguments)
{name}.{method} = mistaken
sys.exit(top_node())
"""


@pytest.mark.parametrize(
    ("module", "name", "method", "told"),
    [
        ("outputs", "Outputs", "send_sample", f"a tick failed: {MISTAKE}"),
        ("course", "Course", "advance", f"a tick failed: {MISTAKE}"),
    ],
)
def test_one_in_a_tick_ends_the_node_with_a_line_and_a_whole_log(
    module, name, method, told, tmp_path
):
    program = FAILING.format(module=module, name=name, method=method)
    words = ("publish_rate:=500", "record.enabled:=true", f"record.directory:={tmp_path}")
    options = [word for parameter in words for word in ("-p", parameter)]
    result = subprocess.run(
        [sys.executable, "-c", program, "--ros-args", *options, "--log-level", "error"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=environment(DOMAIN),
    )
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    assert line.endswith(told)
    (path,) = tmp_path.iterdir()
    assert assert_exact(path) > 100
