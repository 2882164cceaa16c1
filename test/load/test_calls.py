"""Times of top_ctl, in a small form: that calls are answered is asserted, never a time."""

import pytest

from workshop.load import calls
from workshop.load.calls import HEAD, format_row


def test_calls_that_take_a_second_are_counted(monkeypatch, capsys):
    assert format_row([0.5, 0.6, 0.7, 1.5]).split() == ["4", "0.50", "0.65", "1.48", "1.50", "3"]
    for times, status in (([0.5, 0.9], 0), ([0.5, 1.0], 1)):
        monkeypatch.setattr(calls, "measure", lambda _, times=times: times)
        assert calls.main([]) == status
        assert capsys.readouterr().out.splitlines() == [HEAD, format_row(times)]


@pytest.mark.realtime
def test_every_call_is_answered():
    times = calls.measure(2.0)
    assert times
    assert min(times) > 0
