"""Parameters: descriptors, scenes, refusals at start-up and later, and changes that take effect."""

import math
import re

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_no_deviation
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

from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.settings import PARAMETERS
from symtop_ros.simulation.topics import Topic
from symtop_ros.simulation.validation import RefusedError

KINDS = {  # scenes by the kind of their motion
    "regular": "regular_precession fast_precession hurry_slow hurry_fast perry_fails "
    "conical_pendulum",
    "cusps": "cusps sleeping_unstable closed_cusps gray_fall",
    "looping": "looping backward_start",
    "unidirectional": "unidirectional hanging disc free spin_reversal spherical_pendulum",
    "sleeping": "sleeping",
    "through the pole": "through_the_pole",
    "asymptotic": "separatrix",
}
INTEGRATED = ["friction", "sleeping_wakes", "vertical_torque"]
EPS = np.finfo(float).eps


def numbers(text):
    return np.array([float(part) for part in text.split()])


def test_every_scene_has_a_test():
    assert set(scene_names()) == {*" ".join(KINDS.values()).split(), *INTEGRATED}


@pytest.mark.parametrize("scene", INTEGRATED)
def test_a_scene_with_friction_or_torque_is_driven(start_top, scene):
    state = start_top(scene=scene).state()
    assert state["engine"] == "taylor"
    assert state["friction"]["axial"] > 0 or state["applied_torque"][2] > 0


@pytest.mark.parametrize(
    ("scene", "kind"), [(scene, kind) for kind in KINDS for scene in KINDS[kind].split()]
)
def test_a_scene_starts_the_motion_that_its_name_promises(start_top, scene, kind):
    assert start_top(scene=scene).state()["kind"] == kind


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"scene": "nowhere"}, "scene must be one of backward_start, closed_cusps,"),
        ({"top__Iz": 1.0}, "top.Iz must be > 0 and <= 2 Ix = 0.000456 kg m^2, got 1"),
        ({"top__Ix": -1.0}, "top.Ix must be 1e-30 to 1e+30 kg m^2, got -1.0"),
        ({"publish_rate": 0.0}, "publish_rate must be 1 to 2000 Hz, got 0.0"),
        ({"publish_rate": "fast"}, "publish_rate must be 1 to 2000 Hz, got 'fast'"),
        ({"initial__theta": math.nan}, "initial.theta must be 0 to 3.14159 rad, got nan"),
        ({"initial__precession": "odd"}, """must be "" or "slow" or "fast", got 'odd'"""),
        ({"initial__orientation": [1.0, 2.0]}, "must have 4 elements (x, y, z, w), got 2"),
        (
            {"initial__angular_velocity": [0.0, 0.0, 1.0]},
            "initial.angular_velocity must be set together with initial.orientation, got none",
        ),
        ({"real_time_factor": 1000.0}, "real_time_factor must be 0.001 to 100, got 1000.0"),
        ({"top__Mg": 1.0}, "parameter name must be known (the nearest is top.Mgl), got 'top.Mg'"),
        ({"publish_tf": "yes"}, "publish_tf must be true or false, got 'yes'"),
        ({"world_frame": " "}, "1 to 200 printable characters, no leading slash), got ' '"),
        ({"scheduling_priority": 100}, "0 to 99"),
        (
            {"use_sim_time": True, "publish_clock": True},
            "publish_clock must be false together with use_sim_time, got true",
        ),
    ],
)
def test_a_bad_value_at_start_up_is_refused_in_words(start_top, values, sentence):
    *_, name = values
    with pytest.raises(RefusedError, match=re.escape(sentence)) as refusal:
        start_top(**values)
    assert str(refusal.value).startswith(("parameter name ", f"{name.replace('__', '.')} "))


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
    assert run.top.simulation.settings.publish_rate == 100.0
    assert run.state()["engine"] == "free"


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
        service = "set_parameters" + "_atomically" * (kind is SetParametersAtomically)
        answer = run.connection._call(kind, service, kind.Request(parameters=parameters))
        results = answer.results if kind is SetParameters else [answer.result]
        assert {(each.successful, each.reason) for each in results} == {(True, "")}
    assert not put(run, "scene", type=4, string_value="disc").successful


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"publish_rate": 5000.0}, "publish_rate must be "),
        ({"top.Iz": 1.0}, "top.Iz must be "),
        ({"hurry_factor": "much"}, "hurry_factor must be "),
        ({"initial.precession": "slow", "initial.psi_dot": 3.0}, "precession must be "),
        ({"friction.axial": -1e-6}, "friction.axial must be 0 to 1e+30 N m s, got -1e-06"),
        ({"friction.transverse": math.nan}, "transverse must be 0 to 1e+30 N m s, got nan"),
        ({"steady_torque": [1.0, 2.0]}, "torque must have 3 elements (N m, world frame), got 2"),
        ({"applied_torque_timeout": 0.0}, "torque_timeout must be 0.001 to 1e+06 s, got 0.0"),
        ({"scene": "disc"}, "read-only parameter: scene"),
        ({"world_frame": "map"}, "read-only parameter: world_frame"),
        ({"record.directory": "/etc"}, "read-only parameter: record.directory"),
        ({"record.enabled": True}, "read-only parameter: record.enabled"),
    ],
)
def test_a_bad_value_later_is_refused_and_the_motion_is_unchanged(start_top, values, sentence):
    run = start_top()
    events, before = run.collect_events(), run.top.simulation.segment
    granted, reason = run.change(values)
    assert not granted
    assert sentence in reason
    assert reason.startswith((*values, "precession ", "Trying to set a read-only "))
    assert run.top.simulation.segment is before
    assert len(events) == 1


def test_every_parameter_is_described_with_its_range_outside_which_we_refuse(start_top):
    run = start_top()
    request = DescribeParameters.Request(names=[*PARAMETERS])
    described = run.connection._call(DescribeParameters, "describe_parameters", request)
    assert [found.name for found in described.descriptors] == [*PARAMETERS]
    for found in described.descriptors:
        assert found.description
        assert found.additional_constraints.startswith("must be ")
        assert found.name != "publish_rate" or "Hz" in found.additional_constraints
        limits = PARAMETERS[found.name].limits
        ranges = [*found.floating_point_range, *found.integer_range]
        assert [(each.from_value, each.to_value) for each in ranges] == [limits] * bool(limits)
        assert all(each.step == bool(found.integer_range) for each in ranges)
    result = put(run, "publish_rate", type=3, double_value=3000.0)
    assert result.reason == "publish_rate must be 1 to 2000 Hz, got 3000.0"


def test_another_weight_keeps_the_state_and_changes_what_follows(start_top):
    run = start_top()
    events = run.collect_events()
    assert run.change({"top.Mgl": -0.068})[0]
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
    run.wait_for(messages, 6)
    assert run.change({"publish_rate": 500.0})[0]
    messages.clear()
    run.wait_for(messages, 20)
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
    (first,) = run.collect_events()
    state = segment_of(first).state_at(stamp_of(first))
    # a quaternion and back: a few ulp, more where rates are divided by sin 0.7
    for name in ("phi", "theta", "psi"):
        assert getattr(state.euler_angles, name) == pytest.approx(start[name], abs=1e-14)
        assert getattr(state.euler_rates, name) == pytest.approx(start[f"{name}_dot"], abs=1e-13)


def test_a_run_starts_on_the_root_that_the_parameters_name(start_top):
    run = start_top(initial__precession="fast", initial__psi_dot=200.0)
    assert run.state()["kind"] == "regular"


def test_a_run_starts_from_the_quaternion_of_the_parameters(start_top):
    half = math.sqrt(0.5)
    start = {"orientation": [half, 0.0, 0.0, half], "angular_velocity": [0.0, 0.0, 150.0]}
    state = start_top(**{f"initial__{name}": value for name, value in start.items()}).state()
    assert state["turning_angles"][0] == pytest.approx(math.pi / 2, abs=1e-15)
    assert state["euler_rates"]["psi"] != 0


@pytest.mark.wording
def test_another_factor_hurries_by_it(start_top):
    run = start_top(scene="hurry_slow", hurry_factor=2.0)
    assert run.trigger("hurry_precession")[1].startswith("Precession 6.50 -> 12.99 rad/s")
    run.trigger("reset")
    assert run.change({"hurry_factor": 0.5})[0]
    assert run.trigger("hurry_precession")[1].startswith("Precession 6.50 -> 3.25 rad/s")


def test_messages_and_description_bear_the_frames_that_were_asked_for(start_top):
    run = start_top(world_frame="map", top_frame="gyro")
    samples = run.collect(QuaternionStamped, "/top/orientation")
    described = run.collect(String, "/robot_description", LATCHED)
    run.spin_until(lambda: samples and described)
    assert samples[0].header.frame_id == "map"
    assert '"map"' in described[0].data
    assert '"gyro"' in described[0].data


@pytest.mark.parametrize("full", ["/gyro", "/lab/gyro", "/a/top"])
def test_a_top_of_another_name_has_its_own_frame_description_and_diagnostics(
    full, start_top, tmp_path
):
    namespace, _, name = full.rpartition("/")
    arguments = ["--ros-args", "-r", f"__ns:={namespace or '/'}", "-r", f"__node:={name}"]
    run = start_top(arguments=arguments, record=tmp_path, imu__enabled=True)
    place = namespace if name == "top" else full
    described = run.collect(String, f"{place}/robot_description", LATCHED)
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: described and diagnostics)
    topics = {topic for topic, _ in run.top.get_topic_names_and_types()}
    unnamed = "/robot_description", f"{namespace}/robot_description"
    assert name == "top" or not topics.intersection(unnamed)
    frame = full.lstrip("/")
    assert run.top.get_parameter("top_frame").value == frame
    for link in ("", "_precession", "_tilt"):
        assert f'<link name="{frame}{link}"' in described[0].data
    for status in diagnostics[0].status:
        assert status.hardware_id == full
        assert status.name.startswith(f"{frame}: ")
    run.top.session.close()
    (path,) = tmp_path.iterdir()
    (batch, *_) = assert_no_deviation(path, full).batches()
    assert batch.events[0][1].values["top_frame"] == frame
    assert len(batch.columns["tf"].stamps) == len(batch.columns["imu"].stamps) > 0


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
    run.wait_for(transforms, 6)
    assert all(b"world" in data and b"top" in data for data in transforms)
    assert run.change({"publish_tf": False})[0]
    run.wait_for(samples, 6)
    transforms.clear()
    run.wait_for(samples, 25)
    assert transforms == []
