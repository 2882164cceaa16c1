"""Noise that lasts: autoregressions, flicker, and rows after gaps."""

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.truth.residuals.whitening import (
    find_pacf,
    find_predictors,
    measure_noise,
)

ROWS = 400
FOLLOWS = np.append(False, np.ones(ROWS - 1, dtype=bool))
GOOD = np.ones(ROWS, dtype=bool)


def make_lasting(slope, seed=1):
    """Return noise of deviation 1 that keeps a part from row to row, (n, 2)."""
    rows = Numbers(seed).normals(ROWS, 2)
    for k in range(1, ROWS):
        rows[k] = slope * rows[k - 1] + np.sqrt(1 - slope**2) * rows[k]
    return rows


def make_flicker(power, seed=1):
    """Return fractional noise (n, 2) by its definition: sums of all steps before (Hosking 1981)."""
    steps = Numbers(seed).normals(2 * ROWS, 2)
    weights = np.cumprod(np.append(1.0, 1 + (power - 1) / np.arange(1, ROWS)))
    return np.array([weights @ steps[k : k - ROWS : -1] for k in range(ROWS, 2 * ROWS)])


def test_predictors_are_the_solutions_of_yule_and_walker():
    partial = np.array([[0.5, -0.25], [0.25, 0.5], [-0.125, 0.25]])
    slopes, deviations = find_predictors(partial)
    for column in range(2):
        # the correlations that these partial ones are of
        correlations = [1.0]
        for order in range(1, 4):
            own = slopes[order - 1, : order - 1, column]
            left = 1 - own @ correlations[1:order] if order > 1 else 1.0
            seen = own @ correlations[order - 1 : 0 : -1] if order > 1 else 0.0
            correlations.append(partial[order - 1, column] * left + seen)
        matrix = np.array(correlations)[np.abs(np.subtract.outer(range(3), range(3)))]
        solved = np.linalg.solve(matrix, correlations[1:])
        assert slopes[3, :, column] == pytest.approx(solved, abs=1e-14)
        new = 1 - solved @ correlations[1:]
        assert deviations[0, column] == pytest.approx(new**-0.5, rel=1e-14)


@pytest.mark.parametrize("power", [0.3, 0.45])
def test_flicker_is_found_and_whitened(power):
    rows = make_flicker(power)
    noise = measure_noise(rows, GOOD, FOLLOWS, find_pacf(rows, GOOD, FOLLOWS, 0), 0)
    assert noise.is_flicker
    # partial autocorrelations d/(k - d); the likelihood of 800 numbers knows d to 0.03 (Hosking)
    assert noise.partial[0] == pytest.approx(power / (1 - power), rel=0.35)
    new = noise.whiten(rows)
    # correlations of 800 white numbers are below five deviations
    assert abs((new[1:] * new[:-1]).mean()) < 5 / np.sqrt(2 * ROWS)


def test_an_autoregression_is_no_flicker():
    rows = make_lasting(0.75)
    partial = find_pacf(rows, GOOD, FOLLOWS, 0)
    assert 1 <= len(partial) < 12
    assert partial[0] == pytest.approx([0.75, 0.75], abs=5 * np.sqrt((1 - 0.75**2) / ROWS))


def test_rows_after_a_gap_or_an_outlier_begin_anew():
    rows, partial = make_lasting(0.75), np.array([[0.75, 0.75]])
    follows, good = FOLLOWS.copy(), GOOD.copy()
    follows[100], good[200] = False, False
    noise = measure_noise(rows, good, follows, partial, 0)
    assert noise.before[[0, 1, 100, 101, 200, 201, 202]].tolist() == [0, 1, 0, 1, 1, 0, 1]
    new = noise.whiten(rows)
    assert len(new) == ROWS - 1
    # without a row before, what is new is the row itself, in deviations of a whole row
    size = noise.sigma / np.sqrt(1 - 0.75**2)
    assert new[100] == pytest.approx(rows[100] / size, rel=1e-12)


def test_white_noise_has_no_order():
    rows = Numbers(3).normals(ROWS, 3)
    assert len(find_pacf(rows, GOOD, FOLLOWS, 0)) == 0


@pytest.mark.parametrize("slope", [0.0, 0.9375])
def test_a_column_without_residuals_has_a_noise_without_a_size_and_no_warning(slope):
    rows = make_lasting(slope)
    rows[:, 1] = 0.0
    partial = find_pacf(rows, GOOD, FOLLOWS, 4)
    noise = measure_noise(rows, GOOD, FOLLOWS, partial, 4)
    assert noise.sigma[1] < 1e-100
    assert np.isfinite(noise.whiten(rows)).all()
    assert (len(partial) > 0) == (slope > 0)
