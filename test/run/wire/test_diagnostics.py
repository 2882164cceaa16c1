import contextlib
from dataclasses import dataclass
from typing import Literal, Optional

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from symtop_ros.run.wire.diagnostics import (
    ERROR,
    MAX_RECORDS,
    OK,
    WARN,
    Status,
    decode_statuses,
    encode_statuses,
    read_fields,
    write_fields,
)
from symtop_ros.run.wire.layout import DecodeError

TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)


LEVELS = st.sampled_from([OK, WARN, ERROR])
VALUES = st.dictionaries(TEXT, TEXT, max_size=4)
STATUSES = st.builds(Status, st.just(3_000_000_004), LEVELS, TEXT, TEXT, VALUES)


@given(TEXT, TEXT, st.lists(STATUSES, max_size=3))
def test_rclpy_reads_what_is_written_and_what_rclpy_writes_is_read(frame, hardware, given_statuses):
    data = encode_statuses(3_000_000_004, frame, given_statuses, hardware)
    assert decode_statuses(data) == given_statuses
    message = deserialize_message(data, DiagnosticArray)
    assert message.header.frame_id == frame
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (3, 4)
    told = [
        (each.name, each.message, {pair.key: pair.value for pair in each.values}, each.level[0])
        for each in message.status
    ]
    assert told == [(each.name, each.message, each.values, each.level) for each in given_statuses]
    assert {each.hardware_id for each in message.status} <= {hardware}
    assert decode_statuses(serialize_message(message)) == given_statuses


@given(st.binary(max_size=200))
def test_any_other_bytes_are_refused_or_read_and_never_end_badly(data):
    with contextlib.suppress(DecodeError):
        assert isinstance(decode_statuses(b"\0\1\0\0" + data), list)


@dataclass(frozen=True)
class Inner:
    """A record in a record."""

    number: float
    word: Literal["slow", "fast"] | None = None


@dataclass(frozen=True)
class Outer:
    """A field of each kind."""

    number: float
    count: int
    flag: bool
    text: str
    word: Literal["a", "b"]
    maybe: float | None
    perhaps: Optional[float]  # noqa: UP045 - the older way to write a union
    vector: tuple[float, float, float]
    many: tuple[float, ...]
    words: tuple[Literal["slow", "fast"], ...]
    inner: Inner
    other: Inner | None
    several: tuple[Inner, ...]


NUMBERS = st.floats(allow_nan=False)
INNER = st.builds(Inner, NUMBERS, st.sampled_from(["slow", "fast", None]))
OUTER = st.builds(
    Outer,
    number=NUMBERS,
    count=st.integers(),
    flag=st.booleans(),
    text=st.text(),
    word=st.sampled_from("ab"),
    maybe=NUMBERS | st.none(),
    perhaps=NUMBERS | st.none(),
    vector=st.tuples(NUMBERS, NUMBERS, NUMBERS),
    many=st.lists(NUMBERS, max_size=3).map(tuple),
    words=st.lists(st.sampled_from(["slow", "fast"]), max_size=3).map(tuple),
    inner=INNER,
    other=INNER | st.none(),
    several=st.lists(INNER, min_size=1, max_size=3).map(tuple),
)
ONE = Outer(0.5, 3, True, "x", "a", None, 1.0, (1.0, 2.0, 3.0), (), (), Inner(1.0), None, ())


@given(OUTER)
def test_a_record_reads_back_from_its_fields(record):
    assert read_fields("all", Outer, write_fields("all", record)) == record


def test_fields_have_the_names_of_their_records_and_what_is_none_is_left_out():
    fields = write_fields("all", ONE)
    assert fields["all.inner.number"] == "1.0"
    assert fields["all.vector"] == "1.0 2.0 3.0"
    assert (fields["all.flag"], fields["all.many"]) == ("true", "")
    assert not {"all.maybe", "all.inner.word", "all.other"} & set(fields)
    pair = write_fields("all", (Inner(1.0), Inner(2.0, "fast")))
    assert pair == {"all.0.number": "1.0", "all.1.number": "2.0", "all.1.word": "fast"}


WRONG = [
    ("all.number", None, "all.number must be given, got nothing"),
    ("all.number", "much", "could not convert string to float"),
    ("all.flag", "True", "all.flag must be one of true, false, got 'True'"),
    ("all.word", "c", "all.word must be one of a, b, got 'c'"),
    ("all.vector", "1.0 2.0", "all.vector must have 3 elements, got 2"),
    ("all.words", "slow slower", "all.words must be one of slow, fast, got 'slower'"),
    ("all.other.word", "fast", "all.other.number must be given, got nothing"),
]


@pytest.mark.parametrize(("name", "text", "reason"), WRONG)
def test_a_field_that_is_missing_or_not_of_its_type_is_refused_by_its_name(name, text, reason):
    fields = {**write_fields("all", ONE), name: text}
    with pytest.raises(ValueError, match=f"^{reason}"):
        read_fields("all", Outer, {key: each for key, each in fields.items() if each is not None})


def test_of_records_in_a_tuple_a_hundred_are_read_at_most_and_up_to_a_gap():
    fields = write_fields("all", tuple(Inner(float(k)) for k in range(MAX_RECORDS + 1)))
    read = read_fields("one", Several, {f"one.several{k[3:]}": v for k, v in fields.items()})
    assert [each.number for each in read.several] == list(range(MAX_RECORDS))
    gap = {"one.several.0.number": "1.0", "one.several.2.number": "3.0"}
    assert read_fields("one", Several, gap) == Several((Inner(1.0),))


@dataclass(frozen=True)
class Several:
    """Records in a tuple."""

    several: tuple[Inner, ...]
