"""A covariance that begins with -1 says in sensor_msgs/Imu that a quantity was not measured."""

import pytest
from documents import ROOT

from symtop_ros.truth.fit.files import read_rows

ECHO = ROOT / "test/truth/tables/forms/echo_imu.csv"
ROWS = [line.split(",") for line in ECHO.read_text(encoding="utf-8").splitlines()]
# stamp and frame, then of each quantity its numbers and nine of its covariance
ORIENTATION, RATES = 3 + 4, 3 + 4 + 9 + 3
NAMES = ["t", "ns", "frame", *(f"orientation.{each}" for each in "xyzw")]
NAMES += [f"orientation_covariance[{k}]" for k in range(9)]
NAMES += [f"angular_velocity.{each}" for each in "xyz"]
NAMES += [f"angular_velocity_covariance[{k}]" for k in range(9)]


def write(path, rows, place, absent):
    """Write the rows with -1 at a place of those whose number is absent."""
    rows = [[*row] for row in rows]
    for number in absent:
        rows[number][place] = "-1.0"
    path.write_text("".join(f"{','.join(row)}\n" for row in rows), encoding="utf-8")
    return path


@pytest.mark.parametrize(("kind", "place"), [("rates", RATES), ("attitude", ORIENTATION)])
def test_rows_without_a_quantity_are_left_out_and_counted(tmp_path, kind, place):
    rows = read_rows(write(tmp_path / "a.csv", ROWS, place, (0, 3)), kind)
    assert len(rows.values) == len(ROWS) - 2
    assert "2 rows have no measurement, as a covariance begins with -1: left out" in rows.notes
    others = read_rows(ECHO, kind).values
    assert (rows.values == others[[k for k in range(len(ROWS)) if k not in (0, 3)]]).all()


@pytest.mark.parametrize(("kind", "place"), [("attitude", RATES), ("rates", ORIENTATION)])
def test_a_quantity_that_is_not_read_may_be_absent(tmp_path, kind, place):
    rows = read_rows(write(tmp_path / "a.csv", ROWS, place, range(len(ROWS))), kind)
    assert (rows.values == read_rows(ECHO, kind).values).all()


@pytest.mark.parametrize("cell", ["", "nan", "unknown"])
def test_a_covariance_that_is_no_number_says_nothing(tmp_path, cell):
    rows = [[*row[:RATES], cell, *row[RATES + 1 :]] for row in ROWS]
    path = write(tmp_path / "a.csv", rows, ORIENTATION, ())
    assert len(read_rows(path, "rates").values) == len(ROWS)


def test_a_row_that_ends_before_its_covariance_says_nothing(tmp_path):
    head = ["t", *NAMES[1 : RATES + 1]]
    rows = [[f"{row[0]}.{int(row[1]):09d}", *row[1:RATES]] for row in ROWS]
    path = write(tmp_path / "a.csv", rows, ORIENTATION, ())
    path.write_text(",".join(head) + "\n" + path.read_text(), encoding="utf-8")
    assert len(read_rows(path, "rates").values) == len(ROWS)


def test_names_of_a_covariance_say_the_same(tmp_path):
    path = write(tmp_path / "a.csv", ROWS, RATES, (1,))
    head = [*NAMES, *(f"_{k}" for k in range(len(ROWS[0]) - len(NAMES)))]
    seconds = [[f"{row[0]}.{int(row[1]):09d}", *row[1:]] for row in ROWS]
    path = write(tmp_path / "named.csv", seconds, RATES, (1,))
    path.write_text(",".join(head) + "\n" + path.read_text(), encoding="utf-8")
    assert len(read_rows(path, "rates").values) == len(ROWS) - 1
