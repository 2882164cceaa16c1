from types import SimpleNamespace

from symtop_ros.session.diagnostics import _log_status, _pace_status
from symtop_ros.wire.diagnostics import OK, WARN


def test_dropped_messages_are_a_warning():
    recorder = SimpleNamespace(path="a.mcap", dropped=7, failure="", running=True)
    status = _log_status(recorder)
    assert (status.level, status.message) == (WARN, "7 messages dropped: the disk is too slow")
    recorder.dropped = 0
    assert (_log_status(recorder).level, _log_status(recorder).message) == (OK, "recording")


def test_missed_ticks_are_a_warning():
    segment = SimpleNamespace(factor=1.0, running=True)
    status = _pace_status(segment, 1.0, SimpleNamespace(late=2, missed=3))
    assert (status.level, status.message) == (WARN, "3 ticks missed")
