import contextlib

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from symtop_ros.wire.diagnostics import ERROR, OK, WARN, Status, decode_statuses, encode_statuses
from symtop_ros.wire.layout import DecodeError

TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)


@given(st.lists(st.tuples(TEXT, TEXT, st.dictionaries(TEXT, TEXT, max_size=4)), max_size=3))
def test_what_rclpy_writes_is_read(given_statuses):
    message = DiagnosticArray()
    message.header.stamp.sec, message.header.stamp.nanosec = 3, 4
    for name, text, values in given_statuses:
        pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN, name=name, message=text, hardware_id="x", values=pairs
        )
        message.status.append(status)
    data = serialize_message(message)
    found = decode_statuses(data)
    assert [(each.name, each.message, dict(each.values)) for each in found] == given_statuses
    assert all(each.stamp == 3_000_000_004 and each.level == 1 for each in found)


LEVELS, VALUES = st.sampled_from([OK, WARN, ERROR]), st.dictionaries(TEXT, TEXT, max_size=4)
STATUSES = st.builds(Status, st.just(3_000_000_004), LEVELS, TEXT, TEXT, VALUES)


@given(TEXT, st.lists(STATUSES, max_size=3))
def test_what_is_written_is_what_rclpy_reads(frame, given_statuses):
    data = encode_statuses(3_000_000_004, frame, given_statuses)
    assert decode_statuses(data) == given_statuses
    message = deserialize_message(data, DiagnosticArray)
    assert message.header.frame_id == frame
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (3, 4)
    told = [
        (each.name, each.message, {pair.key: pair.value for pair in each.values}, each.level[0])
        for each in message.status
    ]
    assert told == [(each.name, each.message, each.values, each.level) for each in given_statuses]


@given(st.binary(max_size=200))
def test_any_other_bytes_are_refused_or_read_and_never_end_badly(data):
    with contextlib.suppress(DecodeError):
        assert isinstance(decode_statuses(b"\0\1\0\0" + data), list)
