"""`top_fit --run`: the motion that was found and the points, as a run of the page."""

import json
import re

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, SIGMA, TIMES, make_axis, make_noisy, write_table

from symtop_ros.run.simulation.run_file import read_run
from symtop_ros.truth.fit import make_record
from symtop_ros.truth.fit.main import main
from symtop_ros.truth.fit.model import Model, find_axis, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.runs import make_run
from symtop_ros.truth.fit.starts import fill

DIGITS = 6e-6  # of a residual: six are written
# Of attitudes whose phase is 2e2 rad/s times 2 s: eps of this phase, through a dozen operations.
ROUNDING = 1e-11
SENSOR = {"bias_x": 0.125, "bias_y": -0.25, "bias_z": 0.25, "tilt_x": 0.0625, "tilt_y": -0.03125}


def fit_at_truth(record, **more):
    """Return the fit whose search begins at the truth."""
    model = Model(record, np.asarray(CUSPS.start.orientation))
    return refine(model, fill(model, {**name_parameters(CUSPS), **more}))


@pytest.fixture(name="table")
def _table(tmp_path):
    return write_table(tmp_path / "axis.csv", make_axis())


@pytest.mark.slow
def test_the_run_has_each_row_and_what_an_exact_motion_leaves_of_it(table, tmp_path, capsys):
    path = tmp_path / "run.json"
    assert main([str(table), "--run", str(path)]) == 0
    said = capsys.readouterr().out.splitlines()[-1]
    (event,), end, points = read_run(path)
    assert (points.kind, points.rows, len(points)) == ("axis", 240, 240)
    given = np.array([line.split(",") for line in table.read_text().splitlines()[1:]], dtype=float)
    assert np.array_equal(points.times, given[:, 0])
    # one length for all rows: the median of theirs
    assert np.ptp(points.values / given[:, 1:]) < ROUNDING
    axes = find_axis(event.motion.at(points.times).orientation)
    left = points.values - axes
    assert np.abs(points.residuals - left).max() <= DIGITS * np.abs(left).max() + ROUNDING
    assert 0.9 * SIGMA < left.std() < 1.1 * SIGMA  # of 720 numbers, uncertain by 3 %
    assert end == round(given[-1, 0] * 1e9)
    top = event.motion.top
    assert said.startswith(f"wrote {path}: 240 measured points; ")
    numbers = {name: float(text) for name, text in re.findall(r"(\S+) = ([\d.e-]+)", said)}
    assert numbers == {"Ix": top.Ix, "Iz/Ix": pytest.approx(top.Iz / top.Ix, abs=5e-5)}


@pytest.mark.slow
def test_what_is_known_is_in_the_run_and_json_stays_json(table, tmp_path, capsys):
    path = tmp_path / "run.json"
    known = ["--Iz-Ix", "0.5", "0.01", "--Ix", "0.001", "1e-6"]
    assert main([str(table), "--run", str(path), *known, "--json"]) == 0
    out, err = capsys.readouterr()
    values = json.loads(out)["values"]
    assert err == f"wrote {path}: 240 measured points\n"
    (event,), *_ = read_run(path)
    top = event.motion.top
    assert (top.Ix, top.Iz) == pytest.approx((0.001, 0.0005), rel=1e-12)
    assert top.Mgl / top.Ix == pytest.approx(values["Mgl/Ix"]["value"], rel=1e-12)
    spin = event.motion.start.angular_velocity[2]
    assert spin == pytest.approx(values["spin"]["value"], rel=1e-12)
    assert top.Iz * spin / top.Ix == pytest.approx(values["p_psi/Ix"]["value"], rel=1e-12)


def test_a_known_weight_gives_the_moments():
    fit = fit_at_truth(make_noisy("axis", find_axis(CUSPS.at(TIMES).orientation), SIGMA))
    run = make_run(fit, 240, {"Mgl": (0.068, 0.0)})
    assert run.motion.top.Mgl == pytest.approx(0.068, rel=1e-12)
    assert set(run.assumed) == {"Iz/Ix"}


def show(kind):
    states = CUSPS.at(TIMES)
    phi, theta, _ = states.euler_angles
    return {
        "attitude": states.orientation,
        "rates": states.angular_velocity,
        "angles": np.stack([theta, phi], axis=1),
        "theta": theta[:, None],
    }[kind]


@pytest.mark.parametrize("kind", ["attitude", "rates", "angles", "theta"])
def test_residuals_of_each_kind_are_what_was_seen_less_the_motion_of_the_run(kind):
    fit = fit_at_truth(make_noisy(kind, show(kind), SIGMA))
    run = make_run(fit, 240, {})
    states, points = run.motion.at(run.points.times), run.points
    phi, theta, _ = states.euler_angles
    if kind == "attitude":
        w, x, y, z = points.values.T
        a, b, c, d = states.orientation.T
        # the vector part of the conjugate of the motion's times what was seen; twice it is the turn
        vector = np.stack(
            [
                a * x - b * w - c * z + d * y,
                a * y + b * z - c * w - d * x,
                a * z - b * y + c * x - d * w,
            ],
            axis=1,
        )
        scalar = a * w + b * x + c * y + d * z
        left = 2 * np.sign(scalar)[:, None] * vector
        # a turn of 5 SIGMA is its sine to its cube over 24; and it is the same in both frames
        assert np.abs(points.residuals - left).max() < (8 * SIGMA) ** 3 / 24
        return
    shown = {
        "rates": states.angular_velocity,
        "angles": np.stack([theta, phi], axis=1),
        "theta": theta[:, None],
    }[kind]
    left = points.values - shown
    if kind == "angles":
        left[:, 1] -= 2 * np.pi * np.round(left[:, 1] / (2 * np.pi))
    assert np.abs(points.residuals - left).max() < 1e3 * ROUNDING  # rates are of 2e2 rad/s


def test_points_of_a_sensor_are_those_of_one_without_bias_and_tilt():
    tilt = np.array([SENSOR["tilt_x"], SENSOR["tilt_y"], 0.0])
    angle = float(np.hypot(*tilt[:2]))
    n = tilt / angle
    omega = CUSPS.at(TIMES).angular_velocity
    # Rodrigues' formula
    turned = (
        np.cos(angle) * omega
        + np.sin(angle) * np.cross(n, omega)
        + (1 - np.cos(angle)) * (omega @ n)[:, None] * n
    )
    bias = [SENSOR[name] for name in ("bias_x", "bias_y", "bias_z")]
    errors = SIGMA * Numbers(3).normals(len(TIMES), 3)
    known = {"bias_z": (0.25, 2.0**-10)}
    record = make_record(TIMES, turned + bias + errors, "rates", has_mount=True, known=known)
    run = make_run(fit_at_truth(record, **SENSOR), 240, {})
    states = run.motion.at(TIMES)
    left = run.points.values - states.angular_velocity
    assert np.abs(run.points.residuals - left).max() < 1e3 * ROUNDING
    # the noise, and not the bias of a quarter
    assert np.abs(left).max() < 6 * SIGMA


def test_points_at_a_distance_are_those_of_an_axis_of_one():
    seen = 23.0 * make_axis()
    fit = fit_at_truth(make_record(TIMES, seen, "axis"))
    assert fit.model.record.has_length
    points = make_run(fit, len(TIMES), {}).points
    axes = points.values - points.residuals
    # of unit vectors in double precision
    assert np.linalg.norm(axes, axis=1) == pytest.approx(np.ones(len(TIMES)), rel=1e-14)


def test_pixels_keep_their_camera():
    given = {"u": 600.0, "v": 400.0, "log_scale": 5.5, "elevation": 0.5, "roll": 0.0}
    x, y, z = find_axis(CUSPS.at(TIMES).orientation).T
    seen = np.stack([x, y * np.sin(0.5) + z * np.cos(0.5)], axis=1) * np.exp(5.5) + [600.0, 400.0]
    fit = fit_at_truth(make_noisy("pixels", seen, 0.5), **given)
    points = make_run(fit, 240, {}).points
    assert points.camera["elevation"] == pytest.approx(0.5, abs=0.02)
    assert points.camera["nearness"] == 0.0
    right, y_found, z_found = points.find_axes(CUSPS.at(TIMES)).T
    up, out = np.sin(points.camera["elevation"]), np.cos(points.camera["elevation"])
    high, size = y_found * up + z_found * out, np.exp(points.camera["log_scale"])
    cos, sin = np.cos(points.camera["roll"]), np.sin(points.camera["roll"])
    again = np.stack([cos * right - sin * high, sin * right + cos * high], axis=1) * size
    again += [points.camera["u"], points.camera["v"]]
    found = np.isfinite(right)  # noise may put a point at the edge beside the sphere
    assert found.mean() > 0.9
    assert np.abs(again - points.values)[found].max() < 1e-9  # roundings of 1e3 pixels
    # where the line of sight is not along the sphere: 2 pixels of 245, twice for the slope
    clear = found & (z * up - y * out > 0.5)
    assert clear.sum() > 50
    assert np.abs(np.stack([right - x, y_found - y, z_found - z]))[:, clear].max() < 4 * 2 / 245


def test_rows_that_were_left_out_are_counted(tmp_path):
    fit = fit_at_truth(make_noisy("theta", show("theta"), SIGMA))
    run, path = make_run(fit, 1000, {}), tmp_path / "run.json"
    run.write(path)
    assert read_run(path)[2].rows == 1000
    assert ": 240 measured points of 1000 rows; " in run.describe(path)


@pytest.mark.slow
def test_a_run_is_refused_by_its_name_and_place_before_and_after_the_fit(table, tmp_path, capsys):
    assert main([str(table), "--run", "run.txt"]) == 1
    error = "top_fit: --run must be a name that ends in .json, got 'run.txt'\n"
    assert capsys.readouterr().err == error
    path = tmp_path / "none/run.json"
    assert main([str(table), "--run", str(path)]) == 1
    assert capsys.readouterr().err == f"top_fit: {path}: No such file or directory\n"


def test_a_plan_has_no_points(capsys):
    assert main(["--plan", "cusps", "--run", "run.json"]) == 1
    assert capsys.readouterr().err == "top_fit: --run must be used with a record, got --plan\n"
