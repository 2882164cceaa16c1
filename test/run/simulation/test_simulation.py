"""The simulation without ROS: samples, events, jumps of the clock, torques and failures."""

import re
import threading
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np
import pytest
from run.simulation.runs import SECOND, ListSink, Run
from waiting import until

from symtop_ros.run.simulation import events
from symtop_ros.run.simulation.block import MAX_BLOCK
from symtop_ros.run.simulation.budget import SHARE, Lack, Shortfall
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.gaps import Missed
from symtop_ros.run.simulation.topics import STATE_TOPICS

pytestmark = pytest.mark.numbers

MS = SECOND // 1000


def test_the_tick_after_the_last_sample_waits_for_a_change_of_the_clock():
    run = Run()
    run.tick()
    assert run.simulation.tick() is None
    run.clock.is_simulated = False
    assert run.simulation.tick() == pytest.approx(0.005)  # the period, exact in ns


class CountingSink(ListSink):
    """Needs the topics of the state, and has the names of those that were computed for it."""

    def __init__(self):
        super().__init__()
        self.computed = []

    def encode(self, topic, stamps, numbers):
        self.computed.append(topic)
        return super().encode(topic, stamps, numbers)

    def send_sample(self, stamp, block):
        for name in STATE_TOPICS:
            block.message(name, stamp)


def test_a_tick_computes_one_topic_of_the_samples_to_come_at_most():
    sink = CountingSink()
    run = Run(sink=sink, publish_rate=1000.0)
    run.advance(0.1, step=0.001)
    counts = []
    for _ in range(10 * MAX_BLOCK):
        sink.computed.clear()
        run.advance(0.001, step=0.001)
        counts.append(len(sink.computed))
    assert max(counts) == 1
    assert sum(counts) == 10 * len(STATE_TOPICS)


def test_after_a_kick_the_next_sample_is_ready_when_it_is_due():
    sink = CountingSink()
    run = Run("hurry_slow", seconds=0.02, sink=sink, publish_rate=1000.0)
    run.advance(0.003, step=0.001)
    assert run.ask("hurry_precession")[0]
    assert sink.computed
    sink.computed.clear()
    run.clock.now += MS
    assert run.simulation.publish()
    assert sink.computed == []


def test_a_sample_that_is_due_does_not_wait_for_the_rest_of_an_event(monkeypatch):
    run = Run("hurry_slow", publish_rate=1000.0, seconds=0.02)
    write_fields = events.write_fields
    write = events.write
    sent = []

    def take_a_period(*given):
        run.clock.now += MS
        return write_fields(*given)

    def count(*given):
        sent.append(len(run.sink.samples))
        return write(*given)

    monkeypatch.setattr(events, "write_fields", take_a_period)
    monkeypatch.setattr(events, "write", count)
    before = len(run.sink.samples)
    assert run.ask("hurry_precession")[0]
    assert sent == [before + 1]
    run.assert_recomputed()
    assert run.sink.order[-2:] == ["kick", "sample"]  # as a log has them


@pytest.mark.parametrize("jump", [90, 3600])
def test_the_motion_follows_a_jump_of_the_clock_from_its_current_state(jump):
    run = Run(seconds=0.5)
    before = run.simulation.state
    run.jump(jump * SECOND)
    run.tick()
    assert run.sink.events[-1].name == "clock"
    stamp, numbers = run.sink.samples[-1]
    w, x, y, z = before.orientation.tolist()
    assert (stamp, numbers) == (jump * SECOND, [x, y, z, w])
    run.clock.now = SECOND  # backwards, without a notification
    run.tick()
    assert [event.name for event in run.sink.events].count("clock") == 2
    assert run.sink.samples[-1][0] == SECOND


def test_a_request_after_a_jump_belongs_to_the_time_after_it():
    run = Run("hurry_slow", seconds=0.5)
    state = run.simulation.state
    run.jump(90 * SECOND)
    assert run.ask("hurry_precession")[0]
    assert [event.name for event in run.sink.events] == ["start", "clock", "kick"]
    kick = run.sink.events[-1]
    assert kick.stamp == 90 * SECOND
    before = kick.values["before.orientation"].split()
    assert [float(each) for each in before] == state.orientation.tolist()
    assert run.simulation.ticker.missed == 0
    run.assert_recomputed()


@pytest.mark.parametrize(("used", "factor"), [(0.45, 1.0), (0.55, 0.25)])
def test_the_pace_returns_if_half_of_the_share_is_left(used, factor):
    run = Run()
    simulation = run.simulation
    simulation.apply(simulation.timeline.set_pace(simulation.stamp, 1.0, 0.25))
    simulation.budget.spent = 8.0
    simulation.speed_up()  # later, it counts what was spent since then
    simulation.budget.spent += used * SHARE
    simulation.speed_up()
    assert simulation.factor == factor


def starve(simulation):
    """Slow the motion down as if other programs had the processor."""
    shortfall = Shortfall(simulation.segment.time_at(simulation.stamp), 0.5, Lack(10.0, 30.0))
    simulation._slow_down(simulation.stamp, shortfall)


def count_seconds(simulation, factor):
    """Return after how many measurements, one a second, a real-time factor is reached."""
    for seconds in range(1, 200):
        simulation.budget.spent += 0.3  # more than a motion that is too fast may take
        simulation.speed_up()
        if simulation.factor == factor:
            return seconds
    raise AssertionError


def test_a_motion_that_lacks_cpu_time_returns_later_each_time():
    run = Run("friction", seconds=0.5)
    simulation = run.simulation
    waits = []
    for _ in range(8):
        starve(simulation)
        waits.append(count_seconds(simulation, 1.0))
    assert waits == [1, 2, 4, 8, 16, 32, 60, 60]
    assert run.sink.warnings[-1].startswith("the motion lacks CPU time: gets 10 % CPU, needs 30 %")
    for _ in range(60):
        simulation.speed_up()
    starve(simulation)
    assert count_seconds(simulation, 1.0) == 1


def test_while_the_clock_jumps_no_sample_gets_a_stamp_of_the_new_time():
    run = Run(seconds=0.5)
    count = len(run.sink.samples)
    run.simulation.begin_jump()
    ticks = threading.Thread(target=run.tick)
    ticks.start()
    run.clock.now = 90 * SECOND
    ticks.join(0.05)
    assert ticks.is_alive()
    assert len(run.sink.samples) == count
    run.simulation.end_jump(True)
    ticks.join()
    assert run.sink.events[-1].name == "clock"
    assert run.simulation.ticker.missed == 0
    run.assert_recomputed()


def test_a_request_waits_for_one_sample_however_many_are_late():
    run = Run(publish_rate=1000.0, seconds=0.1)
    sent = len(run.stamps)
    send = run.sink.send_sample
    asking = threading.Thread(target=run.ask, args=("pause", True))

    def send_and_ask(stamp, block):
        send(stamp, block)
        if not asking.ident:
            asking.start()
            until(lambda: run.simulation.turns.is_awaited)

    run.sink.send_sample = send_and_ask
    run.clock.now += 12 * SECOND // 1000  # they are in one block
    run.simulation.tick()
    asking.join()
    assert run.stamps.index(run.sink.events[-1].stamp) == sent + 1
    run.tick()
    assert len(run.stamps) == sent + 12


def test_late_ticks_are_dropped_and_reported_once_and_then_each_minute():
    run = Run(publish_rate=1000.0)
    run.clock.is_simulated = False
    run.tick()
    for _ in range(3):
        run.clock.now += 300 * MS
        run.tick()
    assert run.simulation.ticker.missed == 3 * 199  # 100 samples of 300 are caught up
    (first,) = run.sink.warnings
    assert read_missed(first) == (199, 1, 0.199)
    for _ in range(2 * 60):
        run.clock.now += 1000 * MS
        run.tick()
    assert len(run.sink.warnings) == 3
    missed = 2 * 199 + 60 * 899  # 100 samples of 1000 are caught up
    assert read_missed(run.sink.warnings[1]) == (missed, 62, 0.899)
    assert str(run.simulation.gaps.whole) == write_missed(run.stamps, 1000)


def read_missed(text):
    """Return the numbers of a sentence: samples, gaps and the longest gap in s."""
    samples, gaps, longest = re.match(
        r"(\d+) samples missed in (a|\d+) gaps?(?: of|, the longest) ([\d.]+) s", text
    ).groups()
    return int(samples), 1 if gaps == "a" else int(gaps), float(longest)


def write_missed(stamps, rate):
    """Return the sentence on the gaps of stamps, counted on them."""
    missed = np.rint(np.diff(stamps) * rate / SECOND).astype(int) - 1
    gaps = missed[missed > 0]
    longest = f"{gaps.max() / rate:.3g}"
    return f"{gaps.sum()} samples missed in {len(gaps)} gaps, the longest {longest} s"


def test_a_gap_that_is_found_in_two_ticks_is_one_gap():
    missed = Missed()
    for count, last in ((30, 5), (20, 5), (40, 9)):
        missed.add(count, 100.0, last)
    assert read_missed(str(missed)) == (90, 2, 0.5)


@pytest.mark.parametrize(("rate", "caught_up"), [(1000.0, 100), (200.0, 100), (100.0, 50)])
def test_as_many_samples_are_caught_up_as_are_kept_and_half_a_second_at_most(rate, caught_up):
    run = Run(publish_rate=rate)
    run.clock.is_simulated = False
    run.tick()
    run.clock.now += 1000 * MS
    run.tick()
    assert run.simulation.ticker.missed == rate - 1 - caught_up


@pytest.mark.parametrize(
    ("forward", "why"),
    [(0, "the process was stopped, "), (700 * MS, "the clock of the system was ")],
)
def test_a_gap_is_explained_by_a_clock_that_was_set(forward, why):
    run = Run(publish_rate=200.0)
    run.clock.is_simulated = False
    run.tick()
    run.clock.now += 1000 * MS
    run.clock.set_forward += forward
    run.tick()
    (text,) = run.sink.warnings
    assert f": {why}" in text
    assert ("set forward by 0.7 s; " in text) == bool(forward)


def test_single_missed_samples_are_reported_when_they_amount_to_a_tenth_of_a_second():
    run = Run(publish_rate=1000.0)
    run.clock.is_simulated = False
    run.tick()
    for _ in range(99):
        run.clock.now += 102 * MS
        run.tick()
    assert run.simulation.ticker.missed == 99
    assert run.sink.warnings == []
    run.clock.now += 102 * MS
    run.tick()
    assert read_missed(run.sink.warnings[0]) == (100, 100, 0.001)
    assert str(run.simulation.gaps.whole) == write_missed(run.stamps, 1000)


@pytest.mark.parametrize("times", [1, 8])
def test_a_torque_that_is_repeated_acts_on_without_further_events(times):
    run = Run(seconds=0.1)
    for _ in range(times):
        run.push((0.0, 0.0, 2e-4))
        run.advance(0.05)
    run.advance(0.2)
    begin, end = [event for event in run.sink.events if event.name == "torque"]
    torques = [event.values["applied_torque"] for event in (begin, end)]
    assert torques == ["0.0 0.0 0.0002", "0.0 0.0 0.0"]
    assert end.stamp - begin.stamp == ((times - 1) * 50 + 100) * MS
    run.assert_recomputed()


def fail(*_, **__):
    raise ZeroDivisionError("by\na bug")


def test_an_unexpected_exception_is_reported_once_and_the_motion_keeps_running():
    run = Run()
    failure = Failure("a test", "ZeroDivisionError", "by a bug")
    for _ in range(2):
        assert run.simulation.take_turn("a test", fail) == failure
    assert run.sink.errors == [str(failure)]
    assert [event.name for event in run.sink.events] == ["start", "failure"]
    assert run.simulation.take_turn("a test", lambda: 7) == 7
    assert run.simulation.take_turn("a test", fail) == failure
    assert len(run.sink.errors) == 2  # it had succeeded in between
    run.advance(0.1)
    run.assert_recomputed()


HOW = "by a bug (the top has stopped: start the node again)"


def test_an_exception_during_shutdown_ends_the_run_and_is_not_reported():
    run = Run()
    run.sink.is_open, ends = False, []
    run.sink.fail = ends.append
    failure = Failure("a test", "ZeroDivisionError", HOW)
    assert run.simulation.take_turn("a test", fail) == failure
    assert (ends, run.sink.errors, len(run.sink.events)) == ([failure], [], 1)


@pytest.mark.parametrize("name", ["a tick", "~/kick", "a sample"])
def test_an_exception_outside_of_an_action_ends_the_run_and_not_its_program(name):
    """It is reported once; then there is no sample, and every request is refused with it."""
    run, ends = Run(seconds=0.1), []
    run.sink.fail = ends.append
    simulation = run.simulation
    failure = Failure(name, "ZeroDivisionError", HOW)
    samples = len(run.sink.samples)
    if name == "~/kick":
        simulation.settle = fail
        assert simulation.answer("kick", lambda: "done") == (False, str(failure))
    else:
        run.sink.send_sample = fail
        run.clock.now += 10 * MS
        if name == "a tick":
            assert simulation.tick() is None
        else:
            assert simulation.answer("kick", lambda: "done") == (True, "done")
    assert simulation.failure == failure
    for _ in range(2):
        assert simulation.tick() is None
        assert simulation.answer("reset", lambda: "done") == (False, str(failure))
        assert simulation.take_turn("a test", lambda: 7) == failure
    assert (ends, len(run.sink.samples), run.sink.errors) == ([failure], samples, [])


def test_requests_of_many_threads_are_carried_out_one_at_a_time():
    run = Run(seconds=0.1)

    def kick(_):
        return run.ask("kick", {"precession_rate_change": 0.01})[0]

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(kick, range(60)))
    kicks = [event for event in run.sink.events if event.name == "kick"]
    assert len(kicks) == 60
    for before, after in pairwise(kicks):
        assert after.values["before.orientation"] == before.values["after.orientation"]
    run.assert_recomputed()
