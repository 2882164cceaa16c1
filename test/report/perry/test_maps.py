"""Perry's maps: what is in them, and in their files."""

import numpy as np
import pyarrow.parquet as pq
import pytest
from PIL import Image

from symtop_ros.physics import State, hurry, motion, regular_precession_rates
from symtop_ros.report import main as report
from symtop_ros.report.perry.maps import FACTOR, PSI_DOT, THETA, TOP, over_spin, over_tilt

SIDES = ("highest", "lowest")
FILES = {"perry.rrd"} | {
    f"perry_{name}.{suffix}" for name in ("spin", "tilt") for suffix in ("png", "svg", "parquet")
}


def test_the_points_of_a_table_are_those_of_the_closed_form(tmp_path):
    assert report.main(["--map", str(tmp_path), "--points", "9"]) == 0
    rows = pq.read_table(tmp_path / "perry_spin.parquet").to_pylist()
    assert len(rows) == 81
    for row in rows[::7]:
        start = State.from_euler(theta=THETA, phi_dot=row["phi_dot"], psi_dot=row["psi_dot"])
        before, after = motion(TOP, start), motion(TOP, hurry(TOP, start, FACTOR))
        found = [row[f"{which}_{when}"] for when in ("before", "after") for which in SIDES]
        # an angle near a pole is the square root of what is good to rounding
        assert found == pytest.approx([*before.turning_angles, *after.turning_angles], abs=1e-7)


@pytest.mark.parametrize("make", [over_spin, over_tilt])
def test_the_curves_of_regular_precession_are_where_their_rates_are(make):
    found = make(201)
    for k in range(0, 201, 10):
        theta, psi_dot = (
            (THETA, found.across[k]) if make is over_spin else (found.across[k], PSI_DOT)
        )
        rates = regular_precession_rates(TOP, theta=theta, psi_dot=psi_dot)
        inside = [each for each in rates if found.phi_dot[0] < each < found.phi_dot[-1]]
        changes = np.diff(np.sign(found.torque[:, k])) != 0
        assert changes.sum() == len(inside)
        for rate in inside:
            row = np.searchsorted(found.phi_dot, rate) - 1
            assert changes[row]


def test_all_files_are_written_and_pictures_are_not_blank(tmp_path, capsys):
    assert report.main(["--map", str(tmp_path), "--points", "60"]) == 0
    assert {path.name for path in tmp_path.iterdir()} == FILES
    for name in ("spin", "tilt"):
        with Image.open(tmp_path / f"perry_{name}.png") as picture:
            assert len(picture.convert("RGB").getcolors(1 << 24)) > 500
    told = capsys.readouterr().out
    assert "the rule holds on" in told
    assert f"rerun {tmp_path / 'perry.rrd'}" in told


def test_a_folder_that_cannot_be_made_is_told_in_a_line(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert report.main(["--map", str(tmp_path / "file"), "--points", "4"]) == 1
    told = capsys.readouterr().err
    assert told.startswith("top_report: ")
    assert told.count("\n") == 1
