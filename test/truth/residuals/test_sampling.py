"""Rows that are there twice, and times that are rounded or cut."""

import numpy as np
import pytest

from symtop_ros.truth.residuals.sampling import (
    describe_repeats,
    describe_time_step,
    find_repeats,
    find_time_step,
)

MS = 1_000_000  # ns
FRAMES = np.arange(240) * (10**9 / 120)


def test_rows_of_merged_bags_are_found_wherever_they_stand():
    times = np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
    values = np.array([[1.0], [2.0], [3.0], [1.0], [7.0], [3.0]])
    assert find_repeats(times, values).tolist() == [False, False, False, True, False, True]


def test_rows_that_grow_are_none_twice():
    assert not find_repeats(np.arange(5.0), np.ones((5, 2))).any()
    assert not find_repeats(np.zeros(0), np.zeros((0, 2))).any()


def test_a_row_may_be_there_three_times():
    assert find_repeats(np.zeros(3), np.ones((3, 1))).tolist() == [False, True, True]


def test_repeats_are_said_with_the_first_time():
    (text,) = describe_repeats(np.array([2.5, 7.0]))
    assert text == "2 rows are there a second time, the first at 2.5 s: counted once"
    assert [*describe_repeats(np.zeros(0))] == []


@pytest.mark.parametrize("cut", [np.floor, np.rint])
@pytest.mark.parametrize("step", [MS, MS // 10])
def test_times_that_are_cut_or_rounded_are_found(step, cut):
    stamps = (step * cut(FRAMES / step)).astype(np.int64)
    assert find_time_step(stamps) == pytest.approx(step / 10**9)
    (text,) = describe_time_step(find_time_step(stamps))
    assert text.startswith(f"times are rounded or cut to {step / MS:g} ms: each is off")


@pytest.mark.parametrize(
    "stamps",
    [
        np.arange(100) * 10 * MS,
        np.delete(np.arange(100) * 10 * MS, [3, 4, 50]),
        FRAMES.astype(np.int64),
        np.array([0, 8 * MS, 17 * MS]),
        np.zeros(100, dtype=np.int64),
    ],
    ids=["even", "some are missing", "whole ns", "three", "a clock that stands"],
)
def test_times_of_an_even_clock_are_not_rounded(stamps):
    assert find_time_step(stamps) == 0.0
    assert [*describe_time_step(0.0)] == []
