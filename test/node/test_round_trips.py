"""Values that come back in the form in which ROS tools write them."""

import pytest
import yaml
from odd_values import assert_one_sentence
from rcl_interfaces.msg import Parameter, ParameterValue

from symtop_ros.simulation.validation import RefusedError


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


def test_an_override_of_qos_for_a_topic_that_there_is_not_is_warned_about(start_top, capfd):
    start_top(**{"qos_overrides./top/orientatio.publisher.depth": 5})
    said = capfd.readouterr().err
    assert "'qos_overrides./top/orientatio.publisher.depth' is unknown" in said
    assert "(nearest: qos_overrides./top/orientation.publisher.depth)" in said


@pytest.mark.parametrize(
    ("policy", "value"), [("depth", -1), ("depth", "x"), ("reliability", "foo"), ("history", 3)]
)
def test_a_bad_override_of_qos_is_refused_in_one_line(start_top, policy, value, capfd):
    topic = "qos_overrides./top/orientation.publisher"
    with pytest.raises(RefusedError) as refusal:
        start_top(**{f"{topic}.{policy}": value})
    assert_one_sentence(str(refusal.value))
    assert str(refusal.value).startswith(f"{topic} must be valid, got: ")
    assert str(value) in str(refusal.value)
    assert "rcutils" not in capfd.readouterr().err


@pytest.mark.parametrize(
    ("value", "granted"),
    [
        (ParameterValue(double_value=9.0), True),
        (ParameterValue(integer_value=9), True),
        (ParameterValue(type=4, string_value="9e0"), True),
        (ParameterValue(type=2, integer_value=9), True),
        (ParameterValue(), False),
        (ParameterValue(double_value=9.0, integer_value=9), False),
    ],
)
def test_a_value_without_a_type_is_the_one_field_that_is_set(start_top, value, granted):
    run = start_top()
    parameter = Parameter(name="precession_rate", value=value)
    ((successful, reason),) = run.send("kick", [parameter])
    assert successful is granted
    if granted:
        rate = run.top.simulation.segment.motion.start.euler_rates.phi
        assert rate == pytest.approx(9.0, rel=1e-13)  # rounding of psi' = 200 rad/s
    else:
        assert reason.startswith("type of 'precession_rate' must be ")
