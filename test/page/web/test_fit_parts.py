"""The parts of the page's fit: statistics, records, noise, starts and the search, by NumPy."""

from pathlib import Path

import numpy as np
import pytest
from drawn import Numbers
from page.web.test_page_fit import CAMERA, NAMED, make_case, write
from scipy.optimize import least_squares

from symtop_ros.physics import Motion, State, Top
from symtop_ros.physics.values import EPS
from symtop_ros.truth.fit.model import Model
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.residuals.lines import find_lines
from workshop.fit.records import see


@pytest.fixture(scope="module")
def fits(tab):
    """A tab with the modules of the fit."""
    tab.add_script_tag(content=Path(__file__).with_name("fits.js").read_text())
    return tab


def find_spread(numbers):
    """Return the deviation of normal numbers with this median distance from the median."""
    return 1.4826 * np.median(np.abs(numbers - np.median(numbers, axis=0)), axis=0)


def test_medians_and_quantiles_are_those_of_numpy(fits):
    draw = Numbers("quantiles")
    columns = [draw.normals(count) for count in (1, 2, 7, 20)]
    parts = (0.0, 0.25, 0.5, 0.9, 1.0)
    calls = [["findQuantile", each.tolist(), part] for each in columns for part in parts]
    found = fits.evaluate("callAll", ["fit/statistics", calls])
    right = [np.quantile(each, part) for each in columns for part in parts]
    np.testing.assert_allclose(found, right, rtol=0, atol=8 * EPS)
    calls = [["findSpread", each.tolist()] for each in columns]
    found = fits.evaluate("callAll", ["fit/statistics", calls])
    np.testing.assert_allclose(found, [find_spread(each) for each in columns], atol=16 * EPS)


@pytest.mark.parametrize("is_soft", [False, True])
def test_least_squares_end_at_the_minimum_of_scipy(fits, is_soft):
    draw = Numbers("least squares")
    rows, x = draw.normals(30, 3), np.array([1.0, -2.0, 0.5])
    rights = rows @ x + 0.1 * draw.normals(30)
    rights[4] += 20.0  # a row that counts little in a soft loss
    loss = "soft_l1" if is_soft else "linear"
    right = least_squares(lambda x: rows @ x - rights, x, loss=loss, xtol=1e-15, ftol=1e-15)
    wide = [-9, 9]
    given = [rows.tolist(), rights.tolist(), [0.0, 0.0, 0.0], is_soft, wide]
    found = fits.evaluate("minimiseLinear", given)
    # both end where a step changes the cost by its rounding
    np.testing.assert_allclose(found["x"], right.x, rtol=0, atol=np.sqrt(16 * EPS * right.cost))
    assert found["cost"] == pytest.approx(right.cost, rel=1e-12)
    assert (np.abs(found["x"] - x) < 0.1).all() == is_soft
    found = fits.evaluate("minimiseLinear", [*given[:4], [-9, 0.75]])
    assert max(found["x"]) <= 0.75


def test_a_record_knows_its_steps_gaps_and_rounding(fits):
    draw = Numbers("records of a page")
    times = np.arange(40) / 32
    u, v = 300 + 40 * np.cos(2 * times), 200 + 30 * np.sin(3 * times) + draw.normals(40)
    times[25:] += 0.25  # a gap
    values = np.transpose([np.round(4 * u) / 4, v])
    values[10, 1] += 5000.0  # a wrong row
    given = {"kind": "pixels", "times": (2 + times).tolist(), "values": values.tolist()}
    found = fits.evaluate("describeRecord", given)
    assert found["times"] == times.tolist()
    assert (found["width"], found["count"], found["cut"]) == (2, 40, 13)
    assert (found["step"], found["seconds"]) == (1 / 32, times[-1])
    assert np.flatnonzero(~np.array(found["follows"])).tolist() == [0, 25]
    np.testing.assert_allclose(found["spreads"], find_spread(values), rtol=1e-12)
    # the errors of rounding to 0.25 are between -0.125 and 0.125, all equally likely
    np.testing.assert_allclose(found["rounding"], [0.25 / np.sqrt(12), 0.0], rtol=1e-12)
    assert found["fixed"] == [False, False]
    padded = np.pad(values, ((2, 2), (0, 0)), "edge")
    medians = np.array([np.median(padded[k : k + 5], axis=0) for k in range(40)])
    far = np.abs(values - medians)
    is_wrong = (far > 4 * np.quantile(far, 0.9, axis=0)).any(axis=1)
    assert is_wrong[10]
    assert is_wrong.sum() < 5
    smooth = np.where(is_wrong[:, np.newaxis], medians, values)
    assert found["smooth"] == smooth.tolist()


@pytest.mark.parametrize(("places", "step"), [((0, 1), 1.0), ((0, 2, 4), 2.0), ((0, 5), 5.0)])
def test_a_column_that_stays_within_some_steps_of_its_rounding_has_one_error(fits, places, step):
    u = 10.0 + np.array([places[k % len(places)] for k in range(20)])
    wide = np.arange(20.0)
    values = np.transpose([u, wide]).tolist()
    given = {"kind": "pixels", "times": [*range(20)], "values": values}
    found = fits.evaluate("describeRecord", given)
    np.testing.assert_allclose(found["rounding"], np.array([step, 1.0]) / np.sqrt(12), rtol=1e-12)
    assert found["fixed"] == [True, False]


@pytest.mark.parametrize(("distance", "has_length"), [(1.0, False), (23.0, True)])
def test_points_at_one_distance_other_than_one_have_a_length(fits, distance, has_length):
    record, _, _ = make_case("axis")
    values = distance * record.values / np.linalg.norm(record.values, axis=1)[:, np.newaxis]
    given = {**write(record), "values": values.tolist()}
    found = fits.evaluate("describeRecord", given)
    assert found["hasLength"] == has_length
    np.testing.assert_allclose(np.linalg.norm(found["values"], axis=1), 1.0, rtol=1e-12)


def leave(seed, *far):
    """Return rows of normal numbers, some of which are so many spreads away, in their column."""
    rows = Numbers(seed).normals(60, 2) * [1.0, 8.0]
    for row, column, deviations in far:
        rows[row, column] = deviations * find_spread(rows)[column]
    return rows


PLAIN = {"rounding": [0, 0], "fixed": [False, False], "values": [[1.0, 1.0]]}
FOLLOWS = [False, *[True] * 59]


def test_rows_that_are_five_deviations_away_are_outliers(fits):
    rows = leave("outliers", (3, 0, 5.5), (20, 1, -5.5), (40, 0, 4.5), (41, 1, -4.5))
    assert np.abs(rows / find_spread(rows))[[3, 20], [0, 1]].min() > 5
    found = fits.evaluate("findNoise", [rows.tolist(), PLAIN | {"follows": FOLLOWS}, False])
    kept = np.setdiff1d(np.arange(60), [3, 20])
    assert found["kept"] == kept.tolist()
    # of 57 numbers three parameters are free
    sigma = np.sqrt((rows[kept] ** 2).sum(axis=0) / (len(kept) - 3 / 2))
    np.testing.assert_allclose(found["sigma"], sigma, rtol=1e-12)
    white = np.reshape(found["white"], (-1, 2))
    np.testing.assert_allclose(white, rows[kept] / sigma, rtol=1e-12)


def test_noise_is_no_smaller_than_rounding_and_one_error_counts_once(fits):
    rows = leave("rounded") * 1e-6
    given = {"rounding": [0.5, 0.25], "fixed": [False, True], "follows": FOLLOWS}
    found = fits.evaluate("findNoise", [rows.tolist(), {**given, "values": [[1.0]]}, True])
    assert len(found["kept"]) == 60
    np.testing.assert_allclose(found["sigma"], [0.5, 0.25 * np.sqrt(60)], rtol=1e-12)


def test_exact_values_leave_the_rounding_of_doubles(fits):
    rows = np.zeros((60, 2))
    rows[7] = 1e-9  # of values of some hundred
    given = PLAIN | {"follows": FOLLOWS, "values": [[-300.0, 100.0]]}
    found = fits.evaluate("findNoise", [rows.tolist(), given, False])
    assert 7 not in found["kept"]
    np.testing.assert_allclose(found["sigma"], 300 * 1e-14, rtol=1e-12)


SLOW, FAST = 20.0, 90.0  # rad/s


def test_starts_are_looked_for_at_the_frequencies_of_the_record(fits):
    times = np.arange(200) / 64
    u = 300 * np.cos(SLOW * times) + np.cos(FAST * times)  # a nutation may be small
    values = np.transpose([u, 300 * np.sin(SLOW * times)])
    given = {"kind": "pixels", "times": times.tolist(), "values": values.tolist()}
    found = fits.evaluate("askStarts", [given, []])
    rates = np.array(found["rates"])
    step = 2 * np.pi / (8 * times[-1])  # of a spectrum that is eight times finer
    for wanted in (SLOW, FAST, FAST - SLOW):
        assert np.abs(rates - wanted).min() < 2 * step
    assert rates.min() >= np.pi / times[-1] * (1 - 4 * EPS)
    assert rates.max() <= 1.2 * np.pi * 64
    even = np.geomspace(np.pi / times[-1], np.pi * 64, 20)
    assert np.abs(rates[:, np.newaxis] - even).min(axis=0).max() < 1e-10
    np.testing.assert_allclose(found["parts"], np.arange(len(rates)) / len(rates), atol=EPS)


def test_the_two_shapes_that_leave_least_are_improved_at_the_frequency(fits):
    record, _, _ = make_case("axis")
    costs = [7.0, 3.0, 9.0, 1.0, 5.0]
    found = fits.evaluate("askStarts", [write(record), costs])
    assert 200 < len(found["all"]) <= 250
    for y, shape in zip(found["shapes"], (3, 1), strict=True):
        (weight, p, theta, tilting, turning), own = found["all"][shape]
        faster = 7 / own  # of all rates; a weight is the square of one
        right = [weight * faster**2, p * faster, theta, tilting * faster, turning * faster]
        np.testing.assert_allclose(y, right, rtol=4 * EPS)
    for y, own in found["all"][::25]:
        nutation = 2 * np.pi / throw(y).nutation_period
        assert own == pytest.approx(nutation, rel=1e-12)


def throw(y, phi=0.0):
    """Return the motion of Mgl/Ix, p_psi/Ix, theta, theta' and phi' sin(theta)."""
    weight, p, theta, tilting, turning = y
    start = State.from_euler(theta=theta, phi=phi)
    return Motion(Top(1.0, 1.0, weight), State(start.orientation, [tilting, turning, p]))


Y = [300.0, 50.0, 0.5, -0.75, 1.25]
TIMES = np.arange(40) / 64
# Points of an axis that is turned, mirrored, or the other end of the axis.
WAYS = {"turned": (1, 1, 1), "mirrored": (1, -1, 1), "other end": (-1, -1, -1)}
WAYS |= {"other end, mirrored": (-1, 1, -1)}


def map_linearly(points, y, more):
    """Return the linear map from the axis of a motion to some points, a row for each column."""
    axes = see(throw(y), "axis", TIMES, {})
    columns = np.column_stack([axes, *([np.ones(len(axes))] if more else [])])
    return np.linalg.lstsq(columns, points, rcond=None)[0].T.tolist()


@pytest.mark.parametrize("way", WAYS)
def test_an_axis_that_is_turned_or_mirrored_has_a_motion(fits, way):
    points = see(throw(Y, phi=0.75), "axis", TIMES, {}) * WAYS[way]
    given = {"kind": "axis", "times": TIMES.tolist(), "values": points.tolist()}
    (found,) = fits.evaluate("fillStarts", [[given, Y, map_linearly(points, Y, more=False)]])
    # phases of 40 rad from a map with some digits less
    np.testing.assert_allclose(found["left"], 0.0, atol=1e-10)
    weight = found["x"][found["names"].index("Mgl/Ix")]
    assert weight == (300.0 if way in ("turned", "mirrored") else -300.0)


@pytest.mark.parametrize("elevation", [0.5, -1.25])
@pytest.mark.parametrize("roll", [0.03125, 2.5])
def test_a_picture_shows_the_camera(fits, elevation, roll):
    camera = CAMERA | {"elevation": elevation, "roll": roll}
    points = see(throw(Y, phi=0.75), "pixels", TIMES, camera)
    given = {"kind": "pixels", "times": TIMES.tolist(), "values": points.tolist()}
    (found,) = fits.evaluate("fillStarts", [[given, Y, map_linearly(points, Y, more=True)]])
    np.testing.assert_allclose(found["left"], 0.0, atol=1e-7)  # px of some hundred
    numbers = dict(zip(found["names"], found["x"], strict=True))
    for name, value in camera.items():
        assert numbers[name] == pytest.approx(value, abs=1e-8), name


def test_a_search_ends_at_the_motion_that_its_starts_are_near(fits):
    record, reference, _ = make_case("axis")
    near, far = [{**NAMED, "Mgl/Ix": 300.0 + by, "wx": 0.5 + by / 20} for by in (9.0, -12.0)]
    far["p_psi/Ix"] = 30.0
    effort = {"kept": 2, "first": 12, "share": 0.35}
    given = [write(record), reference, [far, near], effort]
    answer = fits.evaluate("searchFrom", given)
    assert answer["parts"] == [21]  # 0.35 of 60 rows
    best, *others = answer["found"]
    assert len(others) <= 1
    assert all(best["cost"] < each["cost"] for each in others)
    assert best["rows"] == 60
    model = Model(record, np.array(reference))
    fit = refine(model, fill(model, NAMED))
    # a loss in which large residuals count less has a minimum that is less sure
    deviations = np.sqrt(np.diag(fit.covariance))
    assert (np.abs(best["x"] - fit.x) < deviations).all()


@pytest.mark.parametrize("size", [0.0, 0.75])
def test_a_swing_at_a_frequency_of_the_motion_is_found_as_top_fit_finds_it(fits, size):
    rates = {"nutation_period": 0.125, "mean_precession_rate": 4.0}
    turning = 4.0 / (2 * np.pi)
    named = {"nutation": 8.0, "twice_nutation": 16.0, "once": turning, "twice": 2 * turning}
    found, right = [], []
    for seed in range(6):
        draw = Numbers(seed)
        times = np.flatnonzero([draw.random() > 0.1 for _ in range(240)]) / 64
        rows = draw.normals(len(times), 2)
        rows[:, 1] += size * np.sqrt(2) * np.cos(2 * np.pi * 16.0 * times)
        right.append(any(line.name for line in find_lines(times, rows, named)))
        found.append(fits.evaluate("trySwing", [times.tolist(), rows.T.tolist(), rates]))
    assert found == right
    assert sum(found) == (0 if size == 0 else 6)
