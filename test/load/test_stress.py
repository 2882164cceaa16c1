"""The node under loads, in a small form: what is lost is asserted, never a rate."""

import pytest
from machine_time import measuring
from programs import execute

from symtop_ros.run.simulation.block import CATCH_UP
from workshop.load import calls, soak, stress
from workshop.load.processes import script
from workshop.load.stress import HEAD, Outcome


@pytest.mark.long
def test_under_load_nothing_is_lost_and_every_request_is_answered(capsys, monkeypatch):
    for name, number in {"CLIENTS": 2, "SUBSCRIBERS": 20, "JOINERS": 20, "TOPS": 2}.items():
        monkeypatch.setattr(stress, name, number)
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


def test_lost_samples_and_unanswered_requests_are_not_good():
    assert Outcome("a load", 200.0, 0, 3, 0.1, 0.0).good
    assert not Outcome("another", 200.0, 1, 0, 0.1, 0.0).good
    assert not Outcome("a third", 200.0, 0, 0, 0.1, 0.0, unanswered=1).good


SECONDS = 6
GROWTH = 4.0  # MB; pools of the allocator take this much after ten seconds, however long it runs
BALANCE = 1e-13  # J, of an energy of some J: 1e-15 of it in a stretch, and a factor for kicks


@pytest.mark.long
def test_at_full_rate_nothing_is_lost_and_every_log_is_what_its_events_say():
    result = execute(script("soak", "--seconds", SECONDS), timeout=SECONDS + 120)
    warnings = result.stderr.splitlines()
    # the machine may be too busy for the node, which warns of it
    assert [line for line in warnings if " missed in " not in line] == []
    assert result.returncode == 0
    head, *rows = result.stdout.splitlines()
    assert head == soak.HEAD
    first, *_, last = (list(map(float, line.split())) for line in rows)
    _, samples, lost, requests, _, missed, dropped, _, growth, files, balance, logs, wrong, _ = last
    assert (lost, dropped, wrong) == (0, 0, 0)
    # what is late by less has not been sent and is not missed
    assert samples + missed > 1000 * (SECONDS - CATCH_UP)
    assert requests > SECONDS / 2
    assert logs == 1
    assert files <= first[9]
    assert growth < GROWTH
    assert balance < BALANCE


@pytest.mark.realtime
def test_a_line_comes_in_time_and_a_log_is_checked_as_soon_as_it_is_finished(monkeypatch, capsys):
    for name, value in {"LOG_DURATION": 1.5, "LINE_INTERVAL": 1.0}.items():
        monkeypatch.setattr(soak, name, value)
    with measuring() as machine:
        assert soak.main(["--seconds", "5", "--scene", "cusps", "--rate", "200"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == soak.HEAD
    logs = [int(line.split()[-3]) for line in rows]
    assert logs == sorted(logs)
    machine.demand(0.5)
    assert len(logs) >= 5
    assert logs[-1] >= 2


@pytest.mark.realtime
def test_every_call_is_answered(capsys):
    assert calls.main(["--seconds", "2"]) in (0, 1)  # 1: one has taken a second
    _, row = capsys.readouterr().out.splitlines()
    assert int(row.split()[0]) > 0
