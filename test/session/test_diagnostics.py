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
    simulation = SimpleNamespace(
        factor=1.0,
        segment=SimpleNamespace(running=True),
        settings=SimpleNamespace(real_time_factor=1.0),
        ticker=SimpleNamespace(late=2, missed=3),
    )
    status = _pace_status(simulation)
    assert (status.level, status.message) == (WARN, "3 ticks missed")
