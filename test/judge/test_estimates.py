"""Estimates from each message type, from logs of any kind and from CSV files."""

import numpy as np
import pytest
from judge.cases import encode, make_estimates, truth_and_stamps

from symtop_ros.judge.estimates import FORMATS, TF_TYPE, decode_estimates, read_csv
from symtop_ros.log.reader import LogError
from symtop_ros.wire.messages import TRANSFORM


@pytest.fixture(scope="module")
def estimates():
    truth, stamps = truth_and_stamps(50)
    return make_estimates(truth, stamps)


@pytest.mark.parametrize("kind", sorted(FORMATS))
def test_every_type_with_an_attitude_is_read(kind, estimates):
    _, messages = encode(kind, estimates)
    found = decode_estimates(kind, [data for _, data in messages])
    assert (found.stamps == estimates.stamps).all()
    assert (found.orientations == estimates.orientations).all()
    if not {"angular_velocity", "angular"} & set(FORMATS[kind].quantities):
        assert found.angular_velocities is None
    else:
        assert (found.angular_velocities == estimates.angular_velocities).all()


@pytest.mark.parametrize("kind", sorted(FORMATS))
def test_the_real_message_classes_are_read(kind):
    serialization = pytest.importorskip("rclpy.serialization")
    package, _, name = kind.split("/")
    module = pytest.importorskip(f"{package}.msg")
    message = getattr(module, name)()
    message.header.stamp.sec, message.header.stamp.nanosec = 3, 7
    message.header.frame_id = "odd"
    holder = message
    for part in ("pose", "pose", "transform"):
        holder = getattr(holder, part, holder)
    field = "orientation" if hasattr(holder, "orientation") else "rotation"
    q = getattr(holder, field, None) or holder.quaternion
    q.w, q.x, q.y, q.z = 0.5, -0.5, 0.5, 0.5
    found = decode_estimates(kind, [serialization.serialize_message(message)])
    assert found.stamps.tolist() == [3_000_000_007]
    assert found.orientations.tolist() == [[0.5, -0.5, 0.5, 0.5]]


def test_an_imu_without_orientation_is_left_out(estimates):
    _, messages = encode("sensor_msgs/msg/Imu", estimates)
    layout = FORMATS["sensor_msgs/msg/Imu"].layout("imu")
    unknown = layout.encode(5, [0.0, 0, 0, 1, -1.0, *[0.0] * 32])
    found = decode_estimates("sensor_msgs/msg/Imu", [messages[0][1], unknown, b"noise"])
    assert (len(found), found.left_out) == (1, 2)


def test_transforms_of_several_frames_need_a_name(estimates):
    numbers = [0.0, 0, 0, 0, 0, 0, 1]
    data = [TRANSFORM.layout("world", child).encode(9, numbers) for child in ("a", "b")]
    with pytest.raises(LogError, match="--frame must be one of a, b, got none"):
        decode_estimates(TF_TYPE, data)
    assert decode_estimates(TF_TYPE, data, "b").stamps.tolist() == [9]
    assert len(decode_estimates(TF_TYPE, data, "c")) == 0


def test_a_type_without_attitude_is_refused():
    with pytest.raises(LogError, match="topic must have a type with an attitude"):
        decode_estimates("std_msgs/msg/String", [])


def test_a_csv_file_with_stamps_or_seconds_is_read(tmp_path, estimates):
    numbers = np.hstack((estimates.orientations, estimates.angular_velocities)).tolist()
    stamps = estimates.stamps.tolist()
    times = {"stamp": map(str, stamps), "t": (f"{s // 10**9}.{s % 10**9:09d}" for s in stamps)}
    for name, column in times.items():
        path = tmp_path / f"{name}.csv"
        rows = [",".join([t, *map(repr, n)]) for t, n in zip(column, numbers, strict=True)]
        path.write_text("\n".join([f"{name},w,x,y,z,wx,wy,wz", *rows]) + "\n")
        found = read_csv(path)
        assert found.stamps.tolist() == stamps
        assert (found.orientations == estimates.orientations).all()
        assert (found.angular_velocities == estimates.angular_velocities).all()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "must have the columns stamp \\(ns\\) or t \\(s\\), w, x, y, z; got no t"),
        ("t,w,x,y\n", "got no z"),
        ("t,w,x,y,z\n0,1,0,0,none\n", "line 2 of .* must consist of numbers"),
        ("t,w,x,y,z\n1e999,1,0,0,0,\n\0", "line 3|not a CSV file|must consist of numbers"),
        ("stamp,w,x,y,z\n0.5,1,0,0,0\n", "line 2 of .* must consist of numbers"),
    ],
)
def test_a_damaged_csv_file_is_one_line(tmp_path, text, reason):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(LogError, match=reason):
        read_csv(path)


def test_what_is_no_attitude_is_left_out(tmp_path):
    path = tmp_path / "odd.csv"
    path.write_text("t,w,x,y,z\n0,0,0,0,0\n1,nan,0,0,0\n-1,1,0,0,0\n1e30,1,0,0,0\n2,3,0,0,0\n")
    found = read_csv(path)
    assert found.orientations.tolist() == [[1.0, 0.0, 0.0, 0.0]]
    assert found.left_out == 4
