"""Every refusal through the real service: its sentence, and an unchanged motion."""

import math

import pytest
from geometry_msgs.msg import QuaternionStamped
from node.running_top import RunningTop, stamp_of
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically

START = "set_initial_conditions"
UNIT = [0.0, 0.0, 0.0, 1.0]
UNDEFINED = "axis must be tilted (phi' is undefined on the vertical; an angular impulse works there"
PHI_DOT, FACTOR = "precession_rate", "precession_rate_factor"
REST = {"angular_velocity": [0.0] * 3}


def start(**values):
    return START, values


def kick(**values):
    return "kick", values


def step(**values):
    return "step", values


REFUSED = {
    "field name must be one of theta, phi, psi,": start(thetta=0.5),
    "field name must be one of precession_rate,": kick(rate=9.0),
    "theta must be 0 to 3.14159 rad, got 'a lot'": start(theta="a lot"),
    "theta must be 0 to 3.14159 rad, got nan": start(theta=math.nan),
    "theta must be 0 to 3.14159 rad, got -0.1": start(theta=-0.1),
    "theta must be 0 to 3.14159 rad, got 3.2": start(theta=3.2),
    "psi_dot must be -1e+09 to 1e+09 rad/s, got 1000000000000.0": start(psi_dot=1e12),
    "precession_rate must be a finite number (rad/s), got True": kick(precession_rate=True),
    "precession_rate must be a finite number (rad/s), got inf": kick(precession_rate=math.inf),
    'precession must be "slow" or "fast", got 1.0': start(precession=1.0),
    'precession must be "slow" or "fast", got \'medium\'': start(precession="medium"),
    "precession must be given without phi_dot, got both": start(precession="slow", phi_dot=3.0),
    'precession must be a rate that exists, got "slow": at theta 0.5 rad and psi_dot 20 rad/s '
    "regular precession has no real root": start(precession="slow", psi_dot=20.0),
    "regular precession has no real root": start(precession="fast", theta=math.pi / 2, psi_dot=0.0),
    "angular_velocity must be given together with orientation, got none": start(orientation=UNIT),
    "orientation must be given together with angular_velocity": start(**REST),
    "orientation must be a quaternion of norm 1 within 0.001, got a norm of 2": start(
        orientation=[0.0, 0.0, 0.0, 2.0], **REST
    ),
    "orientation must have 4 elements (x, y, z, w), got 3": start(orientation=[0.0] * 3, **REST),
    "orientation must be 4 numbers from -2 to 2 (x, y, z, w), got [0.0, 0.0, nan, 1.0]": start(
        orientation=[0.0, 0.0, math.nan, 1.0], **REST
    ),
    "orientation must be given without theta, got both": start(orientation=UNIT, **REST, theta=0.5),
    "a request must have one of precession_rate, precession_rate_change,": kick(),
    "got precession_rate and precession_rate_factor": kick(**{PHI_DOT: 9.0, FACTOR: 2.0}),
    'hold must be "spin_rate" or "spin_momentum", got \'breath\'': kick(
        precession_rate=9.0, hold="breath"
    ),
    "hold must be given without angular_impulse, got both": kick(
        angular_impulse=[0.0] * 3, hold="spin_rate"
    ),
    "angular_impulse must have 3 elements (N m s, world frame), got 2": kick(
        angular_impulse=[0.0, 1.0]
    ),
    "angular_impulse must be 3 numbers from -1e+30 to 1e+30 (N m s, world frame), got": kick(
        angular_impulse=[0.0, 1.0, math.nan]
    ),
    "angular_impulse must be such that the top stays below 1e+09 rad/s, got [100000000.0,": kick(
        angular_impulse=[1e8, 0.0, 0.0]
    ),
    "step must be requested while paused (~/pause), got it while running": step(duration=1.0),
    "duration must be 0 to 1e+09 s, got none": step(),
    "duration must be 0 to 1e+09 s, got -1.0": step(duration=-1.0),
}


@pytest.fixture(scope="module")
def run():
    with RunningTop(publish_rate=500.0) as running:
        yield running


@pytest.fixture(scope="module")
def messages(run):
    return run.collect(QuaternionStamped, "/top/orientation")


def assert_untouched(run, messages, before):
    """The segment is the same, and the published samples are still those of its motion."""
    assert run.top.simulation.segment is before
    run.wait_for(messages, 4)
    q = messages[-1].quaternion
    state = before.state_at(stamp_of(messages[-1]))
    assert [q.w, q.x, q.y, q.z] == state.orientation.tolist()


@pytest.mark.parametrize(("sentence", "asked"), REFUSED.items(), ids=range(len(REFUSED)))
def test_a_bad_request_is_refused_in_words_and_changes_nothing(run, messages, sentence, asked):
    service, values = asked
    before = run.top.simulation.segment
    granted, reason = run.set(service, **values)
    assert not granted
    assert sentence in reason
    assert "\n" not in reason
    assert_untouched(run, messages, before)


ONCE = "' must be given once, got it more than once"
TYPED = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)


@pytest.mark.parametrize(
    ("service", "given", "sentence"),
    [
        (START, [Parameter(name="theta", value=TYPED)] * 2, f"'theta{ONCE}"),
        ("kick", [Parameter(name=PHI_DOT, value=TYPED)] * 2, f"'{PHI_DOT}{ONCE}"),
        (
            START,
            [Parameter(name="theta")],
            "type of 'theta' must be 1 to 9 (3 for a double), got 0",
        ),
    ],
    ids=["a name twice", "a kick twice", "no value"],
)
def test_fields_that_cannot_be_read_are_refused(run, messages, service, given, sentence):
    before = run.top.simulation.segment
    request = SetParametersAtomically.Request(parameters=given)
    result = run.connection._call(SetParametersAtomically, service, request).result
    assert not result.successful
    assert result.reason.startswith(sentence)
    assert_untouched(run, messages, before)


def test_a_kick_by_rate_is_refused_on_the_vertical(start_top):
    run = start_top(scene="sleeping")
    before = run.top.simulation.segment
    for granted, reason in (
        *(run.set("kick", **{name: 2.0}) for name in (PHI_DOT, "precession_rate_factor")),
        run.trigger("hurry_precession"),
    ):
        assert not granted
        assert UNDEFINED in reason
    assert run.top.simulation.segment is before
    assert run.set("kick", angular_impulse=[1e-4, 0.0, 0.0])[0]
