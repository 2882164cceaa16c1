"""Arguments of all types: numbers pass, everything else is refused on one short line."""

import math
from fractions import Fraction

import numpy as np
import pytest
from physics.refusals import FINITE_ARRAY, FINITE_NUMBER, NUMBER, VECTOR, refused

from symtop_ros.physics.values import refuse, validate_array, validate_number, validate_vector


@pytest.mark.parametrize(
    "value",
    [
        2,
        2.0,
        np.float32(2),
        np.int8(2),
        np.array(2.0),
        np.array(2),
        Fraction(4, 2),
        np.longdouble(2),
    ],
)
def test_a_number_of_any_real_type_becomes_a_float(value):
    found = validate_number("x", value)
    assert type(found) is float
    assert found == 2.0


@pytest.mark.parametrize("value", ["2", None, True, np.True_, 2j, [2.0], np.timedelta64(2, "s")])
def test_what_is_no_number_is_refused(value):
    with refused("x", f"{NUMBER} (s)", repr(value)):
        validate_number("x", value, "s")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 10**400, -(10**400)])
def test_a_number_that_is_not_finite_is_refused(value):
    with refused("x", FINITE_NUMBER):
        validate_number("x", value)


@pytest.mark.parametrize(
    "value", [[1, 2, 3], (1.0, 2.0, 3.0), np.arange(1, 4), [1, Fraction(2), 3]]
)
def test_an_array_of_any_real_type_becomes_new_doubles(value):
    found = validate_array("x", value, 3)
    assert found.dtype == np.float64
    assert found.tolist() == [1.0, 2.0, 3.0]
    assert not np.shares_memory(found, np.asarray(value))


@pytest.mark.parametrize(
    "value",
    [
        [1, 2, "3"],
        [1j, 2, 3],
        [True, False, True],
        [1, None, 3],
        [1, 2, math.nan],
        [1, 2, 10**400],
        [[1], [2, 3]],
        np.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0]),
        np.array([1, 2, 3], dtype="timedelta64[ms]"),
    ],
)
def test_an_array_that_does_not_hold_finite_numbers_is_refused(value):
    with refused("x", FINITE_ARRAY):
        validate_array("x", value, 3)


@pytest.mark.parametrize("value", [1.0, [1.0, 2.0], [[1.0, 2.0]], []])
def test_an_array_of_another_size_is_refused_with_its_shape(value):
    with refused("x", "of shape (..., 3)", f"shape {np.shape(value)}"):
        validate_array("x", value, 3)


@pytest.mark.parametrize("value", [[1, 2], "abc", [0, 0, math.inf], [[0, 0, 1]], np.eye(3), 7])
def test_a_vector_is_three_finite_numbers(value):
    with refused("x", f"{VECTOR} (N m)"):
        validate_vector("x", value, "N m")


def test_a_long_value_is_shortened_to_one_line():
    text = str(refuse("x", "short", np.zeros((30, 30))))
    assert text.isprintable()
    assert len(text) < 100
    assert text.endswith(" ...")


def test_a_float_is_shown_with_all_its_digits():
    assert str(refuse("x", "< 2", 2.0000000000000004)) == "x must be < 2, got 2.0000000000000004"
    assert str(refuse("x", "< 2", np.float64(3.0))) == "x must be < 2, got 3"
