"""Columns at the limit of their sensor, and those that only look like it."""

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.truth.residuals.saturation import RATES, find_saturated, find_saturations

ROWS = 300
LIMIT = float(RATES[4])  # 2000 deg/s
SWING = np.sin(np.arange(ROWS) / 7)
COUNT = 0.001


def round_to(values, step=COUNT):
    return step * np.round(values / step)


def make_columns(middle, size):
    """Return a column that swings about a number, with noise, in counts, (n, 1)."""
    noise = 0.05 * Numbers(2).normals(ROWS)
    return round_to(middle + size * SWING + noise)[:, np.newaxis]


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("limit", [LIMIT, 30.0])
def test_a_column_that_is_cut_at_a_limit_is_named_with_its_rows(limit, sign):
    values = sign * np.minimum(make_columns(limit - 1, 5.0), limit)
    (found,) = find_saturations(values, RATES)
    assert (found.column, found.limit) == (0, sign * limit)
    assert found.rows == (values == sign * limit).sum() > ROWS // 4
    assert find_saturated(values, (found,)).sum() == found.rows


def test_a_number_of_another_column_at_either_end_is_at_the_limit_too():
    values = np.concatenate(
        [np.minimum(make_columns(LIMIT - 1, 5.0), LIMIT), make_columns(0.0, 20.0)], axis=1
    )
    values[[3, 50], 1] = -LIMIT, -LIMIT * 32768 / 32767
    (found,) = find_saturations(values, RATES)
    assert np.flatnonzero(find_saturated(values, (found,))[:, 1]).tolist() == [3, 50]


def test_both_ends_may_be_cut():
    values = np.clip(make_columns(0.0, 50.0), -LIMIT, LIMIT)
    assert [each.limit for each in find_saturations(values, RATES)] == [-LIMIT, LIMIT]


@pytest.mark.parametrize("part", [1.0, 32767 / 32768, 32767 / 16.4 / 2000])
def test_a_column_that_does_not_change_is_saturated_at_a_range_of_sensors(part):
    values = np.full((ROWS, 1), part * LIMIT)
    assert [each.rows for each in find_saturations(values, RATES)] == [ROWS]


@pytest.mark.parametrize(
    "values",
    [
        np.full((ROWS, 1), 200.0),
        np.zeros((ROWS, 1)),
        make_columns(30.0, 5.0),
        round_to(make_columns(30.0, 5.0), 0.5),
        round_to(10 * SWING, 0.01)[:, np.newaxis],
        round_to(10 * SWING, 1.0)[:, np.newaxis],
        round_to(make_columns(200.0, 0.0), 0.125),
        # a top that stands still in the end
        np.maximum(round_to(20 - np.arange(ROWS) / 8), 0.0)[:, np.newaxis],
    ],
    ids=["steady", "zero", "noisy", "coarse", "sine", "coarse sine", "two levels", "stands"],
)
def test_what_is_within_the_range_is_not_saturated(values):
    assert find_saturations(values, RATES) == ()
