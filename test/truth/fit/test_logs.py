"""Records from logs: attitudes, and what a sensor measures, with or without an attitude."""

import shutil

import numpy as np
import pytest
from truth.fit.cases import CUSPS, TIMES
from truth.judge.cases import write_log

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import specific_force
from symtop_ros.run.wire.messages import IMU
from symtop_ros.truth.fit.logs import read_log

STAMPS = (TIMES * 1e9).astype(np.int64) + 7
STATE = CUSPS.at(TIMES)
FORCES = specific_force(CUSPS, STATE, (0.0, 0.0, 0.125))


def encode_imu(covariance):
    """Return Imu messages of drivers that have an attitude (0), or none (-1)."""
    layout = IMU.layout("imu")
    values = {
        "orientation": STATE.orientation[:, [1, 2, 3, 0]],
        "orientation_covariance": covariance,
        "angular_velocity": STATE.angular_velocity,
        "linear_acceleration": FORCES,
    }
    rows = IMU.arrange((len(TIMES),), values).tolist()
    stamped = zip(STAMPS.tolist(), rows, strict=True)
    return [(stamp, layout.encode(stamp, row)) for stamp, row in stamped]


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    topics = {"/imu": encode_imu(-1.0), "/other": encode_imu(0.0)}
    write_log(path, {name: (IMU.type, data) for name, data in topics.items()})
    return path


@pytest.mark.parametrize("topic", ["/imu", "/other"])
def test_a_gyroscope_without_an_attitude_is_read(log, topic):
    rows = read_log(log, topic, None, "rates")
    assert rows.values.tolist() == STATE.angular_velocity.tolist()
    assert rows.times == pytest.approx(TIMES, abs=1e-9)


def test_an_accelerometer_is_read_with_its_gyroscope(log):
    rows = read_log(log, "/imu", None, "inertial")
    assert rows.values.tolist() == np.concatenate([STATE.angular_velocity, FORCES], 1).tolist()


def test_attitudes_are_read_unless_a_kind_is_asked_for(log):
    rows = read_log(log, "/other", None, None)
    assert rows.kind == "attitude"
    assert np.abs((rows.values * STATE.orientation).sum(axis=1)) == pytest.approx(1.0, abs=1e-12)
    with pytest.raises(RefusedError, match="/imu must have messages with an attitude, got none"):
        read_log(log, "/imu", None, None)


@pytest.mark.parametrize(
    ("topic", "kind", "reason"),
    [
        (None, None, "--topic must name the measurements"),
        ("/imu", "pixels", "--kind must be one of attitude, rates, inertial for a log, got pixels"),
        ("/none", None, "--topic must be one of /imu, /other, /top/events, got /none"),
    ],
)
def test_what_a_log_does_not_have_is_named(log, topic, kind, reason):
    with pytest.raises(RefusedError, match=reason):
        read_log(log, topic, None, kind)


def write_imu(folder, **covariances):
    """A log of one topic /imu, whose covariances are given by rows, or for all of them."""
    values = {
        "orientation": STATE.orientation[:, [1, 2, 3, 0]],
        "angular_velocity": STATE.angular_velocity,
        "linear_acceleration": FORCES,
    }
    rows = IMU.arrange((len(TIMES),), values)
    for name, covariance in covariances.items():
        rows[:, IMU.quantities[f"{name}_covariance"].start] = covariance
    layout = IMU.layout("imu")
    stamped = zip(STAMPS.tolist(), rows.tolist(), strict=True)
    data = [(stamp, layout.encode(stamp, row)) for stamp, row in stamped]
    write_log(folder / "run.mcap", {"/imu": (IMU.type, data)})
    return folder / "run.mcap"


def test_rates_that_a_message_says_are_absent_are_not_taken(tmp_path):
    path = write_imu(tmp_path, angular_velocity=-1.0)
    said = f"{len(TIMES)} messages have no angular velocity: absent by covariance, frame or nan"
    for kind in ("rates", "inertial"):
        with pytest.raises(RefusedError, match=f"/imu must have .*angular velocity.*, got {said}"):
            read_log(path, "/imu", None, kind)
    rows = read_log(path, "/imu", None, None)
    assert (rows.kind, len(rows.times)) == ("attitude", len(TIMES))
    assert said in rows.notes


def test_rows_in_which_a_force_is_absent_are_left_out(tmp_path):
    absent = np.where(np.arange(len(TIMES)) % 3, 0.0, -1.0)
    path = write_imu(tmp_path, linear_acceleration=absent)
    rows = read_log(path, "/imu", None, "inertial")
    assert rows.values[:, 3:].tolist() == FORCES[absent == 0.0].tolist()
    assert rows.notes[0].endswith(
        " messages have no linear acceleration: absent by covariance, frame or nan"
    )
    assert len(read_log(path, "/imu", None, "rates").times) == len(TIMES)


METADATA = """\
rosbag2_bagfile_information:
  relative_file_paths: [run.mcap]
  starting_time: {nanoseconds_since_epoch: 0}
  duration: {nanoseconds: 0}
  message_count: 1000000
"""


def test_what_a_bag_lacks_is_a_note_of_the_record(log, tmp_path):
    shutil.copy(log, tmp_path)
    assert read_log(tmp_path, "/imu", None, "rates").notes == ()
    (tmp_path / "metadata.yaml").write_text(METADATA)
    (note,) = read_log(tmp_path, "/imu", None, "rates").notes
    assert note.startswith("messages of the bag are missing (metadata.yaml: ")
    assert note.endswith(" of 1000000 messages)")
