"""The rule by which numbers are written, against decimals of any length."""

import math
import random
import struct
from decimal import ROUND_HALF_EVEN, Decimal, localcontext

import pytest

from symtop_ros.words.templates import write_number


def doubles(count):
    """Doubles of all sizes, and halves of the last digit that is written."""
    rng = random.Random(7)
    found = [0.0, -0.0, 0.125, 0.375, 2.5, -0.0005, 0.0005, 1e5, 0.1, 1e-300, -1e300, 99999.995]
    found += [rng.randrange(-(2**20), 2**20) / 2**k for k in range(12) for _ in range(count // 40)]
    while len(found) < count:
        (each,) = struct.unpack("<d", rng.randbytes(8))
        found += [each] if math.isfinite(each) else []
    return found


def by_the_rule(value, digits):
    """The nearest decimal to the exact double; a tie goes to the even digit; zero has no sign.

    None for what would read as zero, and is not.
    """
    with localcontext() as context:
        context.prec = 1000
        exact = Decimal(value).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_EVEN)
    if exact == 0 and value != 0:
        return None
    return format(abs(exact) if exact == 0 else exact, "f")


@pytest.mark.parametrize("digits", [0, 1, 3, 6])
def test_decimals_are_those_of_the_exact_double_with_halves_to_even(digits):
    for value in doubles(4000):
        text, expected = write_number(value, f"{digits}f"), by_the_rule(value, digits)
        if expected is None:
            assert_has_digits(text, value, max(digits, 1))
        else:
            assert text == expected


def assert_has_digits(text, value, digits):
    with localcontext() as context:
        context.prec = digits
        context.rounding = ROUND_HALF_EVEN
        assert Decimal(text) == +Decimal(value)
    assert text != "-0"


def test_significant_digits_are_those_of_the_exact_double():
    for value in doubles(4000):
        assert_has_digits(write_number(value, "3g"), value, 3)


LIMITS = [
    (1e-4, "3g", "0.0001"),
    (9.9996e-5, "3g", "0.0001"),
    (1e-5, "3g", "1e-05"),
    (999.6, "3g", "1e+03"),
    (120.0, "3g", "120"),
    (0.0, "2r", "0.00"),
    (0.1, "2r", "0.10"),
    (0.0999, "2r", "0.0999"),
    (123456.0, "2r", "1.23e+05"),
    (math.pi, "1fdeg", "180.0"),
    (-1e-9, "1fdeg", "-6e-08"),
    (-0.0, "3f", "0.000"),
    (1e-5, "3to7f", "1e-05"),
]


@pytest.mark.parametrize(("value", "form", "text"), LIMITS)
def test_each_format_at_its_limits(value, form, text):
    assert write_number(value, form) == text
