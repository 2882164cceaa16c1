from types import SimpleNamespace

from symtop_ros.node.diagnostics import _log, _pace
from symtop_ros.wire.diagnostics import OK, WARN


def test_messages_that_the_disk_was_too_slow_for_are_told():
    recorder = SimpleNamespace(path="a.mcap", dropped=7, failure="", running=True)
    status = _log(recorder)
    assert (status.level, status.message) == (WARN, "7 messages were too many for the disk")
    recorder.dropped = 0
    assert (_log(recorder).level, _log(recorder).message) == (OK, "recording")


def test_ticks_that_were_missed_are_told():
    segment = SimpleNamespace(factor=1.0, running=True)
    status = _pace(segment, 1.0, SimpleNamespace(late=2, missed=3))
    assert (status.level, status.message) == (WARN, "3 ticks missed")
