"""Friction and applied torques in the node: what acts when, and that the run can be recomputed."""

import json

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, Vector3Stamped, WrenchStamped
from node.running_top import LATCHED, facts, segment_of, stamp_of

from symtop_ros.physics import Friction
from symtop_ros.physics.splitting import STEP

SET = "set_parameters_atomically"
VERTICAL = 2e-4  # N m
TIMEOUT = 0.1  # s, the default
BOTH = ("before", "after")
EPS = 2.0**-52


class Hand:
    """Whoever applies torques."""

    def __init__(self, run):
        self.run = run
        self.publisher = run.user.create_publisher(WrenchStamped, "/top/applied_torque", 10)
        run.spin_until(lambda: self.publisher.get_subscription_count() > 0)

    def push(self, x=0.0, y=0.0, z=0.0, frame="world"):
        message = WrenchStamped()
        message.header.frame_id = frame
        torque = message.wrench.torque
        torque.x, torque.y, torque.z = x, y, z
        self.publisher.publish(message)


def start(start_top, **parameters):
    run = start_top(**parameters)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: events)
    return run, events


def named(events, name):
    return [each for each in events if each.status[0].name == f"top: {name}"]


def assert_recomputed(events, orientations):
    """Every sample is what its event says, bit for bit."""
    segments = [(stamp_of(event), segment_of(event)) for event in events]
    assert orientations
    for message in orientations:
        stamp, q = stamp_of(message), message.quaternion
        segment = [each for begin, each in segments if begin <= stamp][-1]
        expected = segment.state_at(stamp).orientation.tolist()
        assert [q.w, q.x, q.y, q.z] == expected


def test_a_torque_acts_from_its_sample_until_it_has_run_out(start_top):
    run, events = start(start_top)
    momenta = run.collect(Vector3Stamped, "/top/angular_momentum")
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    run.spin_until(lambda: orientations)
    Hand(run).push(z=VERTICAL)
    run.spin_until(lambda: len(named(events, "torque")) == 2)
    seen = len(orientations)
    run.spin_until(lambda: len(orientations) > seen + 20)
    begin, end = named(events, "torque")
    assert facts(begin)["applied_torque"] == f"0.0 0.0 {VERTICAL}"
    assert facts(begin)["engine"] == "splitting"
    assert facts(end)["applied_torque"] == "0.0 0.0 0.0"
    assert facts(end)["engine"] == "closed form"
    assert stamp_of(end) - stamp_of(begin) == round(TIMEOUT * 1e9)
    # the vertical momentum gains torque times time, and nothing else
    before = [m.vector.z for m in momenta if stamp_of(m) < stamp_of(begin)][-1]
    after = [m.vector.z for m in momenta if stamp_of(m) >= stamp_of(end)]
    # a difference of numbers of 1e-2, each with the rounding of a thousand pushes and products
    assert after[0] - before == pytest.approx(VERTICAL * TIMEOUT, abs=1e-2 * 100 * EPS)
    assert_recomputed(events, orientations)


def test_there_is_no_jump_where_a_torque_begins_and_ends(start_top):
    run, events = start(start_top)
    Hand(run).push(x=1e-3, y=-1e-3)
    run.spin_until(lambda: len(named(events, "torque")) == 2)
    for event in named(events, "torque"):
        told = facts(event)
        for name, size in (("orientation", 1.0), ("angular_velocity", 200.0)):
            before, after = (np.array(told[f"{at}.{name}"].split(), float) for at in BOTH)
            assert np.abs(after - before).max() <= 4 * size * EPS  # a start is good to rounding


def test_samples_that_repeat_themselves_hold_the_torque_without_events(start_top):
    run, events = start(start_top)
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    hand = Hand(run)
    hand.push(z=VERTICAL)
    run.spin_until(lambda: named(events, "torque"))
    begin = stamp_of(named(events, "torque")[0])
    while not orientations or stamp_of(orientations[-1]) - begin < 0.4e9:
        seen = len(orientations)
        hand.push(z=VERTICAL)
        run.spin_until(lambda seen=seen: len(orientations) > seen)
    assert len(named(events, "torque")) == 1
    run.spin_until(lambda: len(named(events, "torque")) == 2)
    assert stamp_of(named(events, "torque")[1]) - begin > 0.4e9


def test_friction_and_torque_can_change_while_the_top_turns_and_the_run_is_recomputed(start_top):
    run, events = start(start_top)
    orientations = run.collect(QuaternionStamped, "/top/orientation")
    wrenches = run.collect(WrenchStamped, "/top/torque")
    run.spin_until(lambda: orientations)
    assert run.set(SET, **{"friction.transverse": 1e-5, "friction.axial": 2e-6})[0]
    run.set("kick", precession_rate=9.0)
    Hand(run).push(z=VERTICAL)
    run.spin_until(lambda: len(named(events, "torque")) == 2)
    assert run.set(SET, steady_torque=[0.0, 0.0, 1e-4])[0]
    seen = len(orientations)
    run.spin_until(lambda: len(orientations) > seen + 20)
    engines = [facts(event)["engine"] for event in events]
    assert engines[0] == "closed form"
    assert set(engines[1:]) == {"splitting"}
    path = segment_of(events[-1]).path
    assert (path.friction, path.applied_torque) == (Friction(2e-6, 1e-5), (0.0, 0.0, 1e-4))
    assert_recomputed(events, orientations)
    last = wrenches[-1]
    expected = path.torque(segment_of(events[-1]).state_at(stamp_of(last)))
    torque = last.wrench.torque
    assert [torque.x, torque.y, torque.z] == expected.tolist()
    assert run.set(SET, **{"friction.transverse": 0.0, "friction.axial": 0.0})[0]
    assert run.set(SET, steady_torque=[0.0, 0.0, 0.0])[0]
    assert json.loads(run.trigger("get_state")[1])["engine"] == "closed form"


@pytest.mark.parametrize(
    ("push", "sentence"),
    [
        ({"x": float("nan")}, "applied_torque: got [nan, 0.0, 0.0], allowed is 3 numbers"),
        ({"z": float("inf")}, "applied_torque: got [0.0, 0.0, inf], allowed is 3 numbers"),
        ({"z": 1.0, "frame": "top"}, "applied_torque: frame_id: got 'top', allowed is \"world\""),
    ],
)
def test_a_bad_torque_is_told_and_changes_nothing(start_top, capfd, push, sentence):
    run, events = start(start_top)
    hand = Hand(run)
    hand.push(**push)
    hand.push(z=VERTICAL)  # comes after it
    run.spin_until(lambda: named(events, "torque"))
    assert facts(named(events, "torque")[0])["applied_torque"] == f"0.0 0.0 {VERTICAL}"
    assert sentence in capfd.readouterr().err


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("friction.axial", -1e-6, "friction.axial: got -1e-06, allowed is a number from 0"),
        ("friction.transverse", float("nan"), "friction.transverse: got nan, allowed is"),
        ("steady_torque", [1.0, 2.0], "steady_torque: got [1.0, 2.0], allowed is 3 numbers"),
        ("applied_torque_timeout", 0.0, "applied_torque_timeout: got 0.0, allowed is a number"),
    ],
)
def test_bad_parameters_are_refused_and_the_motion_goes_on(start_top, name, value, sentence):
    run, events = start(start_top)
    granted, reason = run.set(SET, **{name: value})
    assert not granted
    assert sentence in reason
    assert len(events) == 1


@pytest.mark.parametrize("scene", ["friction", "vertical_torque"])
def test_energy_and_momentum_balances_are_in_diagnostics(start_top, scene):
    run = start_top(scene=scene)
    messages = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: len(messages) >= 2)
    told = {pair.key: pair.value for pair in messages[-1].status[3].values}
    assert messages[-1].status[3].message == "friction or an applied torque acts"
    assert float(told["power"]) != 0
    # 4 rad of nutation are some 10 steps, each with an error of 1e-13 of 1.5 J or 0.02 N m s
    assert abs(float(told["energy.balance"])) < 10 * 1e-13 * 1.5 * 4 / STEP
    momentum = [float(part) for part in told["angular_momentum.balance"].split()]
    assert np.abs(momentum).max() < 10 * 1e-13 * 0.02


def test_a_step_that_the_engine_would_take_minutes_for_is_refused(start_top):
    run = start_top(scene="friction")
    run.switch("pause", True)
    before = json.loads(run.trigger("get_state")[1])
    granted, reason = run.set("step", duration=1e9)
    assert not granted
    assert "duration: got 1000000000.0, allowed is up to " in reason
    assert "s at a time under friction or an applied torque" in reason
    assert json.loads(run.trigger("get_state")[1])["time"] == before["time"]
    assert run.set("step", duration=1.0)[0]
    assert json.loads(run.trigger("get_state")[1])["time"] == before["time"] + 1.0
