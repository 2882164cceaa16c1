"""The node under loads, in a small form: what is lost is asserted, never a rate."""

import pytest

from workshop.load import stress
from workshop.load.stress import HEAD, Outcome, format_row

pytestmark = pytest.mark.realtime


@pytest.fixture
def few(monkeypatch):
    for name, number in {"CLIENTS": 2, "SUBSCRIBERS": 20, "JOINERS": 20, "TOPS": 2}.items():
        monkeypatch.setattr(stress, name, number)


@pytest.mark.long
@pytest.mark.usefixtures("few")
def test_under_load_nothing_is_lost_and_every_request_is_answered(capsys):
    assert stress.main(["--seconds", "0.5"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == HEAD
    assert [line[:42].rstrip() for line in rows] == [
        "2 clients, 1000 Hz",
        "20 subscribers, 200 Hz",
        "a subscriber that is never spun, 1000 Hz",
        "20 late joiners, 1000 Hz",
        "2 tops in 2 namespaces, 200 Hz",
    ]
    for line in rows:
        rate, lost, _, unanswered, *_ = line[42:].split()
        assert float(rate) > 0
        assert (lost, unanswered) == ("0", "0")


def test_lost_samples_and_unanswered_requests_are_not_good(monkeypatch, capsys):
    good = Outcome("a load", 200.0, 0, 3, 0.1, 0.0)
    assert good.good
    lossy = Outcome("another", 200.0, 1, 0, 0.1, 0.0)
    assert not lossy.good
    assert not Outcome("a third", 200.0, 0, 0, 0.1, 0.0, unanswered=1).good
    monkeypatch.setattr(stress, "stress", lambda _: iter([good, lossy]))
    assert stress.main([]) == 1
    assert capsys.readouterr().out.splitlines() == [HEAD, format_row(good), format_row(lossy)]
