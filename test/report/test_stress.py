"""The node under loads, in a small form: what is lost is asserted, never a rate."""

import pytest

from symtop_ros.report import main as report
from symtop_ros.report import stress
from symtop_ros.report.stress import HEAD, Outcome, row


@pytest.fixture
def few(monkeypatch):
    for name, number in {"CLIENTS": 2, "SUBSCRIBERS": 20, "JOINERS": 20, "TOPS": 2}.items():
        monkeypatch.setattr(stress, name, number)


@pytest.mark.usefixtures("few")
def test_under_load_nothing_is_lost_and_everybody_is_answered(capsys):
    assert report.main(["--stress", "--seconds", "0.5"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == HEAD
    assert [line[:9] for line in rows] == [
        *("2 clients", "20 subscr", "a subscri", "20 late j", "2 tops in")
    ]
    cut = len(f"{'':42}")
    for line in rows:
        rate, lost, _, unanswered, *_ = line[cut:].split()
        assert float(rate) > 0
        assert (lost, unanswered) == ("0", "0")


def test_what_is_lost_or_not_answered_is_not_good(monkeypatch, capsys):
    fine = Outcome("a load", 200.0, 0, 3, 0.1, 0.0)
    assert fine.good
    lossy = Outcome("another", 200.0, 1, 0, 0.1, 0.0)
    assert not lossy.good
    assert not Outcome("a third", 200.0, 0, 0, 0.1, 0.0, unanswered=1).good
    monkeypatch.setattr(stress, "stress", lambda _: iter([fine, lossy]))
    assert report.main(["--stress"]) == 1
    assert capsys.readouterr().out.splitlines() == [HEAD, row(fine), row(lossy)]
