"""A sensor at its limit: rows that are left out, and records that are refused."""

import re

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, TIMES, write_table

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.files import Rows
from symtop_ros.truth.fit.limits import leave_out_saturated
from symtop_ros.truth.fit.main import main

RANGE = float(np.radians(2000.0))


def make_rows(values, kind="rates"):
    return Rows(kind, TIMES, values, ())


def see_rates():
    rates = np.asarray(CUSPS.at(TIMES).angular_velocity)
    return rates + 0.05 * Numbers(5).normals(*rates.shape)


def test_rows_at_the_limit_are_left_out_with_their_range_and_share():
    values = see_rates()
    limit = float(np.percentile(values[:, 0], 90))
    values[:, 0] = np.minimum(values[:, 0], limit)
    found = leave_out_saturated(make_rows(values))
    cut = int((values[:, 0] == limit).sum())
    assert len(found.times) == len(TIMES) - cut
    (note,) = found.notes
    assert note.startswith(
        f"{cut} rows are at the limit of the sensor: left out (wx at {limit:.5g}"
    )
    assert note.endswith("in 10% of the rows)")


def read_number(text, name):
    """Return a number and its deviation from the line of a report that begins with its name."""
    (line,) = [each.strip() for each in text.splitlines() if each.strip().startswith(name)]
    value, deviation = line[len(name) :].split("+-")[:2]
    return float(value), float(deviation.split()[0])


def write_clipped(tmp_path):
    return write_table(tmp_path / "fast.csv", np.minimum(see_rates(), RANGE), head="t,wx,wy,wz")


def test_a_spin_beyond_the_range_is_left_out_and_what_the_others_show_is_printed(tmp_path, capsys):
    assert main([str(write_clipped(tmp_path))]) == 0
    text = capsys.readouterr().out
    assert "note: wz at 34.907 rad/s (2000 deg/s), the limit of the sensor" in text
    period, deviation = read_number(text, "nutation period")
    assert abs(period - CUSPS.nutation_period) < 5 * deviation
    # no number of the top stands among those that are known
    assert not [each for each in ("  Mgl/Ix", "  spin", "  theta") if f"\n{each}" in text]
    value, deviation = re.search(r"only \(2 - Iz/Ix\) spin = (\S+) \+- (\S+) rad/s", text).groups()
    top, spin = CUSPS.top, float(CUSPS.start.angular_velocity[2])
    assert abs(float(value) - (2 - top.Iz / top.Ix) * spin) < 5 * float(deviation)


def test_a_known_ratio_of_moments_gives_the_other_numbers_without_the_spin(tmp_path, capsys):
    top, spin = CUSPS.top, float(CUSPS.start.angular_velocity[2])
    ratio = f"{top.Iz / top.Ix:.12f}"
    assert main([str(write_clipped(tmp_path)), "--Iz-Ix", ratio, "1e-5"]) == 0
    text = capsys.readouterr().out
    for name, true in (("spin (omega_z)", spin), ("Mgl/Ix", top.Mgl / top.Ix)):
        value, deviation = read_number(text, name)
        assert abs(value - true) < 5 * deviation
        assert deviation < 0.01 * abs(true)


def test_a_mount_needs_the_spin(tmp_path, capsys):
    assert main([str(write_clipped(tmp_path)), "--mount", "0.1"]) == 1
    refusal = "top_fit: --mount must have rates about the axis, got none within the range\n"
    assert capsys.readouterr().err == refusal


def test_what_lacks_a_spin_is_no_run(tmp_path, capsys):
    path = write_clipped(tmp_path)
    assert main([str(path), "--run", str(tmp_path / "run.json")]) == 1
    assert (
        "--run must have rates about the axis, got none within the range" in capsys.readouterr().err
    )
    assert not (tmp_path / "run.json").exists()


def test_a_spin_next_to_the_range_is_left_out_with_its_neighbours():
    """Rows below the range by chance alone would show a spin that is too slow."""
    values = see_rates()
    limit = float(np.percentile(values[:, 2], 70))
    values[:, 2] = np.minimum(values[:, 2], limit)
    found = leave_out_saturated(make_rows(values))
    assert (found.kind, found.values.shape) == ("across", (len(TIMES), 2))
    slow = see_rates()
    slow[60:, 2] -= 1.0  # in the first rows alone it is beyond
    slow[:, 2] = np.minimum(slow[:, 2], limit)
    found = leave_out_saturated(make_rows(slow))
    assert found.kind == "rates"
    assert len(TIMES) - 60 - 8 <= len(found.times) <= len(TIMES) - 60
    assert "or next to it" in found.notes[0]


def test_an_accelerometer_has_limits_of_its_own():
    forces = 9.80665 * np.stack([np.full(len(TIMES), 2.0), *see_rates()[:, :2].T], axis=1)
    values = np.concatenate([see_rates(), forces], axis=1)
    with pytest.raises(RefusedError, match=r"got fx at 19.613 m/s\^2 in 100% of the rows"):
        leave_out_saturated(make_rows(values, "inertial"))


def test_points_have_no_limit():
    rows = make_rows(np.ones((len(TIMES), 3)), "axis")
    assert leave_out_saturated(rows) is rows
