"""Arbitrary parameter messages, most of them invalid."""

from hypothesis import strategies as st
from odd_values import CONTROL, NUMBERS, SIZES, TEXTS
from rcl_interfaces.msg import Parameter, ParameterValue

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


@st.composite
def parameters(draw, names):
    """Parameter messages with some names, repeated or unknown ones too, and any values."""
    chosen = draw(st.lists(st.sampled_from([*names, CONTROL, ""]), max_size=3))
    return [_parameter(name, *draw(st.one_of(FIELDS))) for name in chosen]


def _parameter(name, kind, field, value):
    return Parameter(name=name, value=ParameterValue(type=kind, **{field: value}))
