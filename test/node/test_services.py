"""Services as a user calls them: a granted request takes effect at one instant."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from node.running_top import LATCHED, assert_recomputed, events_named, facts, stamp_of
from sensor_msgs.msg import JointState

from symtop_ros.physics import regular_precession_rates
from symtop_ros.session.recording import Answer


def theta(message):
    return message.position[1]


@pytest.mark.wording
def test_hurrying_the_slow_root_raises_the_top_and_says_so(start_top):
    run = start_top(scene="hurry_slow")
    angles = run.collect(JointState, "/top/euler_angles")
    run.wait_for(angles, 5)
    assert all(abs(theta(message) - 0.5) < 1e-14 for message in angles)  # a few ulp: regular
    granted, answer = run.trigger("hurry_precession")
    assert granted
    assert answer.startswith("Precession 6.50 -> 9.10 rad/s. The top rises: theta will stay ")
    assert "between 0.437 and 0.500 rad" in answer
    assert "Perry's rule holds" in answer
    angles.clear()
    run.spin_until(lambda: len(angles) > 100)  # three nutations
    assert min(map(theta, angles)) == pytest.approx(0.437, abs=2e-3)  # 5 ms between samples
    assert max(map(theta, angles)) <= 0.5 + 1e-14


@pytest.mark.wording
@pytest.mark.parametrize(
    ("scene", "parts"),
    [
        ("hurry_fast", ["The top falls", "Perry's rule fails"]),
        (
            "perry_fails",
            [
                "Precession 6.31 -> 8.84 rad/s",
                "The axis falls (and the centre of mass rises)",
                "Perry's rule fails for the axis",
            ],
        ),
    ],
)
def test_a_hurry_that_lowers_the_top_says_so(start_top, scene, parts):
    _, answer = start_top(scene=scene).trigger("hurry_precession")
    assert [part for part in parts if part not in answer] == []


def test_a_kick_belongs_to_every_message_from_its_stamp_on_and_to_none_before(start_top):
    run = start_top(publish_rate=1000.0)
    messages = run.collect(QuaternionStamped, "/top/orientation")
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: len(messages) > 20)
    run.set("kick", precession_rate=9.0)
    run.set("kick", angular_impulse=[1e-4, 0.0, -1e-4])
    run.set("kick", precession_rate_change=-2.0, hold="spin_momentum")
    run.spin_until(lambda: len(events) == 4 and stamp_of(messages[-1]) > stamp_of(events[-1]))
    assert len(messages) > 20
    assert_recomputed(events, messages)


def test_the_first_message_of_the_new_motion_comes_within_one_period_of_the_answer(start_top):
    run = start_top(publish_rate=50.0)
    messages = run.collect(JointState, "/top/euler_angles")
    run.spin_until(lambda: len(messages) > 2)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    for count in range(1, 6):
        run.set("set_initial_conditions", theta=1.0)
        asked = run.now
        run.spin_until(lambda count=count: len(events_named(events, "start")) == count + 1)
        start = stamp_of(events_named(events, "start")[-1])
        run.spin_until(lambda start=start: stamp_of(messages[-1]) >= start)
        first = next(each for each in messages if stamp_of(each) >= start)
        assert stamp_of(first) == start
        assert theta(first) == pytest.approx(1.0, abs=1e-15)  # the start, to rounding
        assert start - asked <= 20_000_000
        run.trigger("reset")


def test_a_start_on_a_root_is_regular_and_the_rest_comes_from_the_parameters(start_top):
    run = start_top(scene="cusps")
    assert run.set("set_initial_conditions", precession="fast", theta=0.7)[0]
    state = run.state()
    _, fast = regular_precession_rates(run.top.simulation.settings.top, theta=0.7, psi_dot=200.0)
    assert state["euler_rates"]["phi"] == pytest.approx(fast, rel=1e-13)  # psi turns fast
    assert state["kind"] == "regular"


def test_a_start_from_a_quaternion_goes_through_the_vertical(start_top):
    run = start_top()
    start = {"orientation": [0.0, 0.0, 0.0, 1.0], "angular_velocity": [2.0, 1.0, 200.0]}
    assert run.set("set_initial_conditions", **start)[0]
    state = run.state()
    assert state["kind"] == "through the pole"
    assert state["turning_angles"][0] == 0.0


def test_reset_goes_back_to_the_last_initial_conditions(start_top):
    run = start_top()
    events = run.collect_events()
    run.set("set_initial_conditions", theta=0.9, psi_dot=150.0)
    run.set("kick", precession_rate=9.0)
    assert run.trigger("reset")[0]
    run.spin_until(lambda: len(events) == 4)
    names = [message.status[0].name for message in events]
    assert names == ["top: start", "top: start", "top: kick", "top: reset"]
    assert facts(events[3])["after.orientation"] == facts(events[1])["after.orientation"]


def test_a_pause_stops_the_motion_and_resuming_continues_without_catching_up(start_top):
    run = start_top(publish_rate=500.0)
    angles = run.collect(JointState, "/top/euler_angles")
    run.spin_until(lambda: len(angles) > 10)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    assert run.switch("pause", True)[0]
    run.spin_until(lambda: events and events[-1].status[0].name == "top: pause")
    paused = stamp_of(events[-1])
    angles.clear()
    run.spin_until(lambda: len(angles) > 50 and stamp_of(angles[-50]) > paused)
    resting = {tuple(each.position) for each in angles if stamp_of(each) >= paused}
    assert len(resting) == 1

    def nanoseconds():  # whole ones: 0.032 + 0.25 is not the double that is nearest to 0.282
        return round(run.state()["time"] * 1e9)

    at_rest = nanoseconds()
    assert run.switch("pause", True) == (True, str(Answer("paused")))
    assert run.set("step", duration=0.25)[0]
    assert nanoseconds() == at_rest + 250_000_000
    assert run.switch("pause", False)[0]
    assert at_rest + 250_000_000 <= nanoseconds() < at_rest + 1_250_000_000  # time of the calls


def test_the_state_is_json_with_the_constants_and_the_verdict(start_top):
    run = start_top(scene="sleeping")
    state = run.state()
    assert state["kind"] == "sleeping"
    assert state["mean_precession_rate"] is None
    assert state["constants"]["L_z"] == 5.72e-05 * 200.0
    assert math.isclose(state["constants"]["energy"], 0.068 + 5.72e-05 * 200.0**2 / 2)
