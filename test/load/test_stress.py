"""The node under loads, in a small form: what is lost is asserted, never a rate."""

import pytest

from workshop.load import stress
from workshop.load.stress import HEAD, Outcome, format_row
from workshop.speed.publish import find_section

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


def test_the_outcomes_are_written_into_the_documents(docs, monkeypatch, capsys):
    outcomes = [
        Outcome("a load", 200.04, 0, 3, 0.123, 1.26, figures="9 calls/s"),
        Outcome("another", 1000.0, 2, 0, 0.5, 0.0, unanswered=1),
    ]
    monkeypatch.setattr(stress, "stress", lambda _: iter(outcomes))
    page = docs / "reliability_tables.md"
    page.write_text(f"# T\n\n<!-- figures: {stress.NAME} -->\n<!-- end of figures -->\n")
    assert stress.main(["--docs", str(docs), "--seconds", "2"]) == 1
    assert capsys.readouterr().out.splitlines() == [HEAD, *map(format_row, outcomes)]
    conditions, table, figures = find_section(page.read_text(), stress.NAME).split("\n\n")
    assert "2 s" in conditions.splitlines()[0]
    assert [line.split(" | ")[1:] for line in table.splitlines()[2:]] == [
        ["200.0", "0", "3", "0", "12 %", "1.3 |"],
        ["1000.0", "2", "0", "1", "50 %", "0.0 |"],
    ]
    assert figures == "- a load: 9 calls/s."


def test_lost_samples_and_unanswered_requests_are_not_good(monkeypatch, capsys):
    good = Outcome("a load", 200.0, 0, 3, 0.1, 0.0)
    assert good.good
    lossy = Outcome("another", 200.0, 1, 0, 0.1, 0.0)
    assert not lossy.good
    assert not Outcome("a third", 200.0, 0, 0, 0.1, 0.0, unanswered=1).good
    monkeypatch.setattr(stress, "stress", lambda _: iter([good, lossy]))
    assert stress.main([]) == 1
    assert capsys.readouterr().out.splitlines() == [HEAD, format_row(good), format_row(lossy)]
