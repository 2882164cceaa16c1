"""Tables of other tools as records: names, units, commas, and rows that are left out."""

import numpy as np
import pytest
from truth.fit.cases import TIMES, make_axis, write_table

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.files import read_rows
from symtop_ros.truth.fit.kinds import KINDS
from symtop_ros.truth.fit.record import MOST, Record, make_record

SOME = TIMES[:20]
TWO = np.stack([SOME + 1, SOME + 2], axis=1)
THREE = np.stack([SOME + 1, SOME + 2, SOME + 3], axis=1)
HEADS = {
    "t,theta,phi": ("angles", TWO),
    "time,tilt,azimuth": ("angles", TWO),
    "t,u,v": ("pixels", TWO),
    "t,x,y": ("pixels", TWO),
    "t,x,y,z": ("axis", THREE),
    "t,axis.x,axis.y,axis.z": ("axis", THREE),
    "t,wx,wy,wz": ("rates", THREE),
    '"Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)","Gyroscope z (rad/s)"': (
        "rates",
        THREE,
    ),
    "__time,/imu/angular_velocity/x,/imu/angular_velocity/y,/imu/angular_velocity/z": (
        "rates",
        THREE,
    ),
    "t,measured_wx,measured_wy,measured_wz": ("rates", THREE),
    # Tracker writes a sign before the names of several points, and a blank cell at the end
    "t,axis.x,axis.y,axis.z,": ("axis", THREE),
    "t,theta": ("theta", TWO[:, :1]),
}


@pytest.mark.parametrize("head", HEADS)
def test_the_kind_follows_from_the_names_of_columns(head, tmp_path):
    kind, values = HEADS[head]
    rows = read_rows(write_table(tmp_path / "a.csv", values, SOME, head), None)
    assert rows.kind == kind
    assert rows.values == pytest.approx(values, rel=1e-8)
    assert rows.times == pytest.approx(SOME, abs=1e-9)


@pytest.mark.parametrize("head", ["t,q0,q1,q2,q3", "t,Quat_q0,Quat_q1,Quat_q2,Quat_q3"])
def test_numbered_quaternions_have_w_first(head, tmp_path):
    q = np.column_stack([SOME + 9, THREE])
    rows = read_rows(write_table(tmp_path / "a.csv", q, SOME, head), None)
    assert rows.kind == "attitude"
    assert rows.values == pytest.approx(q, rel=1e-8)


def test_an_export_of_tracker_has_a_line_before_its_names_and_decimal_commas(tmp_path):
    path = write_table(tmp_path / "a.txt", TWO, SOME, "mass A\nt\tx\ty", ",", "\t")
    assert read_rows(path, None).values == pytest.approx(TWO, rel=1e-8)


def test_degrees_and_other_units_of_time_are_read(tmp_path):
    path = write_table(tmp_path / "a.csv", TWO, SOME * 1000, "t (ms);theta (deg);phi [°]", ",", ";")
    rows = read_rows(path, None)
    assert rows.values == pytest.approx(np.radians(TWO), rel=1e-8)
    assert rows.times == pytest.approx(SOME, abs=1e-9)


@pytest.mark.parametrize(("head", "unit"), [("t_ms", 1e-3), ("time_us", 1e-6), ("t [ms]", 1e-3)])
def test_the_name_of_the_time_may_say_its_unit(head, unit, tmp_path):
    rows = read_rows(write_table(tmp_path / "a.csv", TWO, SOME / unit, f"{head},u,v"), None)
    assert rows.times == pytest.approx(SOME, abs=1e-9)


def test_whole_stamps_are_ns_and_count_from_the_first(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("stamp,theta\n" + "".join(f"{10**18 + k * 10**7},{k}\n" for k in range(20)))
    assert read_rows(path, None).times == pytest.approx(np.arange(20) / 100, abs=1e-6)


def test_rows_with_an_empty_cell_are_left_out_and_counted(tmp_path):
    path = write_table(tmp_path / "a.csv", TWO, SOME, "t,u,v")
    lines = path.read_text().splitlines()
    lines[3] = lines[3].rpartition(",")[0] + ","
    path.write_text("\n".join(lines))
    rows = read_rows(path, None)
    assert len(rows.times) == 19
    assert rows.notes == ("1 row has an empty cell: left out",)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("t,u,v\n0,1,two\n", "line 2 of .* must consist of numbers, got 0,1,two"),
        ("t,u,v\n0,1,inf\n", "must have finite numbers, or empty cells, got inf in row 1"),
        ("t,u,v\n0,1,2,9\n", "line 2 of .* as many cells as there are names .3., got 0,1,2,9"),
        ("t (min),u,v\n0,1,2\n", "t in .* must be in s, ms, us, ns, got min"),
        ("t,theta (turns)\n0,1\n", "theta in .* must be in rad or degrees, got turns"),
        ("t,u,v\n0,1\n", "line 2 of .* must have all columns, got 0,1"),
        ("a,b\n1,2\n", "must have a column t .* got a,b"),
        ("", "got nothing"),
    ],
)
def test_what_cannot_be_read_is_named_with_its_line(text, reason, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(RefusedError, match=reason):
        read_rows(path, None)


def test_a_table_of_several_kinds_is_read_as_the_one_that_was_asked_for(tmp_path):
    head = "t,theta,phi,wx,wy,wz"
    path = write_table(tmp_path / "a.csv", np.column_stack([TWO, THREE]), SOME, head)
    assert read_rows(path, None).notes == ("read as angles; the table has rates as well (--kind)",)
    assert read_rows(path, "rates").kind == "rates"


PHONE = '"Time (s)";' + ";".join(
    f'"{name} {axis} ({unit})"'
    for name, unit in (("Gyroscope", "rad/s"), ("{0}", "m/s^2"))
    for axis in "xyz"
)


def test_accelerations_of_a_phone_without_gravity_are_no_accelerometer(tmp_path):
    values = np.concatenate([THREE, 9 + THREE], axis=1)
    path = write_table(tmp_path / "a.csv", values, SOME, PHONE.format("Acceleration"), ",", ";")
    assert read_rows(path, "inertial").values == pytest.approx(values, rel=1e-8)
    other = PHONE.format("Linear Acceleration")
    path = write_table(tmp_path / "b.csv", values, SOME, other, ",", ";")
    with pytest.raises(
        RefusedError, match=r"must have a column t .* and the columns wx, wy, wz, fx, fy, fz"
    ):
        read_rows(path, "inertial")


def test_units_of_a_sensor_are_turned_into_rad_and_m(tmp_path):
    head = "t,wx (deg/s),wy (deg/s),wz (deg/s),fx (g),fy (g),fz (g)"
    values = np.concatenate([THREE, THREE], axis=1)
    path = write_table(tmp_path / "a.csv", values, SOME, head)
    factors = np.repeat([np.pi / 180, 9.81], 3)
    assert read_rows(path, "inertial").values == pytest.approx(values * factors, rel=1e-8)


def test_ten_million_rows_are_thinned_to_runs_of_neighbours():
    times = np.arange(10_000_000) / 1000
    whole = Record(times, times[:, None], KINDS["theta"])
    thin = whole.thin()
    assert len(thin) == MOST
    assert thin.times[[0, -1]].tolist() == times[[0, -1]].tolist()
    assert thin.follows.mean() > 0.99


def test_points_at_one_distance_are_divided_by_it_and_others_each_by_their_own():
    near = make_axis()
    record = make_record(TIMES, 7 * near, "axis")
    assert record.values == pytest.approx(near / np.median(np.linalg.norm(near, axis=1)))
    record = make_record(TIMES, near * (1 + np.arange(len(near)))[:, None], "axis")
    assert np.linalg.norm(record.values, axis=1) == pytest.approx(1.0, abs=1e-15)
