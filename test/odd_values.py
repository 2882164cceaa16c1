"""Values of which most are wrong: for tests that throw them at everything that takes values."""

import math

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import Parameter, ParameterValue

CONTROL = "\x1b[31m\r\n\t\u2028\u202e"
NUMBERS = st.sampled_from(
    [
        *(0.0, -0.0, math.nan, math.inf, -math.inf, 5e-324, 1e-308, 1e-160, 1e-30, 1e-12),
        *(0.5, 1.0, -1.0, math.pi, math.nextafter(math.pi, 4), 1e3, 1e9, -1e9, 1e30, -1e30, 1e308),
    ]
)
ANY_NUMBER = NUMBERS | st.floats() | st.integers(-(2**63), 2**63 - 1)
SIZES = st.builds(
    lambda sign, digits: sign * 10.0**digits, st.sampled_from([1, -1]), st.floats(-40, 32)
)
TEXTS = st.text(max_size=8) | st.just(CONTROL * 100_000) | st.sampled_from(["", "slow", "fast"])
SCALARS = ANY_NUMBER | TEXTS | st.booleans()
LISTS = (
    st.lists(ANY_NUMBER.map(float), max_size=5)
    | st.lists(st.booleans(), max_size=4)
    | st.lists(st.text(max_size=3), max_size=4)
    | st.just([math.nan] * 100_000)
)
VALUES = SCALARS | LISTS | st.none()
FIELDS = (  # of a ParameterValue, with their types
    st.tuples(st.just(1), st.just("bool_value"), st.booleans()),
    st.tuples(st.just(2), st.just("integer_value"), st.integers(-(2**63), 2**63 - 1)),
    st.tuples(st.just(3), st.just("double_value"), NUMBERS | st.floats() | SIZES),
    st.tuples(st.just(4), st.just("string_value"), TEXTS.map(lambda text: text.replace("\0", ""))),
    st.tuples(st.just(5), st.just("byte_array_value"), st.just([b"a", b"\xff", b"\0"])),
    st.tuples(st.just(6), st.just("bool_array_value"), st.lists(st.booleans(), max_size=4)),
    st.tuples(st.just(7), st.just("integer_array_value"), st.lists(st.integers(0, 9), max_size=4)),
    st.tuples(st.just(8), st.just("double_array_value"), st.lists(NUMBERS, max_size=4)),
    st.tuples(st.just(9), st.just("string_array_value"), st.lists(st.just(CONTROL), max_size=3)),
    st.tuples(st.sampled_from([0, 10, 77, 255]), st.just("double_value"), st.just(1.0)),
)


def deterministic(examples):
    """The same examples at every run, whatever the time they take."""
    return settings(
        max_examples=examples,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


@st.composite
def parameters(draw, names):
    """Parameter messages of some names and any values; names may come twice, or be unknown."""
    chosen = draw(st.lists(st.sampled_from([*names, CONTROL, ""]), max_size=3))
    return [_parameter(name, *draw(st.one_of(FIELDS))) for name in chosen]


def _parameter(name, kind, field, value):
    return Parameter(name=name, value=ParameterValue(type=kind, **{field: value}))


def assert_one_sentence(text, longest=700):
    """What is told is a line that can be printed, and not a long one."""
    assert text
    assert text.isprintable()
    assert len(text) <= longest
