"""What the engine cannot do in time is told, and everything else goes on."""

import json
import os
import signal

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from node.listener import Listener
from node.running_top import LATCHED, facts, stamp_of
from node.test_torque import assert_recomputed, named
from programs import running_node

pytestmark = pytest.mark.untraced
# a nutation of 5e6 rad/s a hundred times as fast: ten million steps for each second
HOPELESS = {
    "top__Ix": 1e-4,
    "top__Iz": 1e-4,
    "initial__psi_dot": 5e6,
    "friction__transverse": 1e-6,
    "real_time_factor": 100.0,
}
SET = "set_parameters_atomically"
MS = 1_000_000


def test_a_motion_too_fast_for_the_engine_is_slowed_down_and_told(start_top, capfd):
    run = start_top(publish_rate=200.0, **HOPELESS)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: named(events, "pace") and len(orientations) > 60 and diagnostics)
    assert "the engine cannot keep up: real-time factor 100 ->" in capfd.readouterr().err
    pace = {pair.key: pair.value for pair in diagnostics[-1].status[1].values}
    assert float(pace["real_time_factor"]) == 100.0
    assert 0 < float(pace["real_time_factor.achieved"]) < 1.0
    assert "the engine keeps up with" in diagnostics[-1].status[1].message
    # until the first slow-down samples were missed; since then all of them are there
    begin = stamp_of(named(events, "pace")[0])
    stamps = [stamp_of(each) for each in orientations if stamp_of(each) >= begin]
    assert set(np.diff(stamps)) == {5 * MS}
    assert_recomputed(events, orientations)


def test_when_the_friction_ends_the_motion_is_as_fast_as_was_asked_again(start_top):
    run = start_top(**HOPELESS)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: named(events, "pace"))
    assert run.set(SET, **{"friction.transverse": 0.0})[0]
    run.spin_until(
        lambda: (
            float(facts(events[-1])["motion.real_time_factor"]) == 100.0
            and facts(events[-1])["engine"] == "closed form"
        )
    )
    assert json.loads(run.trigger("get_state")[1])["engine"] == "closed form"


def test_a_stopped_process_goes_on_where_the_clock_is_and_says_so():
    with running_node(99, "publish_rate:=200") as node, Listener(99) as listener:
        orientations = listener.collect(QuaternionStamped, "/top/orientation")
        diagnostics = listener.collect(DiagnosticArray, "/diagnostics")
        events = listener.collect(DiagnosticArray, "/top/events", LATCHED)
        listener.spin_until(lambda: len(orientations) > 20 and events)
        os.kill(node.pid, signal.SIGSTOP)
        listener.spin(1.0)
        os.kill(node.pid, signal.SIGCONT)
        seen = len(orientations)
        listener.spin_until(lambda: len(orientations) > seen + 40)
        told = len(diagnostics)
        listener.spin_until(lambda: len(diagnostics) > told)
    gaps = np.diff([stamp_of(each) for each in orientations])
    assert 500 * MS < gaps.max() < 1500 * MS
    assert not (gaps % (5 * MS)).any()
    pace = {pair.key: pair.value for pair in diagnostics[-1].status[1].values}
    assert int(pace["missed"]) == gaps.max() // (5 * MS) - 1
    assert "ticks missed" in diagnostics[-1].status[1].message
    assert len(events) == 1
    assert_recomputed(events, orientations)
