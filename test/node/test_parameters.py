"""Parameters: descriptors, scenes, refusals at start-up and later, and changes that take effect."""

import json
import math

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, TransformStamped
from node.running_top import LATCHED, facts, segment_of, stamp_of
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.qos import QoSReliabilityPolicy
from std_msgs.msg import String

from symtop_ros.check.samples import check_log
from symtop_ros.log.reader import McapFile
from symtop_ros.log.top_log import TopLog
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.settings import PARAMETERS
from symtop_ros.simulation.topics import Topic
from symtop_ros.simulation.validation import RefusedError

KINDS = {
    "regular_precession": "regular",
    "fast_precession": "regular",
    "cusps": "cusps",
    "looping": "looping",
    "unidirectional": "unidirectional",
    "hurry_slow": "regular",
    "hurry_fast": "regular",
    "perry_fails": "regular",
    "sleeping": "sleeping",
    "sleeping_unstable": "cusps",
    "through_the_pole": "through the pole",
    "hanging": "unidirectional",
    "disc": "unidirectional",
    "free": "unidirectional",
    "spin_reversal": "unidirectional",
    "backward_start": "looping",
    "closed_cusps": "cusps",
    "conical_pendulum": "regular",
    "spherical_pendulum": "unidirectional",
    "separatrix": "asymptotic",
    "gray_fall": "cusps",
}
EPS = np.finfo(float).eps
SET = "set_parameters_atomically"


def numbers(text):
    return np.array([float(part) for part in text.split()])


INTEGRATED = {"friction", "sleeping_wakes", "vertical_torque"}


def test_every_scene_has_a_test():
    assert set(scene_names()) == set(KINDS) | INTEGRATED


@pytest.mark.parametrize("scene", sorted(INTEGRATED))
def test_a_scene_with_friction_or_torque_is_driven(start_top, scene):
    state = json.loads(start_top(scene=scene).trigger("get_state")[1])
    assert state["engine"] == "taylor"
    assert state["friction"]["axial"] > 0 or state["applied_torque"][2] > 0


@pytest.mark.parametrize(("scene", "kind"), KINDS.items())
def test_a_scene_starts_the_motion_that_its_name_promises(start_top, scene, kind):
    run = start_top(scene=scene)
    state = json.loads(run.trigger("get_state")[1])
    assert state["kind"] == kind


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"scene": "nowhere"}, "scene must be one of backward_start, closed_cusps,"),
        ({"top__Iz": 1.0}, "top.Iz must be > 0 and <= 2 Ix = 0.000456 kg m^2, got 1"),
        ({"top__Ix": -1.0}, "top.Ix must be 1e-30 to 1e+30 kg m^2, got -1.0"),
        ({"publish_rate": 0.0}, "publish_rate must be 1 to 2000 Hz, got 0.0"),
        ({"publish_rate": "fast"}, "publish_rate must be 1 to 2000 Hz, got 'fast'"),
        ({"initial__theta": float("nan")}, "initial.theta must be 0 to 3.14159 rad, got nan"),
        (
            {"initial__precession": "odd"},
            'initial.precession must be "" or "slow" or "fast", got \'odd\'',
        ),
        (
            {"initial__orientation": [1.0, 2.0]},
            "initial.orientation must have 4 elements (x, y, z, w), got 2",
        ),
        (
            {"initial__angular_velocity": [0.0, 0.0, 1.0]},
            "initial.angular_velocity must be set together with initial.orientation, got none",
        ),
        ({"real_time_factor": 1000.0}, "real_time_factor must be 0.001 to 100, got 1000.0"),
        ({"top__Mg": 1.0}, "parameter name must be known (the nearest is top.Mgl), got 'top.Mg'"),
        ({"publish_tf": "yes"}, "publish_tf must be true or false, got 'yes'"),
        (
            {"world_frame": " "},
            (
                "world_frame must be the name of a frame (1 to 200 printable characters, "
                "no leading slash), got ' '"
            ),
        ),
    ],
)
def test_a_bad_value_at_start_up_is_refused_in_words(start_top, values, sentence):
    with pytest.raises(RefusedError) as refusal:
        start_top(**values)
    assert sentence in str(refusal.value)


def test_a_whole_number_is_as_good_as_a_double(start_top):
    run = start_top(publish_rate=100, top__Mgl=0)
    assert run.top.simulation.settings.publish_rate == 100.0
    assert json.loads(run.trigger("get_state")[1])["engine"] == "free"


KINDS_OF_TYPES = {
    bool: ParameterType.PARAMETER_BOOL,
    int: ParameterType.PARAMETER_INTEGER,
    float: ParameterType.PARAMETER_DOUBLE,
    str: ParameterType.PARAMETER_STRING,
    list: ParameterType.PARAMETER_DOUBLE_ARRAY,
}
BYTES = ParameterType.PARAMETER_BYTE_ARRAY


def read(run, *names):
    request = GetParameters.Request(names=names)
    return run.connection._call(GetParameters, "get_parameters", request).values


def put(run, name, **value):
    """The request that `ros2 param set` sends."""
    parameters = [ParameterMessage(name=name, value=ParameterValue(**value))]
    request = SetParameters.Request(parameters=parameters)
    return run.connection._call(SetParameters, "set_parameters", request).results[0]


def test_every_parameter_has_the_type_of_its_default_whatever_is_set(start_top):
    run = start_top(publish_rate=100, top__Mgl=0, imu__position=[0, 0, 1])
    for name, parameter in PARAMETERS.items():
        expected = KINDS_OF_TYPES[type(parameter.default)]
        described = run.top.describe_parameter(name)
        assert (name, described.type, described.dynamic_typing) == (name, expected, False)
        assert (name, read(run, name)[0].type) == (name, expected)
    assert read(run, "imu.position")[0].double_array_value.tolist() == [0.0, 0.0, 1.0]
    assert read(run, "steady_torque")[0].double_array_value.tolist() == []


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("hurry_factor", {"type": 2, "integer_value": 2}, 2.0),
        ("hurry_factor", {"type": 4, "string_value": "2e0"}, 2.0),
        ("steady_torque", {"type": 7, "integer_array_value": [0, 0, 1]}, [0.0, 0.0, 1.0]),
        ("steady_torque", {"type": 4, "string_value": "[0, 0, 0.5]"}, [0.0, 0.0, 0.5]),
        ("steady_torque", {"type": BYTES}, []),
        ("initial.orientation", {"type": 6}, []),  # `ros2 param set ... []`
    ],
)
def test_a_value_of_a_related_type_is_stored_as_a_double(start_top, name, value, expected):
    run = start_top()
    result = put(run, name, **value)
    assert (result.successful, result.reason) == (True, "")
    (found,) = read(run, name)
    assert found.type == KINDS_OF_TYPES[type(PARAMETERS[name].default)]
    stored = found.double_value if isinstance(expected, float) else [*found.double_array_value]
    assert stored == expected


def test_all_that_a_dumped_file_sets_is_accepted_while_the_node_runs(start_top):
    run = start_top(imu__position=[0.0, 0.0, 1.0])
    names = [*run.top.get_parameters_by_prefix("")]
    parameters = [
        ParameterMessage(name=name, value=value)
        for name, value in zip(names, read(run, *names), strict=True)
    ]
    for kind in (SetParameters, SetParametersAtomically):
        service = "set_parameters" if kind is SetParameters else SET
        answer = run.connection._call(kind, service, kind.Request(parameters=parameters))
        results = answer.results if kind is SetParameters else [answer.result]
        assert {(each.successful, each.reason) for each in results} == {(True, "")}
    assert not put(run, "scene", type=4, string_value="disc").successful


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("publish_rate", 5000.0, "publish_rate must be "),
        ("top.Iz", 1.0, "top.Iz must be "),
        ("hurry_factor", "much", "hurry_factor must be "),
        ("scene", "disc", "read-only parameter: scene"),
        ("world_frame", "map", "read-only parameter: world_frame"),
    ],
)
def test_a_bad_value_later_is_refused_and_the_motion_is_unchanged(start_top, name, value, sentence):
    run = start_top()
    before = run.top.simulation.segment
    granted, reason = run.connection.set(SET, {name: value})
    assert not granted
    assert sentence in reason
    assert run.top.simulation.segment is before


def test_every_parameter_is_described_with_its_allowed_values(start_top):
    run = start_top()
    for name in PARAMETERS:
        descriptor = run.top.describe_parameter(name)
        assert descriptor.description
        assert descriptor.additional_constraints.startswith("must be ")
    assert "Hz" in run.top.describe_parameter("publish_rate").additional_constraints


def test_a_range_is_told_and_what_is_outside_is_refused_in_our_words(start_top):
    run = start_top()
    client = run.user.create_client(DescribeParameters, "/top/describe_parameters")
    run.spin_until(client.service_is_ready)
    future = client.call_async(DescribeParameters.Request(names=[*PARAMETERS]))
    run.spin_until(future.done)
    for found in future.result().descriptors:
        limits = PARAMETERS[found.name].limits
        ranges = [*found.floating_point_range, *found.integer_range]
        assert [(each.from_value, each.to_value) for each in ranges] == [limits] * bool(limits)
        assert all(each.step == bool(found.integer_range) for each in ranges)
    result = put(run, "publish_rate", type=3, double_value=3000.0)
    assert result.reason == "publish_rate must be 1 to 2000 Hz, got 3000.0"


def test_another_weight_keeps_the_state_and_changes_what_follows(start_top):
    run = start_top()
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    assert run.connection.set(SET, {"top.Mgl": -0.068})[0]
    run.spin_until(lambda: len(events) == 2)
    values = facts(events[1])
    assert values["request.top.Mgl"] == "-0.068"
    for name in ("orientation", "angular_velocity"):
        assert values[f"motion.{name}"] == values[f"before.{name}"]
        before, after = (numbers(values[f"{when}.{name}"]) for when in ("before", "after"))
        # the new motion evaluated at its start: a few ulp of the largest component
        assert np.abs(after - before).max() <= 8 * EPS * np.abs(before).max()
    assert values["top"] == "0.000228 5.72e-05 -0.068"


def test_another_publish_rate_takes_effect_without_a_gap(start_top):
    run = start_top(publish_rate=100.0)
    messages = run.collect(QuaternionStamped, "/top/orientation")
    run.spin_until(lambda: len(messages) > 5)
    assert run.connection.set(SET, {"publish_rate": 500.0})[0]
    messages.clear()
    run.spin_until(lambda: len(messages) > 20)
    stamps = [stamp_of(message) for message in messages]
    assert set(np.diff(stamps[2:])) == {2_000_000}


def test_the_qos_of_a_topic_can_be_overridden(start_top):
    run = start_top(**{"qos_overrides./top/orientation.publisher.reliability": "best_effort"})
    info = run.top.get_publishers_info_by_topic("/top/orientation")[0]
    assert info.qos_profile.reliability == QoSReliabilityPolicy.BEST_EFFORT


def test_a_run_starts_from_the_initial_parameters(start_top):
    start = {
        "theta": 0.7,
        "phi": 0.2,
        "psi": -0.3,
        "theta_dot": 0.4,
        "phi_dot": 3.0,
        "psi_dot": 9.0,
    }
    run = start_top(**{f"initial__{name}": value for name, value in start.items()})
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    run.spin_until(lambda: events)
    first = segment_of(events[0])
    state = first.state_at(stamp_of(events[0]))
    phi, theta, psi = state.euler_angles
    # a quaternion and back: a few ulp, more where rates are divided by sin 0.7
    assert [theta, phi, psi] == pytest.approx(
        [start[k] for k in ("theta", "phi", "psi")], abs=1e-14
    )
    rates = [start[f"{k}_dot"] for k in ("phi", "theta", "psi")]
    assert list(state.euler_rates) == pytest.approx(rates, abs=1e-13)


def test_a_run_starts_on_the_root_that_the_parameters_name(start_top):
    run = start_top(initial__precession="fast", initial__psi_dot=200.0)
    assert json.loads(run.trigger("get_state")[1])["kind"] == "regular"


def test_a_run_starts_from_the_quaternion_of_the_parameters(start_top):
    half = math.sqrt(0.5)
    run = start_top(
        initial__orientation=[half, 0.0, 0.0, half], initial__angular_velocity=[0.0, 0.0, 150.0]
    )
    state = json.loads(run.trigger("get_state")[1])
    assert state["turning_angles"][0] == pytest.approx(math.pi / 2, abs=1e-15)
    assert state["euler_rates"]["psi"] != 0


@pytest.mark.wording
def test_another_factor_hurries_by_it(start_top):
    run = start_top(scene="hurry_slow", hurry_factor=2.0)
    assert run.trigger("hurry_precession")[1].startswith("Precession 6.50 -> 12.99 rad/s")
    run.trigger("reset")
    assert run.connection.set(SET, {"hurry_factor": 0.5})[0]
    assert run.trigger("hurry_precession")[1].startswith("Precession 6.50 -> 3.25 rad/s")


def test_messages_and_description_bear_the_frames_that_were_asked_for(start_top):
    run = start_top(world_frame="map", top_frame="gyro")
    samples = run.collect(QuaternionStamped, "/top/orientation")
    described = run.collect(String, "/robot_description", LATCHED)
    run.spin_until(lambda: samples and described)
    assert samples[0].header.frame_id == "map"
    assert '"map"' in described[0].data
    assert '"gyro"' in described[0].data


def test_in_a_namespace_frame_and_description_are_those_of_the_namespace(start_top):
    run = start_top(arguments=["--ros-args", "-r", "__ns:=/a"])
    described = run.collect(String, "/a/robot_description", LATCHED)
    run.spin_until(lambda: described)
    assert run.top.get_parameter("top_frame").value == "a/top"
    assert '<link name="a/top">' in described[0].data


@pytest.mark.parametrize(("namespace", "full"), [("/", "/gyro"), ("/lab", "/lab/gyro")])
def test_a_top_of_another_name_has_its_own_frame_description_and_diagnostics(
    namespace, full, start_top, tmp_path
):
    arguments = ["--ros-args", "-r", f"__ns:={namespace}", "-r", "__node:=gyro"]
    run = start_top(
        arguments=arguments,
        record__enabled=True,
        record__directory=str(tmp_path),
        imu__enabled=True,
    )
    described = run.collect(String, f"{full}/robot_description", LATCHED)
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: described and diagnostics)
    names = {name for name, _ in run.top.get_topic_names_and_types()}
    assert not {"/robot_description", "/lab/robot_description"} & names
    frame = full.lstrip("/")
    for link in ("", "_precession", "_tilt"):
        assert f'<link name="{frame}{link}"' in described[0].data
    for status in diagnostics[0].status:
        assert status.hardware_id == full
        assert status.name.startswith(f"{frame}: ")
    run.top.session.close()
    (path,) = tmp_path.iterdir()
    log = TopLog(McapFile(path), full)
    assert all(each.samples and not each.largest for each in check_log(log).values())
    (batch, *_) = log.batches()
    assert batch.events[0][1].values["top_frame"] == frame
    assert len(batch.columns["tf"].stamps) == len(batch.columns["imu"].stamps) > 0


def test_a_top_called_top_names_itself_in_its_diagnostics(start_top):
    run = start_top()
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: diagnostics)
    found = {(each.name.partition(": ")[0], each.hardware_id) for each in diagnostics[0].status}
    assert found == {("top", "/top")}


def test_transforms_are_published_while_they_are_wanted(start_top, monkeypatch):
    """With an installed type in place of tf2_msgs: only the bytes are compared."""
    load = Topic.load_message_class
    monkeypatch.setattr(
        Topic,
        "load_message_class",
        lambda topic: TransformStamped if topic.name == "tf" else load(topic),
    )
    run = start_top()
    transforms = run.collect(TransformStamped, "/tf", raw=True)
    samples = run.collect(QuaternionStamped, "/top/orientation")
    run.spin_until(lambda: len(transforms) > 5)
    assert all(b"world" in data and b"top" in data for data in transforms)
    assert run.connection.set(SET, {"publish_tf": False})[0]
    seen = len(samples)
    run.spin_until(lambda: len(samples) > seen + 5)
    transforms.clear()
    run.spin_until(lambda: len(samples) > seen + 30)
    assert transforms == []
