"""Measured points: kept in run.json, read back as the exact motion that they were seen of."""

import json
import re

import numpy as np
import pytest
from run.simulation.page_points import (
    END,
    TIMES,
    list_hostile_points,
    make_measured,
    make_points,
    see,
)
from run.simulation.page_runs import START, find_refusal, make_run

from symtop_ros.run.simulation.points import MOST, SEEN, Points
from symtop_ros.run.simulation.run_file import FORMATS, RunEvent, read_run, write_run

# A dozen roundings of numbers near 1; a camera divides by its own line of sight, here above 0.3.
ROUNDING = 1e-13


@pytest.mark.parametrize("kind", SEEN)
def test_points_without_noise_show_the_axis_of_the_motion(kind):
    states = START.at(TIMES)
    points = make_points(kind, noise=0.0)
    axes, right = points.find_axes(states), states.to_world([0.0, 0.0, 1.0])
    if kind in ("rates", "inertial", "theta"):
        assert np.isnan(axes).all()
    else:
        assert np.abs(axes - right).max() < ROUNDING
    tilts = points.find_tilts(states)
    if kind in ("rates", "inertial"):
        assert np.isnan(tilts).all()
    else:
        assert np.abs(tilts - states.euler_angles.theta).max() < ROUNDING


@pytest.mark.parametrize("kind", SEEN)
def test_rates_that_were_seen_are_those_of_the_angles(kind):
    states = START.at(TIMES)
    found = make_points(kind, noise=0.0).find_rates(states)
    if kind not in ("rates", "inertial"):
        assert np.isnan(found).all()
        return
    phi_dot, psi_dot = found
    rates = START.euler_rates(states)
    # of sums of 200 rad/s, divided by sin(theta) > 0.4
    assert np.abs(phi_dot - rates.phi_dot).max() < 1e-12
    assert np.abs(psi_dot - rates.psi_dot).max() < 1e-12


def test_a_point_of_a_picture_is_the_axis_on_the_side_where_the_motion_is():
    """Also where the axis is behind the pivot, and none for a point beside the sphere."""
    states = START.at(TIMES)
    near = states.to_world([0.0, 0.0, 1.0])[:, 1] < 0
    assert 0 < near.sum() < len(TIMES)
    seen = make_points("pixels", noise=0.0)
    beside = seen.values.copy()
    beside[5] += 10_000.0
    axes = Points("pixels", 48, TIMES, beside, seen.residuals, seen.camera).find_axes(states)
    assert np.flatnonzero(np.isnan(axes).any(axis=1)).tolist() == [5]


@pytest.mark.parametrize("kind", SEEN)
def test_points_are_read_as_they_were_written(kind, tmp_path):
    path = tmp_path / "run.json"
    content = make_measured(kind, rows=1000)
    path.write_text(json.dumps(content))
    events, end, points = read_run(path)
    given = make_points(kind, rows=1000)
    assert (points.kind, points.rows, points.camera) == (kind, 1000, given.camera)
    assert np.array_equal(points.times, given.times)
    assert np.array_equal(points.values, given.values)
    # six digits are written
    assert np.abs(points.residuals / given.residuals - 1).max() < 6e-6
    assert json.loads(json.dumps(write_run(events, end, points))) == json.loads(json.dumps(content))
    assert end == END


def test_a_run_without_points_keeps_the_format_that_earlier_versions_read():
    assert write_run(make_run(), 0)["format"] == 2
    assert "points" not in write_run(make_run(), 0)
    assert make_measured()["format"] == FORMATS[-1] == 5


def test_a_run_reaches_its_last_point(tmp_path):
    path = tmp_path / "run.json"
    event = RunEvent("start", 0, START, {})
    path.write_text(json.dumps(write_run([event], 1000, make_points("theta"))))
    assert read_run(path)[1] == round(TIMES[-1] * 1e9)


@pytest.mark.parametrize(("name", "content"), list_hostile_points())
def test_damaged_points_are_refused_by_their_name_in_one_line(name, content):
    refusal = find_refusal(content)
    assert re.match(rf"{re.escape(name)} must .*, got .*", refusal)
    assert len(refusal.splitlines()) == 1
    assert len(refusal) < 400


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity"])
@pytest.mark.parametrize("name", ["times", "values", "residuals"])
def test_numbers_that_are_none_are_refused_by_their_place(name, number, tmp_path):
    content = make_measured()
    content["points"][name][1] = "BAD" if name == "times" else ["BAD", 0.0, 0.0]
    path = tmp_path / "run.json"
    path.write_text(json.dumps(content).replace('"BAD"', number))
    with pytest.raises(ValueError, match=rf"points: {name}\[1\] must be .*, got "):
        read_run(path)


@pytest.mark.slow
def test_a_million_points_are_refused_by_their_number(tmp_path):
    content = make_measured("theta")
    count = 10 * MOST
    content["points"] |= {
        "times": [*range(count)],
        "values": [[0]] * count,
        "residuals": [[0]] * count,
    }
    assert find_refusal(content) == f"points: times must be a list of 1 to {MOST}, got {count}"


def test_the_values_of_a_kind_are_those_that_a_record_has():
    for kind, seen in SEEN.items():
        assert see(kind).shape[1] == len(seen.columns)
        assert len(seen.residuals) == len(seen.units)
