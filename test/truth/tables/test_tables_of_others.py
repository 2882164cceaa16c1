"""Tables of other tools: Motive, Xsens, KITTI with times, Euler angles, and times of ISO 8601."""

import numpy as np
import pytest

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import State
from symtop_ros.truth.fit.files import read_rows
from symtop_ros.truth.judge.attitude_table import read_attitudes
from symtop_ros.truth.tables.iso import write_seconds

# Turns of 0.1 and more about all axes, as quaternions of exact quarters.
Q = np.array([[0.5, 0.5, 0.5, 0.5], [0.5, -0.5, 0.5, 0.5], [1.0, 0.0, 0.0, 0.0]])
TIMES = [0.0, 0.125, 0.25]
MOTIVE = """Format Version,1.23,Take Name,Top,Capture Frame Rate,120.000000,Rotation Type,{0}
{1}
,Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body
,Name,"Top 1","Top 1","Top 1","Top 1","Top 1","Top 1","Top 1","Top 1"
,ID,1,1,1,1,1,1,1,1
{2},,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker Error
Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,
"""


def write_motive(path, kind="Quaternion", parent=""):
    lines = [
        f"{k},{t},{x},{y},{z},{w},0.1,0.2,0.3,0.001"
        for k, (t, (w, x, y, z)) in enumerate(zip(TIMES, Q, strict=True))
    ]
    lines.insert(2, "7,0.2,,,,,,,,")  # not seen
    path.write_text(MOTIVE.format(kind, "", parent) + "\n".join(lines) + "\n")
    return path


def assert_same_turns(found, expected):
    assert np.abs((found * expected).sum(axis=1)) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("parent", ["", ",Parent,,,,,,,,\n"])
def test_an_export_of_motive_is_read_without_rows_in_which_nothing_was_seen(tmp_path, parent):
    table = read_attitudes(write_motive(tmp_path / "take.csv", parent=parent))
    assert_same_turns(table.numbers, Q)
    assert table.times == (0, 125_000_000, 250_000_000)
    assert table.notes == ("1 row has an empty cell: left out",)


def test_both_tools_read_one_export_of_motive(tmp_path):
    rows = read_rows(write_motive(tmp_path / "take.csv"), "attitude")
    assert_same_turns(rows.values, Q)
    assert rows.times.tolist() == TIMES


def test_an_export_of_motive_with_angles_is_refused(tmp_path):
    with pytest.raises(RefusedError, match="must have the rotation type Quaternion, got XYZ"):
        read_attitudes(write_motive(tmp_path / "take.csv", "XYZ"))


def test_bodies_of_motive_are_told_apart_by_name(tmp_path):
    path = tmp_path / "take.csv"
    head = ",,A,A,A,A,B,B,B,B\n"
    axes = "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,W\n"
    path.write_text(
        f"Format Version,1.2\n{head.replace('A', 'Type')}{head}{',,' + 'Rotation,' * 8}\n{axes}"
    )
    with pytest.raises(RefusedError, match=r"one quaternion, got a.rotation.w and b.rotation.w"):
        read_attitudes(path)


ANGLES = np.array([[0.25, -0.5, 1.0], [-0.75, 0.125, -2.0]])


@pytest.mark.parametrize(
    ("head", "factor", "note"),
    [
        ("t,roll,pitch,yaw", 1.0, ("roll, pitch and yaw have no unit: read as rad",)),
        ("t,Roll (deg),Pitch (deg),Yaw (deg)", 180 / np.pi, ()),
        ("t,att.roll_deg,att.pitch_deg,att.yaw_deg", 180 / np.pi, ()),
        ("t,Roll,Pitch,Yaw", 180 / np.pi, ("roll, pitch and yaw have no unit: read as degrees",)),
    ],
)
def test_roll_pitch_and_yaw_are_turns_in_the_order_of_the_flag(tmp_path, head, factor, note):
    path = tmp_path / "a.csv"
    lines = [",".join(map(repr, [k, *row])) for k, row in enumerate((ANGLES * factor).tolist())]
    path.write_text("\n".join([head, *lines]) + "\n")
    yaw_first, roll_first = (read_attitudes(path, order) for order in ("zyx", "xyz"))
    assert yaw_first.notes == note
    for row, (roll, pitch, yaw) in enumerate(ANGLES):
        x, y, z = (
            State((np.cos(a / 2), *np.sin(a / 2) * axis), (0, 0, 0))
            for a, axis in zip((roll, pitch, yaw), np.eye(3), strict=True)
        )
        vector = np.array([0.25, 0.5, 1.0])
        for table, turns in ((yaw_first, (z, y, x)), (roll_first, (x, y, z))):
            turned = State(table.numbers[row], (0, 0, 0)).to_world(vector)
            expected = turns[0].to_world(turns[1].to_world(turns[2].to_world(vector)))
            assert turned == pytest.approx(expected, abs=1e-12)


def test_roll_pitch_and_yaw_need_the_flag(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,roll,pitch,yaw\n0,0,0,0\n")
    with pytest.raises(RefusedError, match="--rpy must be the order of roll, pitch and yaw"):
        read_attitudes(path)


def test_poses_of_kitti_with_a_time_in_front_are_matrices(tmp_path):
    path = tmp_path / "poses.txt"
    quarter = "0 -1 0 5 1 0 0 6 0 0 1 7"  # about z
    path.write_text(f"0.0 1 0 0 5 0 1 0 6 0 0 1 7\n0.5 {quarter}\n1.0 {'0 ' * 12}\n")
    table = read_attitudes(path)
    half = 0.5**0.5
    assert_same_turns(table.numbers[:2], np.array([[1, 0, 0, 0], [half, 0, 0, half]]))
    assert not table.numbers[2].any()  # no rotation, which is left out as no attitude
    assert len(table.read()) == 2
    assert "KITTI" in table.notes[0]


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("2026-11-28T14:01:26.123456789Z", "1795874486.123456789"),
        ("2026-11-28 15:01:26.5+01:00", "1795874486.5"),
        ("2026-11-28T14:01:26", "1795874486.0"),
        ("17.25", "17.25"),
        ("2026-11-28", "2026-11-28"),
    ],
)
def test_times_of_iso_8601_keep_their_digits(text, seconds):
    assert write_seconds(text) == seconds


def test_a_table_may_have_times_of_iso_8601(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        "timestamp,Quat_q0,Quat_q1,Quat_q2,Quat_q3\n"
        "2026-11-28T14:01:26.123456789Z,1,0,0,0\n2026-11-28T14:01:26.133456789Z,1,0,0,0\n"
        "2026-13-28T14:01:26Z,1,0,0,0\n"
    )
    with pytest.raises(RefusedError, match=r"line 4 of .* must consist of numbers"):
        read_attitudes(path)
    path.write_text("\n".join(path.read_text().splitlines()[:3]) + "\n")
    assert read_attitudes(path).times == (1795874486_123456789, 1795874486_133456789)
