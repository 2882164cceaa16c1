"""The node at 1000 Hz under friction, recording, kicked at random: see test/conftest.py."""

import pytest

from symtop_ros.report import main as report
from symtop_ros.report import soak as soaking
from symtop_ros.report.soak import HEAD, Reading, row

GROWTH = 4.0  # MB; what pools of the allocator still take after ten seconds, however long it runs
BALANCE = 1e-13  # J, of an energy of some J: 1e-15 of it in a stretch, and a factor for kicks


@pytest.mark.beside
def test_at_full_rate_nothing_is_lost_and_every_log_is_what_its_events_say(soak):
    process, seconds = soak
    told, complaints = process.communicate(timeout=seconds + 120)
    told_of_gaps = [line for line in complaints.splitlines() if "no samples for" in line]
    assert complaints.splitlines() == told_of_gaps  # where the machine had no time for the node
    assert process.returncode == 0
    head, *rows = told.splitlines()
    assert head == HEAD
    first, *_, last = (list(map(float, line.split())) for line in rows)
    _, samples, lost, requests, _, missed, dropped, _, growth, files, balance, logs, wrong, _ = last
    assert (lost, dropped, wrong) == (0, 0, 0)
    assert samples + missed > 990 * seconds
    assert requests > seconds / 2
    assert logs >= seconds // 20
    assert files <= first[9]
    assert growth < GROWTH
    assert balance < BALANCE


def test_a_line_comes_in_time_and_a_log_is_checked_as_soon_as_it_is_finished(monkeypatch, capsys):
    for name, value in {"RATE": 200.0, "PART": 1.5, "LINE": 2.0, "WARM": 1.0}.items():
        monkeypatch.setattr(soaking, name, value)
    assert report.main(["--soak", "--seconds", "5"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == HEAD
    logs = [int(line.split()[-3]) for line in rows]
    assert len(logs) >= 3
    assert logs[-1] >= 2
    assert logs == sorted(logs)


def test_a_reading_that_lost_something_is_not_good():
    assert Reading(missed=3, late=5).good
    assert not any(Reading(**{name: 1}).good for name in ("lost", "dropped", "wrong"))
    assert len(row(Reading())) == len(HEAD)
