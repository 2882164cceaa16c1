"""A sensor at its limit: rows that are left out, and records that are refused."""

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


def test_a_spin_beyond_the_range_is_refused(tmp_path, capsys):
    path = write_table(tmp_path / "fast.csv", np.minimum(see_rates(), RANGE), head="t,wx,wy,wz")
    assert main([str(path)]) == 1
    said = "a record must be within the range of its sensor, got wz at 34.907 rad/s (2000 deg/s)"
    assert capsys.readouterr().err == f"top_fit: {said} in 100% of the rows\n"


def test_an_accelerometer_has_limits_of_its_own():
    forces = 9.80665 * np.stack([np.full(len(TIMES), 2.0), *see_rates()[:, :2].T], axis=1)
    values = np.concatenate([see_rates(), forces], axis=1)
    with pytest.raises(RefusedError, match=r"got fx at 19.613 m/s\^2 in 100% of the rows"):
        leave_out_saturated(make_rows(values, "inertial"))


def test_points_have_no_limit():
    rows = make_rows(np.ones((len(TIMES), 3)), "axis")
    assert leave_out_saturated(rows) is rows
