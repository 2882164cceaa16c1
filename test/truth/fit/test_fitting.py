"""Fits of records of each kind: numbers within their deviations, and what is left open."""

import numpy as np
import pytest
from drawn import Numbers
from truth.fit.cases import CUSPS, SIGMA, TIMES, make_axis, make_noisy

from symtop_ros.physics import Friction, Motion, State, Top, regular_precession_rates
from symtop_ros.truth.fit import fit_motion, make_record
from symtop_ros.truth.fit.camera import project
from symtop_ros.truth.fit.check import FAILS, HOLDS, Check, find_half
from symtop_ros.truth.fit.model import Model, find_axis, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.report import Report
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.values import list_values
from workshop.fit.records import draw_sample

# A normal number is farther than five deviations once in two million.
FAR = 5.0


def read_values(fit):
    return {each.name: each for each in list_values(fit)}


def assert_near(value, truth):
    assert value.is_known
    assert abs(value.value - truth) < FAR * value.deviation


@pytest.fixture(scope="module")
def fit():
    return fit_motion(make_record(TIMES, make_axis(), "axis"))


def test_the_axis_shows_the_motion_and_the_noise(fit):
    values = read_values(fit)
    for name, truth in {
        "Mgl/Ix": 300.0,
        "p_psi/Ix": 0.25 * CUSPS.start.angular_velocity[2],
        "theta": 0.5,
        "phi_dot": 1.0,
        "nutation_period": CUSPS.nutation_period,
        "mean_precession_rate": CUSPS.mean_precession_rate,
    }.items():
        assert_near(values[name], truth)
    # five deviations of 720 numbers
    assert np.linalg.norm(fit.noise.sigma) == pytest.approx(SIGMA * np.sqrt(3), rel=0.13)
    assert Check(fit).verdict == HOLDS


@pytest.mark.slow
def test_the_distance_of_points_other_than_one_is_looked_for(fit):
    exact = find_axis(CUSPS.at(TIMES).orientation)
    assert not fit.model.record.has_length
    assert not make_record(TIMES, exact, "axis").has_length
    found = fit_motion(make_record(TIMES, 23.0 * make_axis(), "axis"))
    assert found.model.record.has_length
    values, known = read_values(found), read_values(fit)
    assert_near(values["theta"], 0.5)
    assert_near(values["Mgl/Ix"], 300.0)
    # a distance that is too large by a part is a tilt
    assert values["theta"].deviation > known["theta"].deviation


@pytest.mark.slow
def test_angles_show_the_same_across_the_period_of_phi(fit):
    angles = CUSPS.at(TIMES).euler_angles
    seen = np.stack([angles.theta, angles.phi], axis=1)
    values = read_values(fit_motion(make_noisy("angles", seen, SIGMA)))
    assert_near(values["Mgl/Ix"], 300.0)


@pytest.mark.parametrize("Mgl", [200.0, -200.0])
def test_rates_show_the_body_and_a_positive_weight(Mgl):
    motion = Motion(Top(1.0, 1.5, Mgl), State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=20.0))
    seen = motion.at(TIMES).angular_velocity
    values = read_values(fit_motion(make_noisy("rates", seen, 0.125)))
    assert_near(values["Mgl/Ix"], 200.0)
    assert_near(values["Iz/Ix"], 1.5)
    assert "phi" not in values


def test_attitudes_show_all_but_a_moment():
    values = read_values(fit_motion(make_noisy("attitude", CUSPS.at(TIMES).orientation, SIGMA)))
    assert_near(values["Iz/Ix"], 0.25)
    assert_near(values["spin"], CUSPS.start.angular_velocity[2])


@pytest.mark.slow
def test_pixels_show_the_motion_and_the_camera():
    camera = {"u": 600.0, "v": 400.0, "log_scale": 5.5, "elevation": 0.5, "roll": 0.0625}
    axis = find_axis(CUSPS.at(TIMES).orientation)
    seen = project(axis[None], {name: np.array([value]) for name, value in camera.items()})[0]
    values = read_values(fit_motion(make_noisy("pixels", seen, 0.5)))
    assert_near(values["Mgl/Ix"], 300.0)
    assert_near(values["elevation"], 0.5)
    assert_near(values["scale"], float(np.exp(5.5)))


@pytest.mark.slow
def test_theta_alone_names_both_momenta():
    seen = CUSPS.at(TIMES).euler_angles.theta[:, None]
    found = fit_motion(make_noisy("theta", seen, 2.0**-12))
    report = Report("record", len(TIMES), found, {})
    kinds = {each.kind: each for each in report.unknown}
    momenta = 0.25 * CUSPS.start.angular_velocity[2], CUSPS.top.angular_momentum(CUSPS.start)[2]
    assert sorted(kinds["exchange"].numbers) == pytest.approx(sorted(momenta), rel=0.05)
    assert {"reverse", "azimuth", "moments", "spin"} <= set(kinds)


@pytest.mark.slow
def test_friction_is_found_if_it_is_looked_for_and_else_the_model_fails():
    top = CUSPS.top
    motion = Motion(top, CUSPS.start, Friction(axial=0.125 * top.Iz, transverse=0.25))
    times = np.arange(120) / 64
    seen = make_axis(motion, times)
    values = read_values(fit_motion(make_record(times, seen, "axis", has_friction=True)))
    assert_near(values["axial/Iz"], 0.125)
    assert_near(values["transverse/Ix"], 0.25)
    half = values["spin_half_time"]
    assert half.is_known
    spins = motion.at([0.0, half.value]).angular_velocity[:, 2]
    # of the rate c: (1/2)^(1/(1 + d)) is 1/2 + d ln(2)/2
    part = half.deviation / half.value
    assert spins[1] / spins[0] == pytest.approx(0.5, abs=FAR * part * np.log(2) / 2)
    assert Check(fit_motion(make_record(times, seen, "axis"))).verdict == FAILS


@pytest.mark.slow
@pytest.mark.parametrize("theta", [0.5, 1.25])
def test_without_nutation_one_combination_is_known(theta):
    """And it is right, though the motion that is found may have any p_psi."""
    top = Top(1.0, 0.25, 300.0)
    slow = float(regular_precession_rates(top, theta=theta, psi_dot=200.0)[0])
    start = State.from_euler(theta=theta, phi_dot=slow, psi_dot=200.0)
    found = fit_motion(make_record(TIMES, make_axis(Motion(top, start)), "axis"))
    report = Report("record", len(TIMES), found, {})
    (together,) = [each for each in report.unknown if each.kind == "together"]
    factor, uncertain, rest, deviation = together.numbers
    assert abs(slow - factor) < FAR * uncertain
    assert abs(300.0 - slow * 0.25 * start.angular_velocity[2] - rest) < FAR * deviation
    assert not {"Mgl/Ix", "p_psi/Ix"} & {each.name for each in report.values if each.is_known}


@pytest.mark.slow
def test_few_rows_in_a_nutation_leave_the_momentum_open():
    step = CUSPS.nutation_period / 2.5
    times = np.arange(160) * step
    found = fit_motion(make_record(times, make_axis(times=times), "axis"))
    values = read_values(found)
    assert not values["p_psi/Ix"].is_known
    assert_near(values["mean_precession_rate"], CUSPS.mean_precession_rate)
    kinds = [each.kind for each in Report("record", 160, found, {}).unknown]
    assert "sparse" in kinds


def test_known_values_turn_ratios_into_moments(fit):
    given = {"Iz/Ix": (0.25, 0.005), "Ix": (2e-4, 2e-6)}
    values = {each.name: each for each in Report("record", 240, fit, given).values}
    assert values["Mgl"].value == pytest.approx(0.06, rel=1e-2)
    assert values["spin"].deviation == pytest.approx(0.02 * values["spin"].value, rel=0.05)
    assert values["Iz"].value == pytest.approx(5e-5, rel=1e-12)
    kinds = {each.kind for each in Report("record", 240, fit, given).unknown}
    assert not {"moments", "spin"} & kinds


@pytest.mark.slow
def test_a_bias_about_the_axis_widens_what_rates_show():
    rates = CUSPS.at(TIMES).angular_velocity
    narrow, wide = (
        read_values(fit_motion(make_noisy("rates", rates, 0.125, **more)))
        for more in ({}, {"has_mount": True, "known": {"bias_z": (0.0, 0.5)}})
    )
    # a bias b of z is 2 b of p_psi/Ix
    assert narrow["p_psi/Ix"].deviation < 0.1
    assert wide["p_psi/Ix"].deviation == pytest.approx(1.0, rel=0.1)
    assert_near(wide["p_psi/Ix"], 0.25 * CUSPS.start.angular_velocity[2])


def test_a_column_within_its_last_decimal_has_the_deviation_of_rounding():
    rates = CUSPS.at(TIMES).angular_velocity
    step = 0.25
    values = read_values(fit_motion(make_record(TIMES, step * np.round(rates / step), "rates")))
    spin = values["spin"]
    assert_near(spin, CUSPS.start.angular_velocity[2])
    assert spin.deviation > step / np.sqrt(12) / 10


@pytest.mark.slow
def test_with_small_tilts_the_scale_of_a_picture_and_the_tilt_are_one():
    start = State.from_euler(theta=0.03125, phi_dot=1.0, psi_dot=190.0)
    axis = find_axis(Motion(CUSPS.top, start).at(TIMES).orientation)
    camera = {"u": 600.0, "v": 400.0, "log_scale": 5.5, "elevation": 0.5, "roll": 0.0}
    seen = project(axis[None], {name: np.array([value]) for name, value in camera.items()})[0]
    free = Report("record", len(TIMES), fit_motion(make_noisy("pixels", seen, 0.125)), {})
    assert "tilt" in {each.kind for each in free.unknown}
    assert not {"scale", "theta"} & {each.name for each in free.values if each.is_known}
    known = make_noisy("pixels", seen, 0.125, camera={"log_scale": 5.5})
    values = read_values(fit_motion(known))
    assert_near(values["theta"], 0.03125)


@pytest.mark.slow
def test_fast_attitudes_have_the_fewest_turns_from_row_to_row_that_a_body_allows():
    times = np.arange(200) / 32
    spin = float(CUSPS.start.angular_velocity[2])
    # almost a turn from row to row, which looks like a slow spin the other way: p_psi/spin < 0
    assert 0 < 32 - spin / (2 * np.pi) < 2
    q = CUSPS.at(times).orientation
    noisy = q + SIGMA * Numbers(5).normals(*q.shape)
    values = read_values(fit_motion(make_record(times, noisy, "attitude")))
    assert_near(values["spin"], spin)
    assert_near(values["Iz/Ix"], 0.25)


@pytest.mark.slow
def test_deviations_of_a_record_that_is_too_short_for_its_camera_are_not_said():
    # one nutation and a fifth of a precession: the camera and the motion make up for each other
    found = fit_motion(draw_sample("pixels", "outliers", 402).record)
    report = Report("record", len(found.model.record), found, {})
    (curved,) = [each for each in report.unknown if each.kind == "curved"]
    assert {"u", "v", "scale"} <= {*curved.names.split(", ")}
    assert not {"u", "v", "scale", "Mgl/Ix"} & {v.name for v in report.values if v.is_known}


@pytest.mark.slow
def test_a_hanging_top_that_hardly_spins_is_found_by_few_rows_in_a_nutation():
    # p_psi/Ix is a fifth of the precession; a nutation of 0.85 rows leaves almost as little
    sample = draw_sample("angles", "outliers", 409)
    values = read_values(fit_motion(sample.record))
    for name in ("Mgl/Ix", "p_psi/Ix", "phi", "nutation_period"):
        assert_near(values[name], sample.truth[name])


@pytest.mark.slow
def test_flicker_is_allowed_for_and_said():
    found = fit_motion(draw_sample("axis", "flicker", 0).record)
    assert found.noise.is_flicker
    assert "(flicker) is allowed for" in Report("record", 392, found, {}).write_verdict()


@pytest.mark.parametrize("late", [False, True])
def test_a_half_of_a_record_shows_its_numbers_with_larger_deviations(late):
    record = make_record(TIMES, make_axis(), "axis")
    model = Model(record, CUSPS.start.orientation)
    fit = refine(model, fill(model, name_parameters(CUSPS)))
    half = find_half(fit, late)
    rows = fit.columns[120:] if late else fit.columns[:120]
    slopes = rows.reshape(-1, len(fit.x))
    deviations = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    # noise that is white by drawing may seem to last a little
    assert (half.deviations >= 0.9 * deviations).all()
    assert (half.deviations <= 1.3 * deviations).all()
    assert (half.deviations > np.sqrt(np.diag(fit.covariance))).all()
    truth = fill(model, name_parameters(CUSPS))
    assert (np.abs(half.x - truth) < FAR * half.deviations).all()
