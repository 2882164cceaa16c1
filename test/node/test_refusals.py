"""Every refusal through the real service: its sentence, and an unchanged motion."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped
from node.running_top import LATCHED, segment_of, stamp_of
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically

from symtop_ros.simulation.changes.outcomes import Failure
from symtop_ros.wording import write

START = "set_initial_conditions"
IDENTITY = [0.0, 0.0, 0.0, 1.0]
UNDEFINED = (
    "axis must be tilted (phi' is undefined on the vertical; an angular impulse works there)"
)
REFUSED = {
    "unknown start field": (START, {"thetta": 0.5}, "field name must be one of theta, phi, psi,"),
    "unknown kick field": ("kick", {"rate": 9.0}, "field name must be one of precession_rate,"),
    "text for a number": (START, {"theta": "a lot"}, "theta must be 0 to 3.14159 rad, got 'a lot'"),
    "flag for a number": (
        "kick",
        {"precession_rate": True},
        "precession_rate must be a finite number (rad/s), got True",
    ),
    "number for a word": (
        START,
        {"precession": 1.0},
        'precession must be "slow" or "fast", got 1.0',
    ),
    "other word": (
        START,
        {"precession": "medium"},
        'precession must be "slow" or "fast", got \'medium\'',
    ),
    "nan": (START, {"theta": math.nan}, "theta must be 0 to 3.14159 rad, got nan"),
    "infinity": (
        "kick",
        {"precession_rate": math.inf},
        "precession_rate must be a finite number (rad/s), got inf",
    ),
    "tilt below zero": (START, {"theta": -0.1}, "theta must be 0 to 3.14159 rad, got -0.1"),
    "tilt above pi": (START, {"theta": 3.2}, "theta must be 0 to 3.14159 rad, got 3.2"),
    "rate too large": (
        START,
        {"psi_dot": 1e12},
        "psi_dot must be -1e+09 to 1e+09 rad/s, got 1000000000000.0",
    ),
    "quaternion alone": (
        START,
        {"orientation": IDENTITY},
        "angular_velocity must be given together with orientation, got none",
    ),
    "velocity alone": (
        START,
        {"angular_velocity": [0.0] * 3},
        "orientation must be given together with angular_velocity",
    ),
    "quaternion of norm 2": (
        START,
        {"orientation": [0.0, 0.0, 0.0, 2.0], "angular_velocity": [0.0] * 3},
        "orientation must be a quaternion of norm 1 within 0.001, got a norm of 2",
    ),
    "three of four": (
        START,
        {"orientation": [0.0, 0.0, 1.0], "angular_velocity": [0.0] * 3},
        "orientation must have 4 elements (x, y, z, w), got 3",
    ),
    "nan in a quaternion": (
        START,
        {"orientation": [0.0, 0.0, math.nan, 1.0], "angular_velocity": [0.0] * 3},
        "orientation must be 4 numbers from -2 to 2 (x, y, z, w), got [0.0, 0.0, nan, 1.0]",
    ),
    "quaternion and tilt": (
        START,
        {"orientation": IDENTITY, "angular_velocity": [0.0] * 3, "theta": 0.5},
        "orientation must be given without theta, got both",
    ),
    "root and rate": (
        START,
        {"precession": "slow", "phi_dot": 3.0},
        "precession must be given without phi_dot, got both",
    ),
    "no real root": (
        START,
        {"precession": "slow", "psi_dot": 20.0},
        'precession must be a rate that exists, got "slow": at theta 0.5 rad and psi_dot 20 rad/s '
        "regular precession has no real root",
    ),
    "only one root": (
        START,
        {"precession": "fast", "theta": math.pi / 2, "psi_dot": 0.0},
        "regular precession has no real root",
    ),
    "empty kick": (
        "kick",
        {},
        "a request must have one of precession_rate, precession_rate_change,",
    ),
    "two kicks": (
        "kick",
        {"precession_rate": 9.0, "precession_rate_factor": 2.0},
        "got precession_rate and precession_rate_factor",
    ),
    "unknown hold": (
        "kick",
        {"precession_rate": 9.0, "hold": "breath"},
        'hold must be "spin_rate" or "spin_momentum", got \'breath\'',
    ),
    "hold with an impulse": (
        "kick",
        {"angular_impulse": [0.0] * 3, "hold": "spin_rate"},
        "hold must be given without angular_impulse, got both",
    ),
    "impulse of two": (
        "kick",
        {"angular_impulse": [0.0, 1.0]},
        "angular_impulse must have 3 elements (N m s, world frame), got 2",
    ),
    "impulse of nan": (
        "kick",
        {"angular_impulse": [0.0, 1.0, math.nan]},
        "angular_impulse must be 3 numbers from -1e+30 to 1e+30 (N m s, world frame), got",
    ),
    "impulse too large": (
        "kick",
        {"angular_impulse": [1e8, 0.0, 0.0]},
        "angular_impulse must be such that the top stays below 1e+09 rad/s, got [100000000.0,",
    ),
    "step while running": (
        "step",
        {"duration": 1.0},
        "step must be requested while paused (~/pause), got it while running",
    ),
    "step of nothing": ("step", {}, "duration must be 0 to 1e+09 s, got none"),
    "step backwards": ("step", {"duration": -1.0}, "duration must be 0 to 1e+09 s, got -1.0"),
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
    """The segment is the same, and the published samples are still those of its motion."""
    assert run.top.simulation.segment is before
    seen = len(messages)
    run.spin_until(lambda: len(messages) > seen + 3)
    q = messages[-1].quaternion
    state = before.state_at(stamp_of(messages[-1]))
    assert [q.w, q.x, q.y, q.z] == state.orientation.tolist()


@pytest.mark.parametrize(("service", "values", "sentence"), REFUSED.values(), ids=REFUSED)
def test_a_bad_request_is_refused_in_words_and_changes_nothing(
    run, messages, service, values, sentence
):
    before = run.top.simulation.segment
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
    before = run.top.simulation.segment
    request = SetParametersAtomically.Request(parameters=twice)
    result = run.connection._call(SetParametersAtomically, service, request).result
    assert (result.successful, result.reason) == (
        False,
        f"'{name}' must be given once, got it more than once",
    )
    assert_untouched(run, messages, before)


def test_a_field_without_a_value_is_refused(run, messages):
    before = run.top.simulation.segment
    request = SetParametersAtomically.Request(parameters=[Parameter(name="theta")])
    result = run.connection._call(SetParametersAtomically, START, request).result
    assert "type of 'theta' must be 1 to 9 (3 for a double), got 0" in result.reason
    assert_untouched(run, messages, before)


def test_a_kick_by_rate_is_refused_on_the_vertical(start_top):
    run = start_top(scene="sleeping")
    before = run.top.simulation.segment
    for values in ({"precession_rate": 9.0}, {"precession_rate_factor": 2.0}):
        granted, reason = run.set("kick", **values)
        assert not granted
        assert UNDEFINED in reason
    granted, reason = run.trigger("hurry_precession")
    assert not granted
    assert UNDEFINED in reason
    assert run.top.simulation.segment is before
    assert run.set("kick", angular_impulse=[1e-4, 0.0, 0.0])[0]


def test_a_request_with_an_unexpected_exception_is_reported_and_the_motion_keeps_running(
    start_top, monkeypatch
):
    run = start_top()
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: events)

    def fail(*_):
        raise ZeroDivisionError("by a\nbug")

    monkeypatch.setattr("symtop_ros.simulation.changes.timeline.kick_verdict", fail)
    before = run.top.simulation.segment
    failure = Failure("~/hurry_precession", "ZeroDivisionError", "by a bug")
    report = write("failure", failure)
    assert run.trigger("hurry_precession") == (False, report)
    run.spin_until(lambda: len(events) > 1)
    assert (events[-1].status[0].name, events[-1].status[0].message) == ("top: failure", report)
    # the kick was applied before its verdict was computed, and the event contains it
    assert segment_of(events[-1]).motion.start.orientation.tolist() == (
        run.top.simulation.segment.motion.start.orientation.tolist()
    )
    assert run.top.simulation.segment is not before
    monkeypatch.undo()
    assert run.trigger("hurry_precession")[0]
