"""Parameters: descriptors, refusals at start-up and later, and changes that take effect."""

import pytest
import rclpy
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_no_deviation
from geometry_msgs.msg import QuaternionStamped
from odd_values import assert_one_sentence
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes
from rclpy.qos import QoSReliabilityPolicy
from ros.node.running_top import LATCHED, RunningTop
from std_msgs.msg import String

from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.simulation.settings import PARAMETERS

QOS = "qos_overrides./top/orientation.publisher"
BAD = ("depth", -1), ("depth", "x"), ("reliability", "foo"), ("history", 3)
CLOCKS = {"use_sim_time": True, "publish_clock": True}
READ_ONLY = "(read-only after the start of the node)"
UNKNOWN_NAME = "parameter name must be known (the nearest is {}), got '{}'"
UNKNOWN_TYPE = "type of 'publish_rate' must be 0 to 9, got 77"
ONE = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=1.0)
ONE_HALF = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=0.5)
TEXT = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="x")
NO_VALUE = ParameterValue()
UNKNOWN = r"parameter name must be known \(the nearest is top.Mgl\), got 'top.Mg'"


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"scene": "nowhere"}, "scene must be one of above_fast_root, backward_start,"),
        ({"top__Mg": 1.0}, UNKNOWN),
        (CLOCKS, "publish_clock must be false together with use_sim_time, got true"),
        *(({f"{QOS}.{k}": value}, f"{QOS} must be valid, got: .*{value}") for k, value in BAD),
    ],
)
def test_a_bad_value_at_start_up_is_refused_in_one_line(start_top, values, words, capfd):
    """test/run/simulation/test_settings.py has those of each parameter."""
    with pytest.raises(RefusedError, match=f"^{words}") as refusal:
        start_top(**values)
    assert_one_sentence(str(refusal.value))
    assert "rcutils" not in capfd.readouterr().err


def test_a_bad_value_later_is_refused_and_the_motion_is_unchanged(start_top):
    run = start_top()
    events = run.collect_events()
    before = run.top.simulation.segment
    for values, sentence in (
        ({"publish_rate": 5000.0}, "publish_rate must be 1 to 2000 Hz, got 5000"),
        *(({name: other(name)}, f"{name} must be ") for name in FIXED),
    ):
        granted, reason = run.change(values)
        assert not granted
        assert reason.startswith(sentence)
    assert run.top.simulation.segment is before
    assert len(events) == 1


# As `ros2 param set` and rqt send them, and what the node says of each: no words of rclpy.
KIND = ParameterType
REFUSALS = {
    "unknown": ("top.Mg", ONE, UNKNOWN_NAME.format("top.Mgl", "top.Mg")),
    "unknown, of no group": (
        "publish_rat",
        ONE,
        UNKNOWN_NAME.format("publish_rate", "publish_rat"),
    ),
    "unknown QoS": (
        "qos_overrides./top/orientation.publisher.dept",
        ONE,
        UNKNOWN_NAME.format(
            "qos_overrides./top/orientation.publisher.depth",
            "qos_overrides./top/orientation.publisher.dept",
        ),
    ),
    "text for a flag": ("publish_tf", TEXT, "publish_tf must be true or false, got 'x'"),
    "text for a number": ("hurry_factor", TEXT, "hurry_factor must be -1e+06 to 1e+06, got 'x'"),
    "text for a list": (
        "steady_torque",
        TEXT,
        "steady_torque must have 3 elements (N m, world frame), got 'x'",
    ),
    "number for text": (
        "initial.precession",
        ONE,
        'initial.precession must be "" or "slow" or "fast", got 1',
    ),
    "out of range": ("publish_rate", ONE_HALF, "publish_rate must be 1 to 2000 Hz, got 0.5"),
    "text for a flag of ROS": ("use_sim_time", TEXT, "use_sim_time must be of type bool, got 'x'"),
    "no value of ROS": ("use_sim_time", NO_VALUE, "use_sim_time must be of type bool, got None"),
    "no value": ("publish_rate", NO_VALUE, "publish_rate must be 1 to 2000 Hz, got None"),
    "fixed": ("scene", TEXT, f"scene must be 'cusps' {READ_ONLY}, got 'x'"),
    "fixed, ours": (
        "imu.enabled",
        ParameterValue(type=KIND.PARAMETER_BOOL, bool_value=True),
        f"imu.enabled must be False {READ_ONLY}, got True",
    ),
    "fixed QoS": (
        "qos_overrides./top/orientation.publisher.depth",
        ParameterValue(type=KIND.PARAMETER_INTEGER, integer_value=7),
        f"qos_overrides./top/orientation.publisher.depth must be 100 {READ_ONLY}, got 7",
    ),
    "unknown type": ("publish_rate", ParameterValue(type=77), UNKNOWN_TYPE),
}


@pytest.fixture(scope="module", name="asked")
def _asked():
    with RunningTop() as run:
        yield run


@pytest.mark.parametrize("service", ["set_parameters", "set_parameters_atomically"])
@pytest.mark.parametrize("kind", REFUSALS)
def test_each_refusal_is_in_the_words_of_the_node(asked, service, kind):
    name, value, reason = REFUSALS[kind]
    before = asked.top.simulation.event_number
    assert asked.send(service, [ParameterMessage(name=name, value=value)]) == [(False, reason)]
    assert asked.top.simulation.event_number == before


def test_a_request_with_one_refused_parameter_sets_the_others_one_by_one_only(asked):
    good = rclpy.Parameter("hurry_factor", value=1.25).to_parameter_msg()
    bad = ParameterMessage(name="top.Mg", value=ONE)
    reason = UNKNOWN_NAME.format("top.Mgl", "top.Mg")
    assert asked.send("set_parameters_atomically", [good, bad]) == [(False, reason)]
    assert asked.top.get_parameter("hurry_factor").value == 1.4
    assert asked.send("set_parameters", [good, bad]) == [(True, ""), (False, reason)]
    assert asked.top.get_parameter("hurry_factor").value == 1.25


@pytest.mark.parametrize(
    ("kind", "service", "field"),
    [
        (GetParameters, "get_parameters", "values"),
        (GetParameterTypes, "get_parameter_types", "types"),
        (DescribeParameters, "describe_parameters", "descriptors"),
    ],
)
def test_a_question_about_an_unknown_parameter_has_an_empty_answer(asked, kind, service, field):
    """These services have no place for a reason; rclpy leaves out all that was asked for."""
    request = kind.Request(names=["top.Mg", "top.Ix"])
    answer = getattr(asked.connection.call(kind, service, request), field)
    assert list(answer) in ([], [KIND.PARAMETER_NOT_SET] * len(answer))


FIXED = ["scene", *(name for name, parameter in PARAMETERS.items() if parameter.read_only)]


def other(name):
    """A valid value of a parameter that is not its default."""
    default = PARAMETERS[name].default if name in PARAMETERS else "cusps"
    if isinstance(default, bool | str):
        return "disc" if isinstance(default, str) else not default
    return [0.0, 0.6, 0.0, 0.8][-int(PARAMETERS[name].condition[0]) :] if default == [] else 1


TYPES = {bool: "BOOL", int: "INTEGER", float: "DOUBLE", str: "STRING", list: "DOUBLE_ARRAY"}
KINDS_OF_TYPES = {kind: getattr(ParameterType, f"PARAMETER_{TYPES[kind]}") for kind in TYPES}
BYTES = ParameterType.PARAMETER_BYTE_ARRAY


def read(run, *names):
    request = GetParameters.Request(names=names)
    return run.connection.call(GetParameters, "get_parameters", request).values


def put(run, name, **value):
    """The request that `ros2 param set` sends."""
    parameters = [ParameterMessage(name=name, value=ParameterValue(**value))]
    return run.send("set_parameters", parameters)[0]


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


def test_a_value_of_a_related_type_is_stored_as_a_double(start_top):
    run = start_top()
    for name, value, expected in (
        ("hurry_factor", {"type": 2, "integer_value": 2}, 2.0),
        ("steady_torque", {"type": 7, "integer_array_value": [0, 0, 1]}, [0.0, 0.0, 1.0]),
        ("steady_torque", {"type": BYTES}, []),
        ("initial.orientation", {"type": 6}, []),  # `ros2 param set ... []`
    ):
        assert put(run, name, **value) == (True, "")
        (found,) = read(run, name)
        assert found.type == KINDS_OF_TYPES[type(PARAMETERS[name].default)]
        assert expected in (found.double_value, [*found.double_array_value])


def test_all_that_a_dumped_file_sets_is_accepted_while_the_node_runs(start_top):
    run = start_top(imu__position=[0.0, 0.0, 1.0])
    names = [*run.top.get_parameters_by_prefix("")]
    values = read(run, *names)
    parameters = [ParameterMessage(name=n, value=v) for n, v in zip(names, values, strict=True)]
    for service in ("set_parameters", "set_parameters_atomically"):
        assert set(run.send(service, parameters)) == {(True, "")}
    assert not put(run, "scene", type=4, string_value="disc")[0]


def test_every_parameter_is_described_with_its_range(start_top):
    run = start_top()
    request = DescribeParameters.Request(names=[*PARAMETERS])
    described = run.connection.call(DescribeParameters, "describe_parameters", request)
    assert [found.name for found in described.descriptors] == [*PARAMETERS]
    for found in described.descriptors:
        assert found.description
        assert found.additional_constraints.startswith("must be ")
        assert found.name != "publish_rate" or "Hz" in found.additional_constraints
        limits = PARAMETERS[found.name].limits
        ranges = [*found.floating_point_range, *found.integer_range]
        assert [(each.from_value, each.to_value) for each in ranges] == [limits] * bool(limits)
        assert all(each.step == bool(found.integer_range) for each in ranges)


def test_the_qos_of_a_topic_can_be_overridden(start_top):
    run = start_top(**{"qos_overrides./top/orientation.publisher.reliability": "best_effort"})
    info = run.top.get_publishers_info_by_topic("/top/orientation")[0]
    assert info.qos_profile.reliability == QoSReliabilityPolicy.BEST_EFFORT


def test_messages_and_description_bear_the_frames_that_were_asked_for(start_top):
    run = start_top(world_frame="map", top_frame="gyro")
    samples = run.collect(QuaternionStamped, "/top/orientation")
    described = run.collect(String, "/top/robot_description", LATCHED)
    run.spin_until(lambda: samples and described)
    assert samples[0].header.frame_id == "map"
    assert '"map"' in described[0].data
    assert '"gyro"' in described[0].data


@pytest.mark.parametrize("full", ["/gyro", "/lab/gyro", "/a/top", "/top"])
def test_a_top_of_another_name_has_its_own_frame_and_diagnostics(full, start_top, tmp_path):
    namespace, _, name = full.rpartition("/")
    arguments = ["--ros-args", "-r", f"__ns:={namespace or '/'}", "-r", f"__node:={name}"]
    run = start_top(arguments=arguments, record=tmp_path, imu__enabled=True)
    described = run.collect(String, f"{full}/robot_description", LATCHED)
    diagnostics = run.collect(DiagnosticArray, "/diagnostics")
    run.spin_until(lambda: described and diagnostics)
    topics = {topic for topic, _ in run.top.get_topic_names_and_types()}
    unnamed = "/robot_description", f"{namespace}/robot_description"
    assert not topics.intersection(unnamed)  # those of a robot
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


@pytest.fixture
def start_from(start_top, tmp_path):
    """Start a node with the parameters of a file, given by its text."""

    def start(text):
        (tmp_path / "top.yaml").write_text(text)
        return start_top(arguments=["--ros-args", "--params-file", str(tmp_path / "top.yaml")])

    return start


def test_a_node_starts_from_its_dumped_parameters(start_top, start_from, capfd):
    """As `ros2 param dump` writes them; ros2cli is not on PyPI."""
    first = start_top(scene="vertical_torque", hurry_factor=1.2)
    parameters = {}
    for name, parameter in first.top.get_parameters_by_prefix("").items():
        value = parameter.value
        parameters[name] = value if isinstance(value, str | bool | float | int) else list(value)
    assert parameters["initial.orientation"] == []
    capfd.readouterr()
    again = start_from(yaml.safe_dump({"/top": {"ros__parameters": parameters}}))
    assert again.top.simulation.settings == first.top.simulation.settings
    assert "unknown" not in capfd.readouterr().err


def test_unknown_parameters_of_other_nodes_are_warned_about(start_from, capfd):
    start_from("/**:\n  ros__parameters:\n    camera: {exposure: 3.0}\n")
    assert "'camera.exposure' is unknown" in capfd.readouterr().err


def test_a_thousand_parameters_of_other_nodes_are_six_lines(start_from, capfd):
    lines = "".join(f"    camera_{number}: {number}\n" for number in range(1000))
    start_from(f"/**:\n  ros__parameters:\n{lines}")
    said = [line for line in capfd.readouterr().err.splitlines() if "not used" in line]
    assert len(said) == 6
    assert said[-1].endswith("995 more parameters are unknown and not used")


def test_an_override_of_qos_for_a_topic_that_there_is_not_is_warned_about(start_top, capfd):
    start_top(**{"qos_overrides./top/orientatio.publisher.depth": 5})
    said = capfd.readouterr().err
    assert "'qos_overrides./top/orientatio.publisher.depth' is unknown" in said
    assert "(nearest: qos_overrides./top/orientation.publisher.depth)" in said


def test_a_value_without_a_type_is_the_one_field_that_is_set(start_top):
    run = start_top()
    accepted = [{"double_value": 9.0}, {"integer_value": 9}, {"type": 4, "string_value": "9e0"}]
    accepted.append({"type": 2, "integer_value": 9})
    for fields in (*accepted, {"double_value": 9.0, "integer_value": 9}):
        assert run.trigger("reset")[0]
        given = ParameterMessage(name="precession_rate", value=ParameterValue(**fields))
        ((successful, reason),) = run.send("kick", [given])
        assert successful is (fields in accepted)
        if successful:
            rate = run.top.simulation.segment.motion.start.euler_rates.phi_dot
            assert rate == pytest.approx(9.0, rel=1e-13)  # rounding of psi' = 200 rad/s
        else:
            assert reason.startswith("type of 'precession_rate' must be ")
