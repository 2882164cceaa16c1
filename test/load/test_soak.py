"""The node at 1000 Hz with friction, recording, kicked at random (`make -C workshop soak`)."""

import pytest
from programs import execute

from workshop.load import soak
from workshop.load.processes import script

pytestmark = pytest.mark.realtime
SECONDS = 6
GROWTH = 4.0  # MB; pools of the allocator take this much after ten seconds, however long it runs
BALANCE = 1e-13  # J, of an energy of some J: 1e-15 of it in a stretch, and a factor for kicks


@pytest.mark.long
def test_at_full_rate_nothing_is_lost_and_every_log_is_what_its_events_say():
    result = execute(script("soak", "--seconds", SECONDS), timeout=SECONDS + 120)
    warnings = result.stderr.splitlines()
    # the machine may be too busy for the node, which warns of it
    assert [line for line in warnings if "no samples for" not in line] == []
    assert result.returncode == 0
    head, *rows = result.stdout.splitlines()
    assert head == soak.HEAD
    first, *_, last = (list(map(float, line.split())) for line in rows)
    _, samples, lost, requests, _, missed, dropped, _, growth, files, balance, logs, wrong, _ = last
    assert (lost, dropped, wrong) == (0, 0, 0)
    assert samples + missed > 990 * SECONDS
    assert requests > SECONDS / 2
    assert logs == 1
    assert files <= first[9]
    assert growth < GROWTH
    assert balance < BALANCE


def test_a_line_comes_in_time_and_a_log_is_checked_as_soon_as_it_is_finished(monkeypatch, capsys):
    for name, value in {"LOG_DURATION": 1.5, "LINE_INTERVAL": 1.0}.items():
        monkeypatch.setattr(soak, name, value)
    assert soak.main(["--seconds", "5", "--scene", "cusps", "--rate", "200"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head == soak.HEAD
    logs = [int(line.split()[-3]) for line in rows]
    assert len(logs) >= 5
    assert logs[-1] >= 2
    assert logs == sorted(logs)


def test_a_reading_with_lost_samples_or_wrong_logs_is_not_good():
    assert soak.Reading(missed=3, late=5).good
    assert not any(soak.Reading(**{name: 1}).good for name in ("lost", "dropped", "wrong"))
    assert len(soak.format_row(soak.Reading())) == len(soak.HEAD)
