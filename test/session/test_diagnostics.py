from types import SimpleNamespace

import pytest

from symtop_ros.session.diagnostics import _log_status, _pace_status
from symtop_ros.wire.diagnostics import ERROR, OK, WARN


def test_a_recording_that_failed_is_an_error_with_its_reason():
    status = _log_status(SimpleNamespace(path="a", dropped=7, failure="a: no space", running=False))
    assert (status.level, status.message) == (ERROR, "a: no space")


@pytest.mark.parametrize(
    ("kept", "running", "level", "achieved"),
    [(2.0, True, OK, "2.0"), (0.5, True, WARN, "0.5"), (2.0, False, OK, "0.0")],
)
def test_a_motion_that_is_slowed_down_is_a_warning(kept, running, level, achieved):
    simulation = SimpleNamespace(
        factor=kept,
        segment=SimpleNamespace(running=running),
        settings=SimpleNamespace(real_time_factor=2.0),
        ticker=SimpleNamespace(late=2, missed=0, rate=200.0),
    )
    status = _pace_status(simulation)
    assert (status.level, status.values["real_time_factor.achieved"]) == (level, achieved)
    assert ("too fast for the compute budget" in status.message) == (kept < 2.0)


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
