"""The forms of tables, each held by a file: the same rows as other programs write them.

`forms/plain.csv` has all numbers; the others have some of them, with their decimals.
"""

import re
from pathlib import Path

import numpy as np
import pytest
from documents import ROOT

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.files import read_rows
from symtop_ros.truth.judge.attitude_table import read_attitudes
from symtop_ros.truth.tables.forms import is_table

FOLDER = Path(__file__).with_name("forms")
QUATERNION, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
AXIS, FORCES, POINT = ("axis.x", "axis.y", "axis.z"), ("fx", "fy", "fz"), ("u", "v")
EPOCH = 1_700_000_000_123_456_789  # ns, of files that have a stamp
# File -> kind for the fit, columns, and the step of their last decimal: of rates in degrees that
# of 0.01 deg/s, and of numbers with an exponent that of all digits.
HUNDREDTH = 0.01 * np.pi / 180
FILES = {
    "excel_german.csv": ("rates", RATES, HUNDREDTH),
    "excel_unicode.txt": ("axis", AXIS, 1e-6),
    "excel_utf8.csv": ("pixels", POINT, 0.01),
    "units_below.csv": ("rates", RATES, HUNDREDTH),
    "degrees.csv": ("rates", RATES, HUNDREDTH),
    "echo_imu.csv": ("inertial", (*RATES, *FORCES), 1e-4),
    "echo_quaternion.csv": ("attitude", QUATERNION, 1e-6),
    "echo_pose.csv": ("attitude", QUATERNION, 1e-6),
    "echo_vector.csv": ("axis", AXIS, 1e-6),
    "stamp_parts.csv": ("rates", RATES, 1e-4),
    "rostopic.csv": ("rates", RATES, 1e-4),
    "plotjuggler.csv": ("attitude", QUATERNION, 1e-6),
    "r_write_table.txt": ("axis", AXIS, 1e-6),
    "r_write_csv.csv": ("rates", RATES, 1e-4),
    "pandas.csv": ("rates", RATES, 1e-4),
    "numpy_savetxt.txt": ("axis", AXIS, 1e-17),
    "tracker.txt": ("pixels", POINT, 1e-4),
    "phyphox.csv": ("rates", RATES, 1e-10),
    "xsens.txt": ("attitude", QUATERNION, 1e-6),
    "poses.tum": ("attitude", QUATERNION, 1e-6),
    "euroc_truth.csv": ("attitude", QUATERNION, 1e-6),
    "euroc_without_names.csv": ("attitude", QUATERNION, 1e-6),
    "euroc_imu.csv": ("inertial", (*RATES, *FORCES), 1e-4),
    "kitti_timed.txt": ("attitude", QUATERNION, None),
    "motive.csv": ("attitude", QUATERNION, 1e-6),
    "iso_times.csv": ("rates", RATES, 1e-4),
}
STAMPED = re.compile(r"echo|stamp|rostopic|plotjuggler|tum|euroc|iso")
ATTITUDES = [name for name, (_, columns, _) in FILES.items() if columns == QUATERNION]
ATTITUDES += ["echo_imu.csv", "rostopic.csv"]


def read_plain():
    """Return the columns of the plain table by their names."""
    table = np.genfromtxt(FOLDER / "plain.csv", delimiter=",", names=True, deletechars="")
    return {name: table[name] for name in table.dtype.names}


PLAIN = read_plain()


@pytest.mark.parametrize("name", FILES)
def test_a_table_has_the_rows_that_were_written(name):
    kind, columns, step = FILES[name]
    rows = read_rows(FOLDER / name, kind)
    expected = np.stack([PLAIN[each] for each in columns], axis=1)
    if kind == "attitude":
        expected *= np.sign((expected * rows.values).sum(axis=1))[:, np.newaxis]
    # a number is off by half of the last decimal, of matrices by a few halves
    assert rows.values == pytest.approx(expected, abs=0.51 * (step or 1e-5))
    assert rows.times == pytest.approx(PLAIN["t"], abs=1e-12)
    if step:
        assert rows.steps.max() == pytest.approx(step, rel=1e-9)


@pytest.mark.parametrize("name", ATTITUDES)
def test_judge_and_fit_read_one_table_alike_with_stamps_to_the_ns(name):
    found = read_attitudes(FOLDER / name).read()
    rows = read_rows(FOLDER / name, "attitude")
    assert np.abs((found.orientations * rows.values).sum(axis=1)) == pytest.approx(1, abs=1e-5)
    begin = EPOCH if STAMPED.search(name) else 0
    assert found.stamps.tolist() == [begin + 8_000_000 * k for k in range(len(rows.times))]


def test_the_table_of_the_docs_names_each_file():
    text = (ROOT / "docs/judge.md").read_text()
    named = set(re.findall(r"\(\.\./test/truth/tables/forms/([\w.]+)\)", text))
    assert named == {*FILES, "plain.csv"} == {path.name for path in FOLDER.iterdir()}


@pytest.mark.parametrize(
    ("name", "notes"),
    [
        ("r_write_table.txt", ["the first cell of each row has no name: read as the name"]),
        ("pandas.csv", ["1 row has an empty cell: left out"]),
        ("echo_imu.csv", ["no names of columns: read as ros2 topic echo --csv writes Imu"]),
        ("motive.csv", ["1 row has an empty cell: left out"]),
        ("xsens.txt", ["read as attitude; the table has rates as well"]),
        ("tracker.txt", []),
    ],
)
def test_what_was_assumed_or_left_out_is_said(name, notes):
    found = read_rows(FOLDER / name, None if name == "xsens.txt" else FILES[name][0]).notes
    assert len(found) == len(notes)
    assert all(each.startswith(note) for each, note in zip(found, notes, strict=True))


BINARY = {
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": "a workbook of Excel",
    b"PK\x03\x04....[Content_Types].xml": "a workbook of Excel",
    b"PK\x03\x04....data.csv": "a packed file: unzip -p",
    b"\x93NUMPY\x01\x00": "an array of NumPy",
    b"\x89HDF\r\n\x1a\n": "HDF5",
    b"MATLAB 5.0 MAT-file": "a file of MATLAB",
    b"PAR1": "Parquet",
    b"#ROSBAG V2.0\n": "a bag of ROS 1",
    b"\x00\x00\x00\x20ftypisom": "a film",
    b"\x1aE\xdf\xa3": "a film",
}


@pytest.mark.parametrize("start", BINARY)
def test_a_binary_file_is_refused_with_what_it_is(start, tmp_path):
    path = tmp_path / "record.csv"
    path.write_bytes(start)
    with pytest.raises(RefusedError, match=f"must be a log or a table, got .*{BINARY[start]}"):
        is_table(path)
    with pytest.raises(RefusedError, match=BINARY[start]):
        read_rows(path, None)


def test_a_step_is_that_of_most_decimals_also_of_a_column_that_does_not_change(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(
        "t,wx,wy,wz\n" + "".join(f"{k},1.{k:02d},2.{k:02d},200.000\n" for k in range(9))
    )
    assert read_rows(path, None).steps == pytest.approx([0.01, 0.01, 0.001])


def test_a_program_that_drops_zeros_hides_the_step_of_a_column_that_does_not_change(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,wx,wy,wz\n" + "".join(f"{k},{k / 8},{k / 4},200\n" for k in range(9)))
    assert read_rows(path, None).steps == pytest.approx([0.001, 0.01, 0.01])


def test_times_since_1970_are_as_exact_as_their_text(tmp_path):
    path = tmp_path / "a.csv"
    rows = [f"1700000000.{k:010d},{k}\n" for k in range(0, 10**6, 10**5)]
    path.write_text("t,theta\n" + "".join(rows))
    assert read_rows(path, None).times == pytest.approx(np.arange(10) * 1e-5, abs=1e-16)


def test_a_time_with_a_huge_exponent_is_a_late_one_and_takes_no_memory(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t,w,x,y,z\n0,1,0,0,0\n1e999999999,1,0,0,0\n1,1,0,0,0\n")
    assert read_attitudes(path).read().stamps.tolist() == [0, 10**9]
    path.write_text("t,w,x,y,z\n0,1,0,0,0\n1e99999999999999999999,1,0,0,0\n")
    with pytest.raises(RefusedError, match=r"line 3 of .* must consist of numbers"):
        read_attitudes(path)
