"""Estimates from tables of text, and from each message type."""

import math
import re

import pytest
from truth.judge.cases import SOME, encode, write_rows

from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.wire.messages import IMU, ODOMETRY, TRANSFORM
from symtop_ros.truth.judge.attitude_table import read_attitudes
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.topics.estimates import FORMATS, Estimates, decode_estimates

DAMAGED = [
    ("", "must have the columns stamp \\(ns\\) or t \\(s\\), w, x, y, z.* header nothing"),
    ("t,w,x,y\n", "got the header t,w,x,y"),
    ("t,w,x,y,z\n0,1,0,0,none\n", "line 2 of .* must consist of numbers"),
    ("t,w,x,y,z\n0,1,0,0\n", "line 2 of .* must have all columns, got 0,1,0,0"),
    ("t,w,x,y,z\n1e999,1,0,0,0,\n\0", "line 3|not a table|must consist of numbers"),
    ("stamp,w,x,y,z\n0.5,1,0,0,0\n", "line 2 .* stamp in whole ns .seconds go under t., got 0.5"),
    ("t,w,x,y,z,z\n0,1,0,0,0,0\n", "must have each column once, got z twice"),
    ("t,t,w,x,y,z\n0,0,1,0,0,0\n", "must have each column once, got t twice"),
    ("t,qw,qx,qy,qz,r.orientation.w,r.orientation.x,r.orientation.y,r.orientation.z\n", "one quat"),
    ("t,pose.orientation.x,a.orientation.y,orientation_z,orientation_w\n", "got the header t,pose"),
    ("timestamp,tx,ty,tz,a,b,c,d\n1,0,0,0,1,0,0,0\n", "got the header timestamp,tx,ty,tz,a,b,c,d"),
    ("t,w,x,y,z\n1_0,1,0,0,0\n", "line 2 of .* must consist of numbers"),
    ("stamp,w,x,y,z\n1_0,1,0,0,0\n", "line 2 of .* must consist of numbers"),
    ("t,w,x,y,z\n0,1_0,0,0,0\n", "line 2 of .* must consist of numbers"),
    (" ".join("1" * 12) + "\n", "must have times, got poses of KITTI"),
]


@pytest.mark.parametrize(("text", "reason"), DAMAGED)
def test_a_damaged_csv_file_is_one_line(tmp_path, text, reason):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(RefusedError, match=reason):
        read_attitudes(path)


NAMES = ("t", "w", "x", "y", "z")
POSITIONS = ("p_RS_R_x [m]", "p_RS_R_y [m]", "p_RS_R_z [m]")
EUROC = ("#timestamp", *POSITIONS, *(f"q_RS_{each} []" for each in "wxyz"))
TUM = {"separator": " ", "order": (1, 2, 3, 0), "middle": "000"}
RATES = ("wx", "wy", "wz")
FORMS = {
    "seconds.csv": {"order": range(7), "header": (*NAMES, *RATES)},
    "stamps.csv": {"order": range(7), "header": ("stamp", *NAMES[1:], *RATES), "seconds": False},
    "semicolons.csv": {"separator": ";", "header": NAMES},
    "tabs.csv": {"separator": "\t", "header": NAMES},
    "spaces.txt": {"separator": "  ", "header": NAMES},
    "hash.txt": {"separator": " ", "header": ("#", *NAMES)},
    "tum.tum": TUM,
    "tum.txt": {**TUM, "header": ("#", "timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw")},
    "euroc.csv": {"middle": "000", "header": EUROC, "seconds": False},
    "euroc_bare.csv": {"middle": "000", "seconds": False},
}


@pytest.mark.parametrize("name", FORMS)
def test_tables_of_all_forms_are_read(tmp_path, name):
    path = tmp_path / name
    path.write_text(write_rows(SOME, **FORMS[name]))
    found = read_attitudes(path).read()
    assert found.stamps.tolist() == SOME.stamps.tolist()
    assert (found.orientations == SOME.orientations).all()
    if "wx" in FORMS[name].get("header", ()):
        assert (found.angular_velocities == SOME.angular_velocities).all()
    else:
        assert found.angular_velocities is None
    guessed = name.startswith("tum.tum") or "bare" in name
    assert [note.partition(":")[0] for note in found.notes] == ["no names of columns"] * guessed


ORDERS = {"wxyz": (0, 1, 2, 3), "xyzw": (1, 2, 3, 0)}
HEADERS = [  # order, separator, header, and whether times are in seconds
    ("wxyz", ",", "t,w,x,y,z", True),
    ("xyzw", ",", "t,x,y,z,w", True),
    ("xyzw", ",", "timestamp,qx,qy,qz,qw", True),
    ("xyzw", ",", "timestamp,tx,ty,tz,qx,qy,qz,qw", True),
    ("xyzw", ",", "timestamp,tx,ty,tz,qx,qy,qz,qw", False),
    ("wxyz", ",", "timestamp,tx,ty,tz,q_w,q_x,q_y,q_z", False),
    ("xyzw", ",", "#timestamp,p_x,p_y,p_z,q_x,q_y,q_z,q_w", False),
    (
        "wxyz",
        ",",
        "#timestamp,p_RS_R_x [m],b [m],c [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []",
        False,
    ),
    ("xyzw", ",", "#timestamp [ns],a,b,c,q_RS_x [],q_RS_y [],q_RS_z [],q_RS_w []", False),
    ("wxyz", ",", "stamp,qw,qx,qy,qz", False),
    ("xyzw", ",", "stamp, qx, qy, qz, qw", False),
    ("wxyz", ",", "time,orientation.w,orientation.x,orientation.y,orientation.z", True),
    ("xyzw", ",", "time,orientation.x,orientation.y,orientation.z,orientation.w", True),
    (
        "xyzw",
        ",",
        "t,a.pose.orientation.x,a.pose.orientation.y,a.pose.orientation.z,a.pose.orientation.w",
        True,
    ),
    (
        "xyzw",
        ",",
        "t,/imu/orientation/x,/imu/orientation/y,/imu/orientation/z,/imu/orientation/w",
        True,
    ),
    ("wxyz", ",", "Time,W,X,Y,Z", True),
    ("wxyz", ",", '"t","w","x","y","z"', True),
    ("wxyz", ";", "t;w;x;y;z", True),
    ("xyzw", ";", "timestamp;quat_x;quat_y;quat_z;quat_w", True),
    ("xyzw", "\t", "t\tqx\tqy\tqz\tqw", True),
    ("xyzw", " ", "timestamp tx ty tz qx qy qz qw", True),
    ("xyzw", " ", "# timestamp tx ty tz qx qy qz qw", True),
    ("wxyz", " ", "# timestamp tx ty tz qw qx qy qz", True),
    ("wxyz", " ", "#t w x y z", True),
    ("xyzw", " ", "# estimates of a filter, version 2\n# timestamp tx ty tz qx qy qz qw", True),
    ("xyzw", " ", "# timestamp, tx, ty, tz, qx, qy, qz, qw", True),
    ("wxyz", ",", "t_ns,quaternion_w,quaternion_x,quaternion_y,quaternion_z", False),
    ("wxyz", ",", "t [s],rotation_w,rotation_x,rotation_y,rotation_z", True),
    ("xyzw", ",", "timestamp (ns),attitude_x,attitude_y,attitude_z,attitude_w", False),
    ("wxyz", ",", "seconds,qw,qx,qy,qz", True),
]


@pytest.mark.parametrize(("order", "separator", "header", "seconds"), HEADERS)
def test_where_a_header_names_the_columns_it_is_read(order, separator, header, seconds, tmp_path):
    path = tmp_path / "named.csv"
    middle = "000" if "tx" in header or "p_" in header or ",a,b,c," in header else ""
    rows = write_rows(SOME, separator, ORDERS[order], middle, seconds=seconds)
    path.write_text(f"{header}\n{rows}")
    found = read_attitudes(path).read()
    assert found.stamps.tolist() == SOME.stamps.tolist()
    assert (found.orientations == SOME.orientations).all()
    assert found.notes == ()


def test_what_is_no_attitude_is_left_out(tmp_path):
    path = tmp_path / "odd.csv"
    path.write_text("t,w,x,y,z\n0,0,0,0,0\n1,nan,0,0,0\n-1,1,0,0,0\n1e30,1,0,0,0\n2,3,0,0,0\n")
    found = read_attitudes(path).read()
    # a time before the run has an attitude as well
    assert found.stamps.tolist() == [-1_000_000_000, 2_000_000_000]
    assert found.orientations.tolist() == [[1.0, 0.0, 0.0, 0.0]] * 2
    assert found.left_out == 3


ODD = [
    ("0,1,0,0,0\n1,nan,0,0,0\n", r"1 .* line 3"),
    ("0,1,0,0,0\n2,1,0,0,0\n2,1,0,0,0\n", r"1 .* 2 s"),
    ("1700000000.12,1,0,0,0\n", "epoch seconds"),
]


@pytest.mark.parametrize(("rows", "note"), ODD)
def test_what_is_odd_is_named_in_a_line(tmp_path, rows, note):
    path = tmp_path / "odd.csv"
    path.write_text(f"t,w,x,y,z\n{rows}")
    (found,) = read_attitudes(path).read().notes
    assert re.search(note, found)


@pytest.mark.slow
def test_estimates_of_a_clock_that_stands_still_are_judged(tmp_path):
    path = tmp_path / "estimates.csv"
    path.write_text("stamp,w,x,y,z\n" + "0,1,0,0,0\n" * 12)
    assert main(["--scene", "cusps", "--estimates", str(path)]) == 0


@pytest.mark.parametrize("kind", sorted(FORMATS))
def test_every_type_with_an_attitude_is_read(kind):
    _, messages = encode(kind, SOME)
    found = decode_estimates(kind, [data for _, data in messages])
    assert (found.stamps == SOME.stamps).all()
    assert (found.orientations == SOME.orientations).all()
    if not {"angular_velocity", "angular"} & set(FORMATS[kind].quantities):
        assert found.angular_velocities is None
    else:
        assert (found.angular_velocities == SOME.angular_velocities).all()


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


def test_an_imu_without_orientation_is_left_out():
    _, messages = encode("sensor_msgs/msg/Imu", SOME)
    layout = FORMATS["sensor_msgs/msg/Imu"].layout("imu")
    unknown = layout.encode(5, [0.0, 0, 0, 1, -1.0, *[0.0] * 32])
    found = decode_estimates("sensor_msgs/msg/Imu", [messages[0][1], unknown, b"noise"])
    assert (len(found), found.left_out) == (1, 2)


TURNED = (0.5, -0.5, 0.5, 0.5)  # x, y, z, w


def encode_imu(stamp, rates, covariance):
    layout = IMU.layout("imu")
    values = {"orientation": TURNED, "angular_velocity": rates}
    row = IMU.arrange((), values)
    row[IMU.quantities["angular_velocity_covariance"].start] = covariance
    return layout.encode(stamp, row.tolist())


@pytest.mark.parametrize(("rates", "covariance"), [((9.0, 9.0, 9.0), -1.0), ((math.nan,) * 3, 0.0)])
def test_an_imu_without_rates_has_its_attitude(rates, covariance):
    """A filter fills in the attitude alone: its rates are zero, and are not those of the top."""
    found = decode_estimates(IMU.type, [encode_imu(k, rates, covariance) for k in range(3)])
    assert (len(found), found.left_out) == (3, 0)
    assert found.angular_velocities is None
    (note,) = found.notes
    assert note == "3 messages have no angular velocity: absent by covariance, frame or nan"


def test_of_imus_of_which_some_have_rates_those_are_taken():
    data = [encode_imu(k, (1.0, 2.0, 3.0), -1.0 if k == 1 else 0.1) for k in range(3)]
    found = decode_estimates(IMU.type, data)
    assert (found.stamps.tolist(), found.left_out) == ([0, 2], 1)
    assert found.angular_velocities.tolist() == [[1.0, 2.0, 3.0]] * 2
    (note,) = found.notes
    assert note.startswith("1 message has no angular velocity")


@pytest.mark.parametrize(("child", "rates"), [("", None), ("disc", [[1.0, 2.0, 3.0]])])
def test_the_rates_of_an_odometry_are_those_of_a_frame_that_it_names(child, rates):
    row = ODOMETRY.arrange((), {"orientation": TURNED, "angular": (1.0, 2.0, 3.0)})
    found = decode_estimates(
        ODOMETRY.type, [ODOMETRY.layout("odom", child).encode(5, row.tolist())]
    )
    assert len(found) == 1
    velocities = found.angular_velocities
    assert (None if velocities is None else velocities.tolist()) == rates


def test_a_transform_of_a_frame_without_a_name_is_none_as_for_tf2():
    numbers = [0.0, 0, 0, 0, 0, 0, 1]
    data = [TRANSFORM.layout("world", child).encode(9, numbers) for child in ("", "b")]
    assert decode_estimates(TRANSFORM.type, data).stamps.tolist() == [9]


def test_transforms_of_several_frames_need_a_name():
    numbers = [0.0, 0, 0, 0, 0, 0, 1]
    data = [TRANSFORM.layout("world", child).encode(9, numbers) for child in ("a", "b")]
    with pytest.raises(RefusedError, match="--frame must be one of a, b, got none"):
        decode_estimates(TRANSFORM.type, data)
    assert decode_estimates(TRANSFORM.type, data, "b").stamps.tolist() == [9]
    assert len(decode_estimates(TRANSFORM.type, data, "c")) == 0


@pytest.mark.parametrize(("count", "kept"), [(1000, 100), (199, 199), (200, 100), (250, 125)])
def test_of_many_estimates_some_of_each_part_of_the_run_are_kept_and_the_first(count, kept):
    estimates = Estimates.of(range(count), [(1.0, 0.0, 0.0, 0.0)] * count)
    stamps = estimates.thin(100).stamps
    assert len(stamps) == kept
    assert stamps[0] == 0  # drifts count from it
    width = count // 100
    assert (stamps // width).tolist() == list(range(kept))
