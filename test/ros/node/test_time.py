"""Simulated time: the top follows /clock, and continues from its state when the clock jumps."""

import time
from itertools import pairwise

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact, stamps_of
from geometry_msgs.msg import QuaternionStamped
from ros.node.running_top import LATCHED, events_named, facts, segment_of, stamp_of, status_of
from rosgraph_msgs.msg import Clock
from trials import choose

from symtop_ros.ros.node import top_node
from symtop_ros.run.simulation.block import GAP

MS = 1_000_000


class SimulatedClock:
    """A publisher of /clock; the clock of the run itself stays frozen."""

    def __init__(self, run):
        self.run = run
        run.freeze()
        self.publisher = run.publisher(Clock, "/clock")

    def set_to(self, stamp):
        seconds, nanoseconds = divmod(stamp, 1_000_000_000)
        self.publisher.publish(Clock(clock=Time(sec=seconds, nanosec=nanoseconds)))
        self.run.spin_until(lambda: self.run.top.get_clock().now().nanoseconds == stamp)

    def run_from(self, stamp, count):
        for k in range(count):
            self.set_to(stamp + k * 10 * MS)


def assert_exact_log(run):
    assert assert_exact(run.end_log()) > 20


def test_a_clock_that_jumps_and_then_stops_for_good_leaves_the_log_exact(start_top, tmp_path):
    run = start_top(use_sim_time=True, publish_rate=100.0, record=tmp_path)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    clock = SimulatedClock(run)
    for jumps, begin in enumerate((50_000, 20_000, 90_000), 1):  # the first /clock, back, forward
        clock.set_to(begin * MS)
        # two jumps before a sample are one
        run.spin_until(lambda: len(events_named(events, "clock")) == jumps)  # noqa: B023
        clock.run_from(begin * MS, 30)
    assert max(segment_of(each).elapsed for each in events) < 10**9  # ns: no catching up
    run.user.destroy_publisher(clock.publisher)
    for _ in range(3):
        assert run.trigger("hurry_precession")[0]
        assert run.switch("pause", True)[0]
        assert run.set("step", duration=0.01)[0]
        assert run.switch("pause", False)[0]
    assert_exact_log(run)
    assert run.switch("record", True)[0]


@pytest.mark.realtime
def test_simulated_time_switched_while_recording_leaves_the_log_exact(start_top, tmp_path):
    run = start_top(realtime=True, publish_rate=100.0, record=tmp_path)
    messages = run.collect(QuaternionStamped, "/top/orientation")
    clock = None
    for begin in (50_000, 20_000, 70_000):
        granted, answer = run.change({"use_sim_time": True})
        assert granted, answer
        clock = clock or SimulatedClock(run)
        run.match(clock.publisher)  # it subscribes anew
        clock.run_from(begin * MS, 20)
        assert run.trigger("hurry_precession")[0]
        run.spin_until(
            lambda: any(0 < stamp_of(each) - begin * MS < 1000 * MS for each in messages)  # noqa: B023
        )
        assert run.change({"use_sim_time": False})[0]
        run.wait_for(messages, 20)
        assert run.trigger("reset")[0]
        run.spin_until(lambda: abs(stamp_of(messages[-1]) - time.time_ns()) < 5_000 * MS)
    assert_exact_log(run)


def test_simulated_time_without_a_clock_is_warned_of_once(start_top, monkeypatch, capfd):
    monkeypatch.setattr(top_node, "CLOCK_WAIT", 0.05)
    run = start_top(realtime=True, use_sim_time=True)
    for _ in range(8):
        run.executor.spin_once(timeout_sec=0.05)
    assert run.top.clock_is_missing
    run.set_clock(10**9)
    run.spin_until(lambda: not run.top.clock_is_missing)
    warning = "use_sim_time is true, but no /clock was received for 0.05 s: no samples"
    assert capfd.readouterr().err.count(warning) == 1


@pytest.mark.realtime
@pytest.mark.parametrize("pace", choose(((0.1, 1000.0), (1.0, 200.0), (5.0, 40.0)), ((5.0, 40.0),)))
def test_a_published_clock_is_the_time_of_the_motion_and_is_logged(pace, start_top, tmp_path):
    factor, rate = pace
    pace_of = {"real_time_factor": factor, "publish_rate": rate}
    begin = time.monotonic()
    run = start_top(realtime=True, publish_clock=True, record=tmp_path, **pace_of)
    begun = time.monotonic()
    clocks = run.collect(Clock, "/clock")
    samples = run.collect(QuaternionStamped, "/top/orientation")
    heard = run.collect(DiagnosticArray, "/diagnostics")

    def times():
        return [each.clock.sec * 10**9 + each.clock.nanosec for each in clocks]

    run.wait_for(samples, 20)
    run.spin_until(lambda: time.monotonic() > begun + 1.0)
    asked = time.monotonic()
    reached = run.state()["stamp"]
    assert reached <= factor * (time.monotonic() - begin)
    # On a busy machine the time waits for samples that are more than GAP late, which the node says.
    run.spin_until(lambda: heard and stamp_of(heard[-1]) > 1e9 * reached)
    waited = float(facts(heard[-1], "top: pace")["waited"])
    assert reached >= factor * (asked - begun - waited - GAP)
    assert run.switch("pause", True)[0]
    late = run.collect(Clock, "/clock")
    # a subscriber that comes in the pause gets the time, too
    run.spin_until(lambda: late and late[0] == clocks[-1])
    assert run.set("step", duration=0.02)[0]
    assert run.switch("pause", False)[0]
    run.wait_for(samples, 20)
    for request in ("reset", "hurry_precession"):
        run.trigger(request)
    run.wait_for(samples, 20)
    stamps = [stamp_of(each) for each in samples]
    assert {b - a for a, b in pairwise(stamps)} == {round(1e9 / rate), 20 * MS}
    assert all(a <= b for a, b in pairwise(times()))
    before = {each for each in times() if each < stamps[0]}  # the first message missed the start
    assert set(times()) <= {*stamps, *times()[:1], *before}
    path = run.end_log()
    assert assert_exact(path) > 20
    assert stamps_of(path, "/clock")


@pytest.mark.realtime
def test_a_second_publisher_of_the_clock_is_reported_until_it_is_gone(start_top):
    run = start_top(realtime=True, publish_clock=True)
    heard = run.collect(DiagnosticArray, "/diagnostics")
    other = run.user.create_publisher(Clock, "/clock", 10)

    def clocks():
        return [status_of(each, "top: clock") for each in heard]

    run.spin_until(lambda: clocks() and clocks()[-1].level == b"\1")
    assert {each.key: each.value for each in clocks()[-1].values} == {"publishers": "2"}
    run.user.destroy_publisher(other)
    heard.clear()
    run.spin_until(lambda: clocks() and clocks()[-1].level == b"\0")
