"""Parameters by their own table: defaults, ranges, and refusals in words."""

import math

import pytest
from odd_values import assert_one_sentence

from symtop_ros.base.refusals import MAX_SENTENCE, RefusedError, one_line
from symtop_ros.run.simulation.changes.requests import initial_state
from symtop_ros.run.simulation.settings import PARAMETERS, Settings

RANGED = [name for name, parameter in PARAMETERS.items() if parameter.limits]
VECTORS = {name: p.condition[0] for name, p in PARAMETERS.items() if p.default == []}
# Of no parameter: numbers that are none, and text that cannot be printed or stand in a message.
WRONG = (None, math.nan, [None], "\x1b[31m", "a\nb", "\udcff", b"\xff", "x" * 1_000_000, object())


def test_a_description_ends_with_the_unit():
    assert PARAMETERS["top.Ix"].description.endswith(" (kg m^2)")
    assert PARAMETERS["real_time_factor"].description.endswith(" (no unit)")


def refusal(values):
    """The sentence of a refusal; empty if the values are granted."""
    try:
        Settings.from_values(values)
    except RefusedError as refused:
        assert_one_sentence(str(refused))
        return str(refused)
    return ""


@pytest.mark.parametrize("name", PARAMETERS)
def test_the_default_of_a_parameter_is_valid_and_what_no_parameter_takes_is_refused(name):
    parameter = PARAMETERS[name]
    clean = parameter.validate(name, parameter.default)
    assert parameter.validate(name, clean) == clean
    for value in WRONG:
        assert refusal({name: value}).startswith(f"{name} must "), value


def test_sensors_frames_topics_and_the_log_are_chosen_at_the_start():
    fixed = {name for name, parameter in PARAMETERS.items() if parameter.read_only}
    groups = ("imu.", "magnetic_field.", "odometry.")
    assert fixed - {name for name in PARAMETERS if name.startswith(groups)} == {
        "publish_clock",
        "publish_markers",
        "record.directory",
        "record.enabled",
        "scheduling_priority",
        "start_paused",
        "top_frame",
        "world_frame",
    }
    assert fixed >= {name for name in PARAMETERS if name.startswith(groups)}


@pytest.mark.parametrize("name", RANGED)
def test_a_number_may_be_at_the_limits_of_its_range_and_is_refused_beyond_them(name):
    parameter = PARAMETERS[name]
    low, high = parameter.limits
    for value in (low, high):
        assert parameter.validate(name, value) == value
    beyond = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
    for value in (*beyond, math.inf, -math.inf, 10**400, True, "much"):
        assert refusal({name: value}).startswith(f"{name} must be {parameter.condition}, got ")
    if isinstance(parameter.default, int):
        assert refusal({name: 0.5}) == f"{name} must be {parameter.condition}, got 0.5"


LIMITS = (
    "imu.limits.gyroscope_range",
    "imu.limits.gyroscope_resolution",
    "imu.limits.accelerometer_range",
    "imu.limits.accelerometer_resolution",
)
NOISE = (
    "imu.noise.gyroscope_noise_density",
    "imu.noise.gyroscope_random_walk",
    "imu.noise.accelerometer_noise_density",
    "imu.noise.accelerometer_random_walk",
    "magnetic_field.noise.magnetometer_noise_density",
    "magnetic_field.noise.magnetometer_random_walk",
)
# Part of the interface: `ros2 param describe` shows them, and a launch file may rely on them.
RANGES = {
    ("top.Ix", "top.Iz"): (1e-30, 1e30),
    ("top.Mgl",): (-1e30, 1e30),
    ("initial.theta",): (0.0, math.pi),
    ("initial.phi", "initial.psi"): (-1e3, 1e3),
    ("initial.theta_dot", "initial.phi_dot", "initial.psi_dot"): (-1e9, 1e9),
    ("friction.axial", "friction.transverse"): (0.0, 1e30),
    ("applied_torque_timeout",): (1e-3, 1e6),
    ("hurry_factor",): (-1e6, 1e6),
    ("publish_rate",): (1.0, 2000.0),
    ("real_time_factor",): (1e-3, 100.0),
    ("record.max_size",): (0.0, 1e15),
    ("record.max_duration",): (0.0, 1e9),
    ("mass",): (0.0, 1e30),
    ("gravity",): (1e-3, 1e3),
    NOISE: (0.0, 1e6),
    LIMITS: (0.0, 1e9),
    ("imu.noise.seed", "magnetic_field.noise.seed"): (0, 2**53),
    ("scheduling_priority",): (0, 99),
}


def test_every_number_has_the_range_that_users_rely_on():
    promised = {name: limits for names, limits in RANGES.items() for name in names}
    assert {name: PARAMETERS[name].limits for name in RANGED} == promised


@pytest.mark.parametrize("name", VECTORS)
def test_a_vector_has_its_size_of_numbers_and_may_be_text_or_empty(name):
    validate = PARAMETERS[name].validate
    size = int(VECTORS[name])
    ones = [0] * (size - 1) + [1]
    assert validate(name, ones) == validate(name, str(ones)) == tuple(ones)
    assert validate(name, []) == validate(name, ()) == ()
    for value in ([1.0] * (size - 1), [1.0] * (size + 1), 5, 0, True, "abc", b"abcd"[:size]):
        assert refusal({name: value}).startswith(f"{name} must have {size} elements ("), value
    for odd in (math.nan, math.inf, 1e31, "a"):
        assert refusal({name: [odd, *ones[1:]]}).startswith(f"{name} must be {size} numbers from ")


ALONE = "initial.angular_velocity must be set together with initial.orientation, got none"
UNIT = [0.0, 0.0, 0.0, 1.0]
FASTEST = {"publish_clock": True, "publish_rate": 1000.0}


MISFITS = [
    ({"top.Iz": 1.0}, "top.Iz must be > 0 and <= 2 Ix = 0.000456 kg m^2, got 1"),
    ({"initial.angular_velocity": [0.0, 0.0, 1.0]}, ALONE),
    ({"imu.orientation": [0.0, 0.0, 0.0, 0.5]}, "imu.orientation must be a quaternion of norm"),
    ({"initial.precession": "odd"}, 'initial.precession must be "" or "slow" or "fast", got '),
    ({"publish_tf": 1}, "publish_tf must be true or false, got 1"),
    ({"top_frame": "/top"}, "top_frame must be 'top', without the leading slash, got '/top'"),
    ({"world_frame": " "}, "world_frame must be the name of a frame (1 to 200 printable "),
    ({"world_frame": "w" * 201}, "world_frame must be the name of a frame (1 to 200 printable"),
    ({**FASTEST, "real_time_factor": 2.001}, "publish_rate times real_time_factor must be at "),
]


@pytest.mark.parametrize(("values", "sentence"), MISFITS)
def test_values_that_do_not_fit_are_refused(values, sentence):
    assert refusal(values).startswith(sentence)


def test_an_exponent_makes_text_a_number_as_in_yaml():
    assert PARAMETERS["hurry_factor"].validate("hurry_factor", "2e0") == 2.0
    assert refusal({"hurry_factor": "2"}).endswith(", got '2'")


def test_values_next_to_those_that_do_not_fit_are_granted():
    for values in (
        {"initial.angular_velocity": [0.0, 0.0, 1.0], "initial.orientation": UNIT},
        {**FASTEST, "real_time_factor": 2.0},
        {"publish_rate": 2000.0, "real_time_factor": 100.0},
        {"world_frame": "w" * 200, "top.Iz": 2 * 2.28e-4},
    ):
        assert refusal(values) == ""


def test_lines_become_one_and_control_characters_are_escaped():
    assert one_line("a\n  b\r\n\x1b[31m\udcff") == "a b \\x1b[31m\\udcff"
    assert one_line("θ' = 0.5") == "θ' = 0.5"


def test_long_text_is_shortened_in_its_middle_and_soon():
    for text in ("x" * 10_000_000, "\x1b" * 10_000_000, "a b " * 1_000_000):
        line = one_line(f"begin {text} end")
        assert len(line) == MAX_SENTENCE
        assert line.startswith("begin ")
        assert line.endswith(" end")
        assert "..." in line


def test_a_rate_that_is_given_ends_the_regular_precession_of_a_scene():
    assert Settings.from_scene("hurry_slow").initial.precession == "slow"
    initial = Settings.from_scene("hurry_slow", initial__phi_dot=3.0).initial
    assert (initial.precession, initial.phi_dot) == ("", 3.0)
    both = {"initial__phi_dot": 3.0, "initial__precession": "fast"}
    assert Settings.from_scene("hurry_slow", **both).initial.precession == "fast"


def test_a_condition_is_written_in_round_numbers():
    assert PARAMETERS["top.Ix"].condition == "1e-30 to 1e+30 kg m^2"


def test_an_orientation_without_an_angular_velocity_starts_at_rest():
    settings = Settings.from_values({"initial.orientation": [0.6, 0.0, 0.0, 0.8]})
    state = initial_state(settings.top, settings.initial, {})
    assert state.orientation.tolist() == [0.8, 0.6, 0.0, 0.0]
    assert state.angular_velocity.tolist() == [0.0, 0.0, 0.0]
