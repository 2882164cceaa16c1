"""A run in its own time: its stamps are the elapsed time, and rates are derivatives by them."""

import itertools

import numpy as np
import pytest
from run.simulation.runs import SECOND, Run

from symtop_ros.base.refusals import attempt
from symtop_ros.run.check.events import find_mismatches
from symtop_ros.run.simulation.budget import ComputeBudget

MS = SECOND // 1000
PERIOD = 5 * MS


def start(seconds=0.0, **changes):
    run = Run(publish_clock=True, **changes)
    run.clock.is_simulated = False
    run.advance(seconds)
    return run


@pytest.mark.parametrize("factor", [0.1, 1.0, 5.0])
def test_time_stands_still_in_a_pause_and_no_period_is_lost(factor):
    run = start(publish_rate=400.0)
    run.change({"real_time_factor": factor})
    run.advance(0.3)
    assert run.ask("pause", True)[0]
    before = len(run.sink.samples)
    last = run.sink.samples[-1][0]
    assert before == round(0.3 * factor * 400) + 1
    run.advance(3.0)
    assert len(run.sink.samples) == before
    assert run.simulation.now == last
    assert not run.simulation.segment.running
    assert run.ask("pause", False)[0]
    run.advance(0.3)
    assert set(np.diff(run.stamps)) == {SECOND // 400}
    # a second of the stamps is a second of the motion, whatever the real-time factor
    assert {event.segment().factor for event in run.sink.events} == {1.0}
    run.assert_recomputed()


def test_a_step_advances_time_by_its_duration_with_one_sample_at_the_end():
    run = start(seconds=0.1)
    assert run.ask("pause", True)[0]
    last = run.stamps[-1]
    for duration in (0.001, 0.25, 1e-9):
        assert run.ask("step", {"duration": duration})[0]
        last += round(duration * SECOND)
        assert run.stamps[-1] == run.simulation.now == last
    assert run.ask("step", {"duration": 0.0})[0]
    assert run.stamps[-1] == run.simulation.now == last
    assert run.ask("pause", False)[0]
    run.advance(0.1)
    assert np.diff(run.stamps)[-20:].tolist() == [PERIOD] * 20
    run.assert_recomputed()


def test_a_torque_that_ends_in_a_step_acts_until_then():
    run = start(seconds=0.1)
    assert run.ask("pause", True)[0]
    run.push((0.0, 0.0, 2e-4))
    assert run.ask("step", {"duration": 0.3})[0]
    assert not any(run.simulation.segment.motion.applied_torque)
    last_of_step = len(run.sink.order)
    assert run.ask("pause", False)[0]
    run.advance(0.1)
    begin, end = (each.stamp for each in run.sink.events if each.name == "torque")
    assert end - begin == 100 * MS
    # it ends before the sample at the end of the step, and not with the next one
    assert run.sink.order.index("torque", run.sink.order.index("step")) < last_of_step
    assert min(np.diff([each.stamp for each in run.sink.events])) >= 0
    run.assert_recomputed()


def test_the_time_waits_for_a_process_that_was_stopped():
    run = start(publish_rate=1000.0, real_time_factor=2.0, seconds=0.1)
    run.clock.now += 3 * SECOND
    run.tick()
    run.advance(0.1)
    assert set(np.diff(run.stamps)) == {MS}
    assert run.simulation.ticker.missed == 0


def test_the_pace_that_is_reached_is_measured_and_waits_are_warned_of_once_a_minute():
    run = start(publish_rate=100.0, real_time_factor=2.0, seconds=1.0)
    run.simulation.measure_pace()
    assert (run.simulation.achieved, run.sink.warnings) == (2.0, [])
    before = run.simulation.now
    for waits in range(1, 3):  # twice, of which the second one is not warned of
        # The next sample is due in 5 ms; 0.1 s after it the time waits.
        run.clock.now += 3005 * MS
        run.tick()
        run.advance(1.0)
        run.simulation.measure_pace()
        assert run.simulation.now - before == waits * 2 * 1105 * MS
        assert run.simulation.waits.total == pytest.approx(waits * 2.9, rel=1e-15)
        assert run.simulation.achieved == pytest.approx(2 * 1.105 / 4.005, rel=1e-15)
    (warning,) = run.sink.warnings
    assert warning.startswith("/clock waited for late samples for 2.9 of the last 4 s: the ")
    assert warning.endswith("; real-time factor 0.552 instead of 2")
    run.advance(60.0)
    run.simulation.measure_pace()
    assert "2.9 of the last 64 s" in run.sink.warnings[1]
    assert run.simulation.achieved == 2.0


def test_pauses_steps_and_resets_of_the_time_are_no_waits():
    run = start(seconds=0.5)
    for request, argument in (("pause", True), ("step", {"duration": 3.0})):
        assert run.ask(request, argument)[0]
        run.advance(5.0)
    run.simulation.measure_pace()
    assert run.simulation.achieved == 0.0
    assert run.ask("pause", False)[0]
    run.advance(0.5)
    run.simulation.take_turn("reset", lambda: run.simulation.reset_time(True))
    run.advance(0.5)
    run.simulation.measure_pace()
    assert (run.simulation.achieved, run.simulation.waits.total) == (1.0, 0.0)
    assert run.sink.warnings == []


def test_a_motion_that_is_too_fast_slows_the_time_down_and_requests_are_answered():
    # ten million steps for each second
    sphere = {"top__Ix": 1e-4, "top__Iz": 1e-4, "friction__transverse": 1e-6}
    run = start(**sphere, initial__psi_dot=5e6, real_time_factor=10.0)
    # A clock by which each call of the kernel, of 100 steps, takes 1 ms.
    count = itertools.count()
    run.simulation.budget = ComputeBudget(lambda: next(count) * 1e-3)
    for _ in range(22):  # one call in each tick, until it has tried for more than 20 ms
        run.clock.now += 5 * MS
        run.simulation.tick()
    assert run.simulation.factor < 0.1
    before = next(count)
    slowed = next(event for event in run.sink.events if event.name == "pace")
    assert slowed.outcome().kind == "slowed"
    assert run.sink.warnings[0] == slowed.verdict
    assert run.ask("hurry_precession")[1]
    run.change({"friction.transverse": 0.0})  # which needs no integration
    for _ in range(2):  # as once a second: the first may still count what was spent before
        run.simulation.speed_up()
    assert run.simulation.factor == 10.0
    assert run.ask("set_initial_conditions", {"psi_dot": 1.0})[0]
    # three requests, each of 20 calls at most, for which the clock is read twice
    assert next(count) - before <= 3 * 20 * 2
    assert min(np.diff(run.stamps)) > 0
    assert min(np.diff([each.stamp for each in run.sink.events])) >= 0
    run.assert_recomputed()


SPHERE = {"top__Ix": 1e-4, "top__Iz": 1e-4, "friction__transverse": 1e-6}
ROD = {"top__Ix": 1.0, "top__Iz": 1e-22, "top__Mgl": 1.0}
NESTED = [
    # on a busy machine, where each call takes 0.1 s
    (SPHERE, 0.1, ("set_initial_conditions", {"psi_dot": 5e6}), ["start", "pace"]),
    # too fast for doubles after 1 ms
    ({**ROD, "steady_torque": [1.0, 1.0, 1.0]}, 0.0, ("reset",), ["reset", "pause"]),
]


@pytest.mark.parametrize("publish_clock", [True, False])
@pytest.mark.parametrize(("body", "delay", "request_", "names"), NESTED)
def test_a_restart_is_announced_before_the_motion_is_slowed_down_or_paused(
    body, delay, request_, names, publish_clock
):
    """That it is too fast is found with its first samples, while the restart is written."""
    run = Run(publish_clock=publish_clock, **body)
    run.clock.is_simulated = False
    run.simulation.budget = ComputeBudget(itertools.count(step=delay).__next__)
    assert run.ask(*request_)[0]
    run.advance(0.005)
    events = run.sink.events
    assert [each.name for each in events[:3]] == ["start", *names]
    assert [each.number for each in events] == [*range(1, len(events) + 1)]
    assert [*find_mismatches(events)] == []


@pytest.mark.parametrize("publish_clock", [True, False])
def test_a_motion_that_becomes_too_fast_for_doubles_is_paused_there(publish_clock):
    rod = {"top__Ix": 1.0, "top__Iz": 1e-22, "top__Mgl": 1.0}
    run = Run("cusps", publish_clock=publish_clock, steady_torque=[1.0, 1.0, 1.0], **rod)
    run.clock.is_simulated = not publish_clock
    run.advance(0.1)
    (paused,) = [event for event in run.sink.events if event.name == "pause"]
    end = paused.outcome().time
    # half the spin angle is then 1e15 rad: t^2 = 4e15 Iz/0.398 N m
    assert end == pytest.approx(1.0023e-3, rel=1e-4)
    (warning,) = run.sink.warnings
    assert warning.endswith(paused.verdict)
    assert paused.state_before() == paused.segment().motion.at(end)
    assert run.ask("reset")[0]
    assert run.simulation.state == run.simulation.timeline.start
    run.assert_recomputed()
    assert list(find_mismatches(run.sink.events)) == []


def assert_recomputed_in_order(run):
    """Each sample is that of the last event that was sent before it: stamps repeat."""
    samples, events = iter(run.sink.samples), iter(run.sink.events)
    for name in run.sink.order:
        if name != "sample":
            segment = next(events).segment()
            continue
        stamp, numbers = next(samples)
        w, x, y, z = segment.state_at(stamp).orientation.tolist()
        assert numbers == [x, y, z, w]


@pytest.mark.parametrize("with_state", [False, True])
@pytest.mark.parametrize("paused", [False, True])
def test_a_reset_of_the_time_goes_back_to_0_with_a_sample_there(paused, with_state):
    run = start(seconds=0.333, real_time_factor=2.0)
    assert run.ask("kick", {"precession_rate_change": 3.0})[0]
    assert run.ask("pause", paused)[0]
    simulation = run.simulation
    before = simulation.state
    count = len(run.sink.samples)
    simulation.take_turn("reset", lambda: simulation.reset_time(with_state))
    assert run.stamps[count:] == [0]
    assert simulation.now == 0
    first = [each for each in run.sink.events if each.name == "clock"][-1].segment().state_at(0)
    assert np.array_equal(first.orientation, before.orientation)
    segment = simulation.segment
    is_new = segment.motion.start == simulation.timeline.start and not segment.elapsed
    assert is_new == with_state
    run.advance(0.1)
    assert (len(run.stamps) == count + 1) == paused
    assert run.ask("pause", True)[0]
    assert run.ask("step", {"duration": 1e-3})[0]  # less than a period after a sample
    assert run.ask("pause", False)[0]
    run.advance(0.1)
    again = run.stamps[count:]
    assert again == sorted(set(again))
    assert simulation.last == again[-1] == simulation.now
    assert_recomputed_in_order(run)
    assert list(find_mismatches(run.sink.events)) == []


def test_a_reset_to_a_start_that_is_refused_leaves_time_and_motion_as_they_are():
    regular = {"initial.precession": "slow", "initial.theta": 0.5, "initial.psi_dot": 200.0}
    run = start(seconds=0.3, **regular)
    run.change({"top.Mgl": 1.0})  # no regular precession any more
    simulation = run.simulation
    events = len(run.sink.events)
    now = simulation.now
    done, refusal = simulation.take_turn("reset", lambda: attempt(lambda: reset(simulation)))
    assert (done, refusal.startswith("initial.precession must be")) == (False, True)
    assert (simulation.now, len(run.sink.events)) == (now, events)
    run.advance(0.1)
    assert run.stamps == sorted(set(run.stamps))
    assert simulation.now > now


def reset(simulation):
    simulation.reset_time(with_state=True)
