"""Exceptions and folders that fail: one report, the motion keeps running, and logs are complete."""

import sys
from itertools import pairwise

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact, stamps_of
from geometry_msgs.msg import QuaternionStamped
from programs import environment, execute, running, set_parameters
from ros.node.listener import Listener
from ros.node.running_top import events_named, facts, status_of
from sensor_msgs.msg import JointState

from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.events import Event
from symtop_ros.words import write
from workshop.load.domains import claim_domain
from workshop.load.endings import bound

DOMAIN = claim_domain()
MS = 1_000_000
UNWRITABLE = "record.directory must be a writable folder, got"
LATE = """
import sys
from symtop_ros.programs import top_node
from symtop_ros.run.log import recorder
recorder.LONGEST_AGE = 3600.0
sys.exit(top_node())
"""


class Recording:
    """A top that records into a folder, and its reports."""

    def __init__(self, start_top, folder):
        self.run = start_top(publish_rate=500.0, record__directory=str(folder))
        self._events = self.run.collect_events()
        self._angles = self.run.collect(JointState, "/top/euler_angles", raw=True)

    @property
    def errors(self):
        told = map(facts, self._events)
        found = [each for each in told if each.get("outcome.kind") == "stopped"]
        assert all(each["motion.running"] == "true" for each in found)
        return [each["outcome.failure"] for each in found]

    def switch(self, on):
        """Begin or end; return the file, or the answer that refuses."""
        before = self.run.top.session.recording.path
        granted, answer = self.run.switch("record", on)
        return (before or self.run.log) if granted else answer

    def wait(self, samples=100):
        self.run.wait_for(self._angles, samples)

    def assert_works(self):
        """The motion keeps running, and the next recording is complete."""
        self.wait()
        path = self.switch(True)
        self.wait()
        assert self.run.trigger("hurry_precession")[0]
        self.wait()
        assert self.switch(False) == path
        assert assert_exact(path) > 20
        assert not any((b - a) % (2 * MS) for a, b in pairwise(stamps_of(path)))


@pytest.mark.slow
def test_what_is_no_folder_is_refused_until_it_is_one(start_top, tmp_path):
    folder = tmp_path / "logs"
    folder.touch()
    recording = Recording(start_top, folder)
    refusal = f"{UNWRITABLE} {str(folder)!r}: File exists"
    assert [recording.switch(True) for _ in range(2)] == [refusal] * 2
    folder.unlink()
    recording.assert_works()
    assert recording.errors == []


@pytest.mark.slow
def test_a_log_that_is_deleted_while_it_is_written_is_one_error(start_top, tmp_path):
    recording = Recording(start_top, tmp_path)
    diagnostics = recording.run.collect(DiagnosticArray, "/diagnostics")
    path = recording.switch(True)
    recording.wait()
    path.unlink()
    recording.run.spin_until(lambda: recording.errors)
    diagnostics.clear()
    recording.run.spin_until(lambda: diagnostics)
    status = status_of(diagnostics[-1], "top: log")
    assert (status.level, "the file was removed" in status.message) == (b"\2", True)
    recording.assert_works()
    assert recording.errors == [f"{path}: the file was removed"]


@pytest.mark.slow
def test_a_log_that_fails_at_the_very_end_is_one_line(tmp_path):
    options = set_parameters(f"record.directory:={tmp_path}", "record.enabled:=true")
    words = bound([sys.executable, "-c", LATE, *options])
    with running(words, DOMAIN) as node, Listener(DOMAIN) as listener:
        angles = listener.collect(JointState, "/top/euler_angles")
        listener.spin_until(lambda: len(angles) > 20)
        (path,) = tmp_path.iterdir()
        path.unlink()
        node.terminate()
        _, errors = node.communicate(timeout=300)
    # A machine that is overloaded adds its own warning, which is not the matter here.
    lines = [line for line in errors.splitlines() if " missed in " not in line]
    assert lines == [f"top_node: recording stopped: {path}: the file was removed"]
    assert node.returncode == 1


BUG = Failure("~/hurry_precession", "ZeroDivisionError", "by a bug")


def fail(*_):
    raise ZeroDivisionError("by a\nbug")


def assert_keeps_running(run):
    """Samples are published, requests are answered, and the log agrees with its events."""
    samples = run.collect(QuaternionStamped, "/top/orientation")
    run.wait_for(samples, 20)
    assert run.trigger("hurry_precession")[0]
    run.wait_for(samples, 20)
    assert_exact(run.end_log())
    assert run.top.failure is None


def test_one_in_a_request_that_took_effect_leaves_the_log_exact(start_top, tmp_path, monkeypatch):
    run = start_top(publish_rate=500.0, record=tmp_path)
    events = run.collect_events()
    event_of = Event.of

    def break_kicks(change, *given):
        return fail() if change.act.name == "kick" else event_of(change, *given)

    monkeypatch.setattr(Event, "of", break_kicks)
    before = run.top.simulation.segment
    report = write("failure", BUG)
    for _ in range(2):
        assert run.trigger("hurry_precession") == (False, report)
    run.spin_until(lambda: len(events_named(events, "failure")) == 2)
    assert {each.status[0].message for each in events_named(events, "failure")} == {report}
    assert run.top.simulation.segment is not before
    monkeypatch.undo()
    assert_keeps_running(run)


# As processes, in which a patched method raises

FAILING = """
import sys
from symtop_ros.run.session.outputs import Outputs
from symtop_ros.programs import top_node
calls = []
original = Outputs.send_sample
def failing(*arguments):
    calls.append(1)
    if len(calls) > 300:
        raise ZeroDivisionError("by a\\nbug")
    return original(*arguments)
Outputs.send_sample = failing
sys.exit(top_node())
"""


@pytest.mark.slow
def test_one_in_a_tick_ends_the_node_with_a_line_and_a_complete_log(tmp_path):
    words = ("publish_rate:=500", "record.enabled:=true", f"record.directory:={tmp_path}")
    options = [*set_parameters(*words)[:-1], "error"]
    result = execute([sys.executable, "-c", FAILING, *options], env=environment(DOMAIN))
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    failure = "a tick failed: ZeroDivisionError: by a bug"
    assert line.endswith(f"{failure} (the top has stopped: start the node again)")
    (path,) = tmp_path.iterdir()
    assert assert_exact(path) > 100
