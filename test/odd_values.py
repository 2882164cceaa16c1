"""Arbitrary values, most of them invalid, for everything that takes values."""

import math

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

CONTROL = "\x1b[31m\r\n\t\u2028\u202e"
NUMBERS = st.sampled_from(
    [
        0.0,
        -0.0,
        math.nan,
        math.inf,
        -math.inf,
        5e-324,
        1e-308,
        1e-160,
        1e-30,
        1e-12,
        0.5,
        1.0,
        -1.0,
        math.pi,
        math.nextafter(math.pi, 4),
        1e3,
        1e9,
        -1e9,
        1e30,
        -1e30,
        1e308,
    ]
)
ANY_NUMBER = NUMBERS | st.floats() | st.integers(-(2**63), 2**63 - 1)
SIZES = st.builds(lambda sign, n: sign * 10.0**n, st.sampled_from([1, -1]), st.floats(-40, 32))
TEXTS = st.text(max_size=8) | st.just(CONTROL * 100_000) | st.sampled_from(["", "slow", "fast"])
SCALARS = ANY_NUMBER | TEXTS | st.booleans()
LISTS = st.lists(ANY_NUMBER.map(float), max_size=5) | st.lists(st.booleans(), max_size=4)
LISTS |= st.lists(st.text(max_size=3), max_size=4) | st.just([math.nan] * 100_000)
VALUES = SCALARS | LISTS | st.none()


def examples_of(count):
    """Settings for so many examples, each of which may be large or take long."""
    return settings(max_examples=count, suppress_health_check=list(HealthCheck))


def assert_one_answer(text):
    """Assert it of an answer to a start or kick: the longest of 18 000 random ones has 874."""
    assert_one_sentence(text, longest=1000)


def assert_one_sentence(text, longest=700):
    """Assert that a text is a printable line of limited length."""
    assert text
    assert text.isprintable()
    assert len(text) <= longest
