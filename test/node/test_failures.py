"""Unexpected exceptions in every callback: reported, and the motion keeps running or ends."""

import sys

from exact_log import assert_exact
from geometry_msgs.msg import QuaternionStamped
from node.running_top import events_named
from programs import environment, execute, set_parameters

from symtop_ros.simulation.changes.outcomes import Failure
from symtop_ros.simulation.changes.timeline import Change
from symtop_ros.wording import write
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()
BUG = "ZeroDivisionError: by a bug"


def report_of(action):
    return write("failure", Failure(action, "ZeroDivisionError", "by a bug"))


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
    events, write = run.collect_events(), Change.event
    monkeypatch.setattr(
        Change, "event", lambda each, n: fail() if each.act.name == "kick" else write(each, n)
    )
    before, report = run.top.simulation.segment, report_of("~/hurry_precession")
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
from symtop_ros.session.outputs import Outputs
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


def test_one_in_a_tick_ends_the_node_with_a_line_and_a_complete_log(tmp_path):
    words = ("publish_rate:=500", "record.enabled:=true", f"record.directory:={tmp_path}")
    options = [*set_parameters(*words)[:-1], "error"]
    result = execute([sys.executable, "-c", FAILING, *options], env=environment(DOMAIN))
    assert result.returncode == 1
    (line,) = result.stderr.splitlines()
    assert line.endswith(f"a tick failed: {BUG}")
    (path,) = tmp_path.iterdir()
    assert assert_exact(path) > 100
