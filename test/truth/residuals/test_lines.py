"""Lines in residuals: false alarms are as rare as stated in noise of any spectrum, and lines are
found that an autoregression takes for noise."""

import random

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.truth.residuals import lines
from symtop_ros.truth.residuals.lines import Spectrum, find_lines
from symtop_ros.truth.residuals.whitening import find_noise


class Drawn(random.Random):
    """Random numbers that are drawn fast; their last bits do not matter to counts of alarms."""

    def normals(self, *shape):
        return np.random.default_rng(self.randrange(2**32)).normal(size=shape)


ROWS = 240
TIMES = np.arange(ROWS) / 128
NAMED = {"spin": 11.25, "twice_spin": 22.5, "nutation": 17.0, "precession": 150.0}


def make_white(numbers):
    return numbers.normals(ROWS, 2)


def make_lasting(numbers):
    rows = numbers.normals(ROWS, 2)
    for k in range(1, ROWS):
        rows[k] = 0.96875 * rows[k - 1] + 0.25 * rows[k]
    return rows


def make_flicker(numbers):
    """Return fractional noise with d = 0.45 (Hosking 1981)."""
    steps = numbers.normals(2 * ROWS, 2)
    weights = np.cumprod(np.append(1.0, 1 + (0.45 - 1) / np.arange(1, ROWS)))
    return np.array([weights @ steps[k : k - ROWS : -1] for k in range(ROWS, 2 * ROWS)])


def make_heavy(numbers):
    """Return noise with outliers: one row in twenty is ten times as large."""
    rows = numbers.normals(ROWS, 2)
    rows[[numbers.random() < 0.05 for _ in range(ROWS)]] *= 10
    return rows


NOISES = {"white": make_white, "lasts": make_lasting, "flicker": make_flicker, "heavy": make_heavy}


def choose_rows(name, numbers):
    """Return the rows that are there."""
    seen = np.ones(ROWS, dtype=bool)
    if name == "stretches":
        for first in (60, 110, 190):
            seen[first : first + ROWS // 9] = False
    if name == "single":
        seen = np.array([numbers.random() > 0.1 for _ in range(ROWS)])
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("rows", ["all", "stretches", "single"])
@pytest.mark.parametrize("noise", NOISES)
def test_false_alarms_are_as_rare_as_stated(noise, rows, monkeypatch):
    monkeypatch.setattr(lines, "CHANCE", 0.1)
    count = 200
    alarms = 0
    for seed in range(count):
        numbers = Drawn(seed)
        seen = choose_rows(rows, numbers)
        alarms += bool(find_lines(TIMES[seen], NOISES[noise](numbers)[seen], NAMED))
    # of 200 records with a chance of 0.1 each more than 36 have one once in ten thousand times
    assert alarms <= 36


def add_line(rows, frequency, size, column=0):
    found = rows.copy()
    found[:, column] += np.sqrt(2) * size * np.cos(2 * np.pi * frequency * TIMES + 1)
    return found


@pytest.mark.parametrize("noise", ["white", "lasts", "flicker"])
def test_a_line_is_found_at_its_frequency_with_its_size(noise):
    rows = NOISES[noise](Numbers(3))
    size = 0.75 * rows[:, 1].std()
    (line,) = find_lines(TIMES, add_line(rows, 11.25, size, 1), NAMED)
    assert (line.name, line.column) == ("spin", 1)
    # half of a step of frequency, and the noise within a step of it
    assert line.frequency == pytest.approx(11.25, abs=0.5 * 128 / ROWS)
    assert line.size == pytest.approx(size, rel=0.25)
    assert line.chance <= lines.CHANCE / 2


def test_a_line_that_nobody_named_is_found_anywhere():
    (line,) = find_lines(TIMES, add_line(make_white(Numbers(4)), 41.0, 1.0), NAMED)
    assert line.name == ""
    assert line.frequency == pytest.approx(41.0, abs=0.5 * 128 / ROWS)


def test_a_frequency_above_half_of_the_sampling_is_tried_where_it_is_seen():
    assert Spectrum(TIMES, np.zeros((ROWS, 1))).fold(150.0) == pytest.approx(22.0)
    rows = add_line(make_white(Numbers(5)), 150.0, 1.0)
    assert [each.name for each in find_lines(TIMES, rows, NAMED)] == ["precession"]


def test_a_line_is_found_that_an_autoregression_takes_for_correlated_noise():
    rows = add_line(make_white(Numbers(6)), 11.25, 2.0)
    noise = find_noise(rows, np.append(False, np.ones(ROWS - 1, dtype=bool)), 8)
    assert len(noise.partial) > 2
    assert np.abs(noise.whiten(rows)).std() < 1.25
    assert [each.name for each in find_lines(TIMES, rows, NAMED)] == ["spin"]


@pytest.mark.parametrize("count", [0, 1, 12, 63])
def test_few_rows_have_no_lines(count):
    assert find_lines(TIMES[:count], make_white(Numbers(7))[:count], NAMED) == ()


def test_rows_without_residuals_have_no_lines():
    assert find_lines(TIMES, np.zeros((ROWS, 2)), NAMED) == ()


def test_of_a_record_with_long_gaps_only_given_frequencies_are_tried():
    times = np.where(np.arange(ROWS) < ROWS // 2, TIMES, TIMES + 1000)
    rows = make_white(Numbers(8))
    rows[:, 0] += 2 * np.cos(2 * np.pi * 11.25 * times)
    assert [each.name for each in find_lines(times, rows, NAMED)] == ["spin"]
    assert find_lines(times, rows, {}) == ()
