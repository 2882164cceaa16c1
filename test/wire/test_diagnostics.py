import contextlib

from diagnostic_msgs.msg import DiagnosticArray
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from symtop_ros.wire.diagnostics import ERROR, OK, WARN, Status, decode_statuses, encode_statuses
from symtop_ros.wire.layout import DecodeError

TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)


LEVELS, VALUES = st.sampled_from([OK, WARN, ERROR]), st.dictionaries(TEXT, TEXT, max_size=4)
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
