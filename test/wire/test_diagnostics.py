import contextlib

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import serialize_message

from symtop_ros.wire.cdr import DecodeError
from symtop_ros.wire.diagnostics import statuses

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
    found = statuses(serialize_message(message))
    assert [(each.name, each.message, dict(each.values)) for each in found] == given_statuses
    assert all(each.stamp == 3_000_000_004 and each.level == 1 for each in found)


@given(st.binary(max_size=200))
def test_any_other_bytes_are_refused_or_read_and_never_end_badly(data):
    with contextlib.suppress(DecodeError):
        assert isinstance(statuses(b"\0\1\0\0" + data), list)
