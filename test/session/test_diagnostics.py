from types import SimpleNamespace

import pytest

from symtop_ros.session.diagnostics import _log_status, _pace_status
from symtop_ros.wire.diagnostics import OK, WARN


def test_dropped_messages_are_a_warning():
    recorder = SimpleNamespace(path="a.mcap", dropped=7, failure="", running=True)
    status = _log_status(recorder)
    assert (status.level, status.values["dropped"]) == (WARN, "7")
    recorder.dropped = 0
    assert _log_status(recorder).level == OK


@pytest.mark.parametrize(("missed", "level"), [(3, OK), (19, OK), (20, WARN)])
def test_missed_ticks_are_a_warning_if_they_are_a_tenth_of_a_second(missed, level):
    simulation = SimpleNamespace(
        factor=1.0,
        segment=SimpleNamespace(running=True),
        settings=SimpleNamespace(real_time_factor=1.0),
        ticker=SimpleNamespace(late=2, missed=missed, rate=200.0),
    )
    status = _pace_status(simulation)
    assert (status.level, status.message) == (level, f"{missed} ticks missed")
