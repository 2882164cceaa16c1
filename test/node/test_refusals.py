"""Every refusal through the real service: the sentence, and a motion that goes on unchanged."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from node.running_top import LATCHED, segment_of, stamp_of
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically

START = "set_initial_conditions"
IDENTITY = [0.0, 0.0, 0.0, 1.0]
REFUSED = {
    "unknown start field": (START, {"thetta": 0.5}, "field: got 'thetta', allowed is one of theta"),
    "unknown kick field": (
        "kick",
        {"rate": 9.0},
        "field: got 'rate', allowed is one of precession",
    ),
    "text for a number": (
        START,
        {"theta": "a lot"},
        "theta: got 'a lot', allowed is a number from",
    ),
    "flag for a number": ("kick", {"precession_rate": True}, "got True, allowed is a number from"),
    "number for a word": (START, {"precession": 1.0}, 'got 1.0, allowed is "slow" or "fast"'),
    "other word": (START, {"precession": "medium"}, 'got \'medium\', allowed is "slow" or "fast"'),
    "nan": (START, {"theta": math.nan}, "theta: got nan, allowed is a number from 0 to 3.14159"),
    "infinity": ("kick", {"precession_rate": math.inf}, "precession_rate: got inf, allowed is"),
    "tilt below zero": (START, {"theta": -0.1}, "theta: got -0.1, allowed is a number from 0 to"),
    "tilt above pi": (START, {"theta": 3.2}, "theta: got 3.2, allowed is a number from 0 to 3.14"),
    "rate too large": (START, {"psi_dot": 1e12}, "psi_dot: got 1000000000000.0, allowed is"),
    "quaternion alone": (START, {"orientation": IDENTITY}, "angular_velocity: got none, allowed"),
    "velocity alone": (START, {"angular_velocity": [0.0] * 3}, "orientation: got none, allowed is"),
    "quaternion of norm 2": (
        START,
        {"orientation": [0.0, 0.0, 0.0, 2.0], "angular_velocity": [0.0] * 3},
        "orientation: got a norm of 2, allowed is 1 within 0.001",
    ),
    "three of four": (
        START,
        {"orientation": [0.0, 0.0, 1.0], "angular_velocity": [0.0] * 3},
        "orientation: got [0.0, 0.0, 1.0], allowed is 4 numbers",
    ),
    "nan in a quaternion": (
        START,
        {"orientation": [0.0, 0.0, math.nan, 1.0], "angular_velocity": [0.0] * 3},
        "orientation: got [0.0, 0.0, nan, 1.0], allowed is 4 numbers",
    ),
    "quaternion and tilt": (
        START,
        {"orientation": IDENTITY, "angular_velocity": [0.0] * 3, "theta": 0.5},
        "orientation: got it together with theta, allowed is one or the other",
    ),
    "root and rate": (
        START,
        {"precession": "slow", "phi_dot": 3.0},
        "precession: got it together with phi_dot, allowed is one or the other",
    ),
    "no real root": (
        START,
        {"precession": "slow", "psi_dot": 20.0},
        'precession: got "slow", but at theta 0.5 rad and psi_dot 20 rad/s regular precession has '
        "no real root; allowed is another theta or psi_dot",
    ),
    "only one root": (
        START,
        {"precession": "fast", "theta": math.pi / 2, "psi_dot": 0.0},
        "regular precession has",
    ),
    "empty kick": (
        "kick",
        {},
        "fields: got none of them, allowed is exactly one of precession_rate",
    ),
    "two kicks": (
        "kick",
        {"precession_rate": 9.0, "precession_rate_factor": 2.0},
        "fields: got precession_rate and precession_rate_factor, allowed is exactly one of",
    ),
    "unknown hold": (
        "kick",
        {"precession_rate": 9.0, "hold": "breath"},
        'hold: got \'breath\', allowed is "spin_rate" or "spin_momentum"',
    ),
    "hold with an impulse": (
        "kick",
        {"angular_impulse": [0.0] * 3, "hold": "spin_rate"},
        "hold: got it together with angular_impulse, allowed is one or the other",
    ),
    "impulse of two": ("kick", {"angular_impulse": [0.0, 1.0]}, "allowed is 3 numbers"),
    "impulse of nan": ("kick", {"angular_impulse": [0.0, 1.0, math.nan]}, "allowed is 3 numbers"),
    "impulse too large": (
        "kick",
        {"angular_impulse": [1e8, 0.0, 0.0]},
        "angular_impulse: got [100000000.0, 0.0, 0.0], allowed is what leaves the top below 1e+09",
    ),
    "step while running": (
        "step",
        {"duration": 1.0},
        "step: got it while running, allowed is while paused (~/pause)",
    ),
    "step of nothing": ("step", {}, "duration: got none, allowed is a number of seconds"),
    "step backwards": (
        "step",
        {"duration": -1.0},
        "duration: got -1.0, allowed is a number from 0",
    ),
}


@pytest.fixture(scope="module")
def run():
    from node.running_top import RunningTop

    running = RunningTop(publish_rate=500.0)
    yield running
    running.close()


@pytest.fixture(scope="module")
def messages(run):
    return run.collect(QuaternionStamped, "/top/orientation")


def assert_untouched(run, messages, before):
    """The same segment goes on, and what is published is still its motion."""
    assert run.top.course.segment is before
    seen = len(messages)
    run.spin_until(lambda: len(messages) > seen + 3)
    q = messages[-1].quaternion
    state = before.state_at(stamp_of(messages[-1]))
    assert [q.w, q.x, q.y, q.z] == state.orientation.tolist()


@pytest.mark.parametrize(("service", "values", "sentence"), REFUSED.values(), ids=REFUSED)
def test_a_bad_request_is_refused_in_words_and_changes_nothing(
    run, messages, service, values, sentence
):
    before = run.top.course.segment
    granted, reason = run.set(service, **values)
    assert not granted
    assert sentence in reason
    assert "\n" not in reason
    assert_untouched(run, messages, before)


@pytest.mark.parametrize("name", ["theta", "precession_rate"])
def test_a_repeated_name_is_refused(run, messages, name):
    service = START if name == "theta" else "kick"
    value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)
    twice = [Parameter(name=name, value=value)] * 2
    before = run.top.course.segment
    request = SetParametersAtomically.Request(parameters=twice)
    result = run.connection._call(SetParametersAtomically, service, request).result
    assert (result.successful, result.reason) == (
        False,
        f"{name}: got it more than once, allowed is once",
    )
    assert_untouched(run, messages, before)


def test_a_field_without_a_value_is_refused(run, messages):
    before = run.top.course.segment
    request = SetParametersAtomically.Request(parameters=[Parameter(name="theta")])
    result = run.connection._call(SetParametersAtomically, START, request).result
    assert "theta: got 'no value', allowed is a value" in result.reason
    assert_untouched(run, messages, before)


def test_a_kick_by_rate_is_refused_on_the_vertical(start_top):
    run = start_top(scene="sleeping")
    before = run.top.course.segment
    for values in ({"precession_rate": 9.0}, {"precession_rate_factor": 2.0}):
        granted, reason = run.set("kick", **values)
        assert not granted
        assert "the axis is vertical: the precession rate phi' is undefined there" in reason
    granted, reason = run.trigger("hurry_precession")
    assert not granted
    assert "undefined there, allowed is an angular impulse" in reason
    assert run.top.course.segment is before
    assert run.set("kick", angular_impulse=[1e-4, 0.0, 0.0])[0]


def test_a_request_that_fails_by_a_mistake_of_ours_is_told_and_the_motion_goes_on(
    start_top, monkeypatch
):
    run = start_top()
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: events)

    def mistake(*_):
        raise ZeroDivisionError("by a\nmistake")

    monkeypatch.setattr("symtop_ros.node.requests.kick_verdict", mistake)
    before = run.top.course.segment
    told = "~/hurry_precession failed: ZeroDivisionError: by a mistake"
    assert run.trigger("hurry_precession") == (False, told)
    run.spin_until(lambda: len(events) > 1)
    assert (events[-1].status[0].name, events[-1].status[0].message) == ("top: failure", told)
    # the kick itself was given before there were words for it, and the event says so
    assert segment_of(events[-1]).path.start.orientation.tolist() == (
        run.top.course.segment.path.start.orientation.tolist()
    )
    assert run.top.course.segment is not before
    monkeypatch.undo()
    assert run.trigger("hurry_precession")[0]
