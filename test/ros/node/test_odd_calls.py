"""Arbitrary requests, parameters and torques through the real services of one node.

Each is answered in one sentence, the samples stay those of the motion, and so does the log.
"""

import math

import pytest
import rclpy
from exact_log import assert_no_deviation, compare_samples
from geometry_msgs.msg import QuaternionStamped, WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
from odd_values import (
    CONTROL,
    NUMBERS,
    SIZES,
    TEXTS,
    assert_one_answer,
    assert_one_sentence,
    examples_of,
)
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from ros.node.running_top import RunningTop, stamp_of, torque_of
from trials import trials

from symtop_ros.run.session.services import SERVICES
from symtop_ros.run.simulation.changes.requests import KICK_FIELDS, START_FIELDS
from symtop_ros.run.simulation.settings import PARAMETERS

RATE = 200.0  # Hz
START = "set_initial_conditions"
NAMES = {START: START_FIELDS, "kick": KICK_FIELDS, "step": ("duration",)}
SETTERS = ("set_parameters_atomically", "set_parameters")
NAMES |= dict.fromkeys(SETTERS, (*PARAMETERS, "scene", "none"))
FIELDS = (  # of a ParameterValue, with their types
    st.tuples(st.just(1), st.just("bool_value"), st.booleans()),
    st.tuples(st.just(2), st.just("integer_value"), st.integers(-(2**63), 2**63 - 1)),
    st.tuples(st.just(3), st.just("double_value"), NUMBERS | st.floats() | SIZES),
    st.tuples(st.just(4), st.just("string_value"), TEXTS.map(lambda text: text.replace("\0", ""))),
    st.tuples(st.just(5), st.just("byte_array_value"), st.just([b"a", b"\xff", b"\0"])),
    st.tuples(st.just(6), st.just("bool_array_value"), st.lists(st.booleans(), max_size=4)),
    st.tuples(st.just(7), st.just("integer_array_value"), st.lists(st.integers(0, 9), max_size=4)),
    st.tuples(st.just(8), st.just("double_array_value"), st.lists(NUMBERS, max_size=4)),
    st.tuples(st.just(9), st.just("string_array_value"), st.lists(st.just(CONTROL), max_size=3)),
    st.tuples(st.sampled_from([0, 10, 77, 255]), st.just("double_value"), st.just(1.0)),
)


@st.composite
def parameters(draw, names):
    """Parameter messages with some names, repeated or unknown ones too, and any values."""
    chosen = draw(st.lists(st.sampled_from([*names, CONTROL, ""]), max_size=3))
    return [_parameter(name, *draw(st.one_of(FIELDS))) for name in chosen]


def _parameter(name, kind, field, value):
    return Parameter(name=name, value=ParameterValue(type=kind, **{field: value}))


CALLS = st.sampled_from(list(NAMES)).flatmap(
    lambda service: st.tuples(st.just(service), parameters(NAMES[service]))
)
FRAMES = st.sampled_from(["world", "", "map", CONTROL * 100])
TORQUES = st.tuples(st.lists(NUMBERS | SIZES, min_size=3, max_size=3), FRAMES)
PLAIN = [name for name, each in SERVICES.items() if each.kind == "plain"]
SWITCHES = [name for name, each in SERVICES.items() if each.kind == "switch" and name != "record"]
ACTS = (
    CALLS
    | st.tuples(st.sampled_from(PLAIN), st.none())
    | st.tuples(st.sampled_from(SWITCHES), st.booleans())  # all of it is one record
    | st.tuples(st.just("push"), TORQUES)
)
CHANGEABLE = [name for name in PARAMETERS if not PARAMETERS[name].read_only]
RESTORED = {name: PARAMETERS[name].default for name in CHANGEABLE} | {"publish_rate": RATE}


class Watched(RunningTop):
    """A top whose samples are collected."""

    def __init__(self, **options):
        super().__init__(**options)
        self.samples = self.collect(QuaternionStamped, "/top/orientation")
        self.hand = self.publisher(WrenchStamped, "/top/applied_torque")
        self.spin_until(lambda: self.samples)

    def restore(self):
        """The motion and the parameters of the beginning."""
        for service in SWITCHES:
            self.switch(service, False)
        assert self.change(RESTORED) == (True, "")
        assert self.set(START, theta=0.5, psi_dot=200.0)[0]
        self.spin_until(lambda: not any(self.top.simulation.timeline.held_torque))

    def assert_samples_agree_with_the_motion(self):
        segment = None
        while segment is not self.top.simulation.segment:
            segment = self.top.simulation.segment
            self.spin_until(lambda begin=segment.stamp: stamp_of(self.samples[-1]) > begin)
        q = self.samples[-1].quaternion
        expected = segment.state_at(stamp_of(self.samples[-1])).orientation.tolist()
        assert [q.w, q.x, q.y, q.z] == expected
        assert self.top.failure is None

    def push(self, numbers, frame):
        self.hand.publish(torque_of(*numbers, frame))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs") / "logs"
    with Watched(publish_rate=RATE, record__directory=str(folder)) as running:
        yield running


def act(run, name, argument):
    """Do something, which is answered in a sentence."""
    if name == "push":
        run.push(*argument)
        run.wait_for(run.samples, 3)
    elif name == "get_state":
        run.state()
    elif argument is None:
        assert_one_sentence(run.trigger(name)[1])
    elif name in SWITCHES:
        assert_one_sentence(run.switch(name, argument)[1])
    else:
        for granted, reason in run.send(name, argument):
            if name.startswith("set_parameters") and granted:
                assert reason == ""
            elif granted:
                assert_one_answer(reason)
            else:
                assert_one_sentence(reason)


@pytest.mark.slow
@pytest.mark.parametrize("examples", trials(20, 300))
def test_any_acts_are_answered_and_leave_the_samples_and_the_log_exact(run, examples):
    assert run.switch("record", True)[0]

    @examples_of(examples)
    @given(acts=st.lists(ACTS, min_size=1, max_size=3))
    def check(acts):
        for each in acts:
            act(run, *each)
        run.restore()
        run.assert_samples_agree_with_the_motion()

    check()
    deviations = compare_samples(assert_no_deviation(run.end_log()))
    assert not any(each.unreached for each in deviations.values())


@pytest.mark.parametrize("service", list(NAMES))
def test_more_parameters_than_any_file_has_are_refused(run, service):
    messages = [Parameter(name="top.Ix", value=ParameterValue(type=3, double_value=1.0))] * 1001
    reason = "a request must have at most 1000 parameters, got 1001"
    assert set(run.send(service, messages)) == {(False, reason)}


ONE = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)
NO_TYPE, TWICE = "type of '{}' must be ", "'{}' must be given once, got it more than once"
ODD = [
    *((service, ParameterValue(type=77), 1, NO_TYPE + "0 to 9, got 77") for service in NAMES),
    *((service, ONE, 2, TWICE) for service in (START, "kick")),
    (START, ParameterValue(), 2, TWICE),
]
UNTYPED = ParameterValue  # as `ros2 service call` sends a value without a type
FULL = {"integer_value": 1, "double_value": 1.0}
NO_NUMBERS = [
    *((START, name, {}) for name in ("orientation", "angular_velocity", "precession")),
    *(("kick", name, {}) for name in ("angular_impulse", "hold")),
    (START, "theta", FULL),
]


@pytest.mark.parametrize(("service", "name", "fields"), NO_NUMBERS)
def test_an_empty_value_without_a_type_is_refused_where_it_is_no_number(run, service, name, fields):
    """Vectors and words; two values are none either."""
    before = run.top.simulation.segment.motion
    found = run.send(service, [Parameter(name=name, value=UNTYPED(**fields))])
    assert found == [(False, f"type of '{name}' must be 1 to 9 (3 for a double), got 0")]
    assert run.top.simulation.segment.motion is before


# What is typed in full beside it, and what the answer says: the zero, then what followed.
ZEROS = [
    (START, ["theta"], {"psi_dot": 200.0}, "theta: 0"),
    (START, ["phi", "psi_dot"], {"theta": 0.5}, "phi: 0, psi_dot: 0"),
    ("kick", ["precession_rate"], {}, "precession_rate: 0"),
    ("kick", ["precession_rate_change"], {"hold": "spin_momentum"}, "precession_rate_change: 0"),
    ("kick", ["precession_rate_factor"], {}, "precession_rate_factor: 0"),
    ("kick", ["axle_impulse"], {}, "axle_impulse: 0"),
    ("step", ["duration"], {}, "duration: 0"),
]


@pytest.fixture(name="still")
def _still(run):
    """A top that is paused, so that the same request has the same answer again."""
    assert run.switch("pause", True)[0]
    yield run
    assert run.switch("pause", False)[0]


def ask_anew(run, ask):
    """Return the answer to a request after a start, and the state that follows."""
    assert run.set(START, theta=0.5, psi_dot=200.0, phi_dot=2.0)[0]
    ((granted, answer),) = ask()
    assert granted, answer
    changing = {"stamp": 0, "sec": 0, "nanosec": 0, "time_since": "", "event": 0}
    return answer.rpartition(" [event ")[0], {**run.state(), **changing}


@pytest.mark.parametrize(("service", "zeros", "others", "words"), ZEROS)
def test_a_zero_can_be_typed_as_any_other_number(still, service, zeros, others, words):
    """`{name: theta, value: {double_value: 0.0}}` and `{name: theta}` are the same message."""
    full = [rclpy.Parameter(name, value=value).to_parameter_msg() for name, value in others.items()]
    empty = [Parameter(name=name, value=UNTYPED(double_value=0.0)) for name in zeros]
    answer, state = ask_anew(still, lambda: still.send(service, [*empty, *full]))
    values = {**dict.fromkeys(zeros, 0.0), **others}
    plain, same = ask_anew(still, lambda: [still.set(service, **values)])
    assert (answer, state) == (f"{words} (a value without a type). {plain}", same)


@pytest.mark.parametrize(
    ("service", "name", "reason"),
    [
        (START, "thetta", "field name must be one of theta, "),
        (START, "solution", "a start must have one of theta, "),
        ("kick", "rate", "pushes must have axle_impulse, rate, number, got ['rate']"),
    ],
)
def test_a_zero_that_fits_nothing_is_refused_for_what_it_is(run, service, name, reason):
    ((granted, answer),) = run.send(service, [Parameter(name=name)])
    assert not granted
    assert answer.startswith(reason)


@pytest.mark.parametrize(("service", "value", "times", "reason"), ODD)
def test_fields_that_cannot_be_read_are_refused(run, service, value, times, reason):
    before = run.top.simulation.segment.motion
    name = NAMES[service][0]
    found = run.send(service, [Parameter(name=name, value=value)] * times)
    assert found[0] == (False, reason.format(name))
    assert run.top.simulation.segment.motion is before


@pytest.mark.parametrize("name", ["initial.orientation", "steady_torque", "top.Ix", "publish_rate"])
def test_a_parameter_cannot_be_taken_away(run, name):
    ((granted, reason),) = run.send("set_parameters", [Parameter(name=name)])
    assert not granted
    assert reason.startswith(f"{name} must ")
    assert reason.endswith(", got None")
    assert run.top.has_parameter(name)


BY_FORCE = torque_of(z=1e-4)
BY_FORCE.wrench.force.x = 1.0
NO_NUMBER = "applied_torque must be 3 numbers from -1e+30 to 1e+30 (N m, world frame), got [nan"


@pytest.mark.parametrize(
    ("message", "sentence"),
    [
        (torque_of(x=math.nan), NO_NUMBER),
        (torque_of(z=1.0, frame="top"), """frame_id must be "world" or empty, got 'top'"""),
        (BY_FORCE, "applied_torque force must be 0 (only the torque acts), got (1.0, 0.0, 0.0)"),
    ],
)
def test_a_bad_torque_is_reported_and_the_next_one_acts(start_top, capfd, message, sentence):
    run = start_top()
    hand = run.publisher(WrenchStamped, "/top/applied_torque")
    for each in (message, torque_of(z=2e-4, frame="world")):
        hand.publish(each)
    run.spin_until(lambda: any(run.top.simulation.segment.motion.applied_torque))
    assert tuple(run.top.simulation.segment.motion.applied_torque) == (0.0, 0.0, 2e-4)
    assert sentence in capfd.readouterr().err


def test_requests_before_a_motion_is_slowed_down_are_answered(start_top):
    run = start_top(publish_rate=1.0)  # Hz: all of them before the next sample
    for name, value in (("friction.axial", 1e30), ("top.Mgl", 0.05), ("friction.axial", 0.0)):
        assert run.change({name: value})[0]
    assert run.set("kick", precession_rate=2.0)[0]
    assert run.top.failure is None


def test_a_torque_that_ends_before_a_motion_is_slowed_down_ends():
    with Watched(publish_rate=10.0, applied_torque_timeout=0.001) as run:
        run.push([1e30, 0.0, 0.0], "world")
        run.spin_until(lambda: any(run.top.simulation.segment.motion.applied_torque))
        run.spin_until(lambda: not any(run.top.simulation.segment.motion.applied_torque))
        assert run.state()["engine"] == "closed form"


def test_a_node_that_publishes_the_clock_does_not_follow_it(start_top):
    run = start_top(realtime=True, publish_clock=True)
    reason = "publish_clock must be false together with use_sim_time, got true"
    assert run.change({"use_sim_time": True}) == (False, reason)
