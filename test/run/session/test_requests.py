"""Requests from plain mappings: answers and effects, or refusals in one sentence."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from odd_values import SIZES, VALUES, assert_one_answer, assert_one_sentence, examples_of
from run.simulation.runs import Run
from trials import trials

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Ledger, Motion, kick_verdict, perrys_rule
from symtop_ros.run.session.diagnostics import motion_status, summarize_state
from symtop_ros.run.session.session import Answer
from symtop_ros.run.simulation.changes import requests
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.changes.outcomes import Pause, Step
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment, to_nanoseconds
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import STATE_TOPICS, Samples
from symtop_ros.words import write

HOLDS = st.sampled_from(["spin_rate", "spin_momentum"])
TILTS = st.floats(0, math.pi) | st.sampled_from([0.0, math.pi, math.pi / 2, 5e-324, 1e-160, 1e-12])
RATES = SIZES | st.sampled_from([0.0, 5e-324, 1e-200]) | st.floats(-1e3, 1e3)
EULER = {
    "theta": TILTS,
    **dict.fromkeys(("phi", "psi"), st.floats(-1e3, 1e3)),
    **dict.fromkeys(("theta_dot", "phi_dot", "psi_dot"), RATES),
}
TOPS = st.builds(
    lambda Ix, ratio, Mgl: {"top.Ix": Ix, "top.Iz": Ix * ratio, "top.Mgl": Mgl},
    st.floats(-30, 30).map(lambda digits: 10.0**digits),
    st.floats(-30, 0.3).map(lambda digits: 10.0**digits) | st.sampled_from([1.0, 2.0, 1 - 2**-53]),
    SIZES | st.just(0.0),
)
STARTS = (
    st.fixed_dictionaries({}, optional=EULER)
    | st.fixed_dictionaries(
        {"precession": st.sampled_from(["slow", "fast"])},
        optional={name: EULER[name] for name in ("theta", "psi", "psi_dot")},
    )
    | st.dictionaries(st.sampled_from(requests.START_FIELDS), VALUES)
)
KICKS = (
    st.fixed_dictionaries({"precession_rate": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"precession_rate_factor": SIZES}, optional={"hold": HOLDS})
    | st.fixed_dictionaries({"angular_impulse": st.lists(SIZES, min_size=3, max_size=3)})
    | st.dictionaries(st.sampled_from(requests.KICK_FIELDS), VALUES)
)
FRICTION = dict.fromkeys(("friction.axial", "friction.transverse"), SIZES.map(abs))
VECTORS = st.lists(SIZES, min_size=3, max_size=3)
TORQUES = st.fixed_dictionaries({}, optional={**FRICTION, "steady_torque": VECTORS})


@pytest.mark.parametrize("examples", trials(100, 400))
def test_a_granted_request_gives_a_sound_motion_with_a_verdict(examples):
    @examples_of(examples)
    @given(TOPS, TORQUES, STARTS, KICKS, st.sampled_from([0.0, 1e-3, 1.0, 1e9]))
    def check(top, torques, asked, kicked, t):
        try:
            settings = Settings.from_values({**top, **torques})
            start = requests.initial_state(settings.top, settings.initial, asked)
        except RefusedError as refused:
            assert_one_sentence(str(refused))
            return
        motion = Motion(settings.top, start, settings.friction, settings.steady_torque)
        assert_one_answer(str(perrys_rule(motion.top, start)))
        # A run is paused before a motion has no further states.
        reached = motion._reach(min(t, motion.farthest_time / 2), 100)
        segment = Segment(motion, 0, to_nanoseconds(reached), 1.0, running=False)
        state = segment.state_at(0)
        for topic in STATE_TOPICS.values():
            numbers = topic.compute(Samples(segment, 0, state))
            if topic.name == "torque" and not segment.rig.find_body(motion.top):
                numbers = numbers[topic.format.quantities["torque"]]  # the force is unknown
            assert np.isfinite(numbers).all()
        json.loads(json.dumps(summarize_state(segment, 0), allow_nan=False))
        again = Event.of(Change(Act("start", 0, asked), start, segment)).segment()
        assert (again.motion.start, again.elapsed) == (motion.start, segment.elapsed)
        try:
            after, hold = requests.plan_kick(motion, state, kicked)
        except RefusedError as refused:
            assert_one_sentence(str(refused))
        else:
            assert_one_answer(str(kick_verdict(after, state, hold)))

    check()


def test_a_start_on_a_root_is_regular_and_reset_returns_to_it():
    run = Run()
    granted, answer = run.ask("set_initial_conditions", {"precession": "slow", "theta": 0.7})
    assert granted
    assert run.sink.events[-1].outcome().motion == "regular"
    assert answer == run.sink.events[-1].verdict
    start = run.simulation.timeline.start
    run.advance(0.1)
    assert run.ask("kick", {"precession_rate_factor": 2.0})[0]
    assert run.ask("reset")[0]
    assert run.simulation.segment.motion.start == start


ASKED = [
    ({"psi_dot": 180.0}, (None, 0.0, 180.0)),
    ({"phi_dot": 2.0}, (2.0, 0.0, 200.0)),
    ({"theta_dot": 1.0}, (0.0, 1.0, 200.0)),
    ({"precession": "slow", "theta_dot": 0.0}, (None, 0.0, 200.0)),
]


@pytest.mark.parametrize(("request_", "rates"), ASKED)
def test_a_rate_that_is_asked_for_takes_the_place_of_a_root_of_the_parameters(request_, rates):
    run = Run(initial__precession="slow", initial__psi_dot=200.0)
    assert run.ask("set_initial_conditions", request_)[0]
    motion = run.simulation.segment.motion
    assert (motion.kind == "regular") == (rates[0] is None)
    found = motion.start.euler_rates
    # rounding of 200 rad/s, over sin(0.5)
    for is_now, rate in zip(found, rates, strict=True):
        assert rate is None or is_now == pytest.approx(rate, abs=1e-12)


UP = [0.0, 0.0, 0.0, 1.0]
SPIN = [0.0, 0.0, 200.0]
START = "set_initial_conditions"
DRIVEN, SLEEPING = {"scene": "friction"}, {"scene": "sleeping"}
ONES = dict.fromkeys(("top.Ix", "top.Iz", "top.Mgl"), 1.0)
PUSHES = {"axle_impulse": 2.0**-15, "rate": 20, "number": 20}
REFUSED = [
    ({}, START, {"orientation": UP, "angular_velocity": SPIN, "phi": 1.0}, "orientation must be g"),
    ({}, START, {"angular_velocity": SPIN, "psi": 1.0}, "angular_velocity must be given without p"),
    ({}, START, {"orientation": UP}, "angular_velocity must be given together with orientation, g"),
    ({}, START, {"angular_velocity": SPIN}, "orientation must be given together with angular_velo"),
    ({}, START, {"precession": "slow", "phi_dot": 1.0}, "precession must be given without phi_dot"),
    ({}, START, {"precession": "slow", "theta_dot": 1.0}, "precession must be given without theta"),
    ({}, START, {"precession": "fast", "psi_dot": 1.0}, "precession must be a rate that exists, g"),
    (ONES, START, {"precession": "slow", "theta": 0.7, "psi_dot": 1e-20}, "precession must be a"),
    ({}, "kick", {"rate": 20.0}, "pushes must have axle_impulse, rate, number, got ['rate']"),
    ({}, "kick", {**PUSHES, "hold": "spin_rate"}, "pushes must have axle_impulse, rate, number, "),
    ({}, "kick", {**PUSHES, "number": 1001}, "number must be 1 to 1000, got 1001"),
    ({}, "kick", {**PUSHES, "number": 2.5}, "number must be a whole number up to 1000, got 2.5"),
    ({}, "kick", {**PUSHES, "rate": 0.0}, "rate must be 0.01 to 1000 pushes per s of the motion,"),
    ({}, "kick", {**PUSHES, "axle_impulse": 1e9}, "axle_impulse must be such that angular_"),
    ({}, "kick", {"axle_impulse": 1e-5, "hold": "spin_rate"}, "hold must be given without axle_"),
    ({}, "release", None, "release must follow pushes that have not ended, got none"),
    (SLEEPING, "kick", PUSHES, "theta must be > 0 and < pi rad for axle_impulse (no phi' "),
    (SLEEPING, "kick", {"precession_rate": 1.0}, "theta must be > 0 and < pi rad for precession_"),
    ({}, "kick", {"precession_rate": 1e200}, "precession_rate must be such that angular_velocity"),
    ({}, "kick", {"precession_rate_change": -1e300}, "precession_rate_change must be such that "),
    ({}, "step", {"duration": 1.0, "speed": 2.0}, "field name must be one of duration, got "),
    ({}, "step", {}, "duration must be 0 to 1e+09 s, got none"),
    ({}, "step", {"duration": 1e15}, "duration must be 0 to 1e+09 s, got "),
    ({"top.Mgl": 2.0**55}, "step", {"duration": 2.0**20}, "duration must be within 1e15 turns of "),
    (DRIVEN, "step", {"duration": 1e9}, "duration must be up to "),  # of what takes too long
]


@pytest.mark.parametrize(("begun", "service", "request_", "reason"), REFUSED)
def test_a_request_that_cannot_be_is_refused_and_the_motion_stays(begun, service, request_, reason):
    run = Run(**begun)
    run.ask("pause", service == "step")
    before = run.simulation.segment
    granted, answer = run.ask(service, request_)
    assert not granted
    assert answer.startswith(reason)
    assert run.simulation.segment is before


def test_a_motion_must_have_states_for_a_day_of_the_clock():
    fast = {"top.Mgl": 2.0**55}  # its farthest time is 2^20 s: 12.1 days
    assert Run(**fast, real_time_factor=12.0).ask(START, {"theta": 0.5})[0]
    with pytest.raises(RefusedError, match="for a day at this real-time factor"):
        Run(**fast, real_time_factor=12.25)


def test_an_empty_request_starts_from_the_quaternion_of_the_parameters():
    run = Run(initial__orientation=[0.6, 0.0, 0.0, 0.8])
    assert run.ask("set_initial_conditions", {})[0]
    start = run.simulation.segment.motion.start
    assert start.orientation.tolist() == [0.8, 0.6, 0.0, 0.0]
    assert start.angular_velocity.tolist() == [0.0, 0.0, 0.0]
    assert run.ask("set_initial_conditions", {"theta": 0.7})[0]
    assert run.simulation.segment.motion.start.euler_angles.theta == pytest.approx(0.7, rel=1e-15)


def test_a_pause_stops_the_motion_and_a_step_advances_it():
    run = Run(seconds=0.5)
    assert run.ask("pause", True) == (True, write("pause", Pause(0.505)))
    assert run.ask("pause", True) == (True, str(Answer("paused")))
    run.advance(1.0)
    assert run.ask("step", {"duration": 0.25}) == (True, write("step", Step("stepped", 0.755)))
    assert run.ask("pause", False) == (True, write("resume", Pause(0.755)))
    assert run.ask("pause", False) == (True, str(Answer("running")))
    run.advance(0.1)
    resting = [tuple(numbers) for stamp, numbers in run.sink.samples if stamp >= 505_000_000]
    assert len(set(resting[:200])) == 1  # 1 s of the pause
    assert len(set(resting[201:])) == len(resting[201:]) > 15


def test_the_state_says_since_when_its_time_counts():
    run = Run("cusps", publish_rate=100.0)

    def since():
        return json.loads(run.ask("get_state")[1])["time_since"]

    run.advance(0.1)
    assert since() == "start at stamp 0.000000000 s"
    run.ask("pause", True)
    run.ask("pause", False)
    assert since() == "start at stamp 0.000000000 s"
    run.ask("hurry_precession")
    assert since() == "kick at stamp 0.110000000 s"
    run.advance(0.1)
    run.ask("reset")
    assert since() == "reset at stamp 0.210000000 s"


@pytest.mark.wording
def test_the_state_says_why_the_axis_moves_as_it_does_under_gravity_alone():
    def why(scene):
        return json.loads(Run(scene).ask("get_state")[1])["why"]

    assert why("regular_precession").startswith("Gravity's torque turns the angular momentum round")
    assert why("free").startswith("No torque acts: the angular momentum is constant")
    assert why("friction") == ""


@pytest.mark.parametrize(
    ("acting", "forces"),
    [
        ({}, None),
        ({"friction.axial": 1e-6}, "friction"),
        ({"steady_torque": [0.0, 0.0, 1e-4]}, "torque"),
        ({"friction.transverse": 1e-6, "steady_torque": [1e-4, 0.0, 0.0]}, "both"),
    ],
)
def test_what_a_verdict_neglects_is_said_with_it(acting, forces):
    run = Run("cusps")
    run.change(acting)
    run.ask("reset")
    outcome = run.sink.events[-1].outcome()
    verdict = str(outcome.verdict)
    condition = write("neglected", {"forces": forces}) if forces else ""
    assert (outcome.neglected and outcome.neglected.forces) == forces
    assert f"{condition} {verdict}" in run.sink.events[-1].verdict
    segment, stamp = run.simulation.segment, run.simulation.stamp
    now = f"{condition} {perrys_rule(segment.motion.top, run.simulation.state)}".strip()
    assert summarize_state(segment, stamp)["verdict"] == now
    assert motion_status(segment, stamp, 1).message == now


def test_reset_starts_from_initial_parameters_that_were_set_after_the_last_start():
    run = Run("cusps")
    run.ask("set_initial_conditions", {"theta": 1.0})
    run.change({"initial.theta": 0.75})
    assert run.ask("reset")[0]
    assert run.simulation.state.euler_angles.theta == 0.75


def test_a_hurry_is_by_the_factor_that_is_set():
    run = Run("hurry_slow", hurry_factor=2.0)
    assert run.ask("hurry_precession")[0]
    assert run.sink.events[-1].outcome().factor == pytest.approx(2.0, rel=1e-14)
    run.change({"hurry_factor": 0.5})
    assert run.ask("reset")[0]
    assert run.ask("hurry_precession")[0]
    assert run.sink.events[-1].outcome().factor == pytest.approx(0.5, rel=1e-14)  # of two rates


def test_the_state_has_the_time_of_a_turn_and_the_force_of_the_pivot():
    run = Run("regular_precession")
    segment, stamp = run.simulation.segment, run.simulation.stamp
    found = summarize_state(segment, stamp)
    rate = found["mean_precession_rate"]
    assert found["precession_period"] == 2 * math.pi / rate
    slow, fast = found["regular_precession_rates"]
    assert found["regular_precession_periods"] == [2 * math.pi / slow, 2 * math.pi / fast]
    assert found["seen_from_above"] == "counterclockwise"
    body = segment.rig.find_body(segment.motion.top)
    x, y, z = found["pivot_force"]
    turning = body.mass * body.arm * math.sin(0.5) * slow**2  # towards the vertical
    assert math.hypot(x, y) == pytest.approx(turning)
    assert z == pytest.approx(body.mass * segment.rig.gravity)
    assert found["critical_spin"] == segment.motion.top.critical_spin
    held = Run("regular_precession", **{"initial.clamped": True}).simulation
    assert summarize_state(held.segment, held.stamp + 12_345_678)["seen_from_above"] == ""


@pytest.mark.parametrize("changes", [{}, {"top.Mgl": 0.0}, {"initial.clamped": True}])
def test_the_state_says_what_gave_energy_and_momentum_since_the_motion_began(changes):
    run = Run("cusps", **changes)
    run.advance(0.08)
    segment, stamp = run.simulation.segment, run.simulation.stamp
    ledger = Ledger.from_times(segment.motion, 0.0, segment.time_at(stamp))
    assert summarize_state(segment, stamp)["exchange"] == str(ledger)


def test_under_friction_nobody_integrates_what_was_exchanged():
    rubbed = Run("friction").simulation
    assert summarize_state(rubbed.segment, rubbed.stamp)["exchange"] == ""


def test_what_is_undefined_of_a_state_is_null():
    sleeping = Run("sleeping").simulation
    found = summarize_state(sleeping.segment, sleeping.stamp)
    assert found["precession_period"] is None
    assert found["seen_from_above"] == ""
