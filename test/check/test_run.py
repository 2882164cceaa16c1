"""A whole check: what is missing is named, and nothing is judged by it."""

from dataclasses import replace
from pathlib import Path

import pytest
from trials import choose

from symtop_ros.check.run import check_run
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback.main import _check, main
from symtop_ros.simulation.events import decode_events
from symtop_ros.simulation.topics import SAMPLE_TOPICS


def without_events(memory, *numbers):
    """Take events out, as a recorder that loses messages does; return their stamps."""
    places = memory.places("/top/events")
    stamps = [memory.messages[place].log_time for place in places]
    lost = {places[number - 1] for number in numbers}
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    return stamps


@pytest.mark.parametrize("lost", [(3,), (4, 5, 6), (9,), (12, 13)])
def test_missing_events_are_named_and_what_follows_from_them_is_not_judged(memory, lost):
    stamps = without_events(memory, *lost)
    findings = check_run(TopLog(memory))
    assert findings.samples_agree
    assert findings.mismatches == []
    (text,) = findings.missing
    which = f"event {lost[0]} is" if len(lost) == 1 else f"events {lost[0]} to {lost[-1]} are"
    before, after = stamps[lost[0] - 2], stamps[lost[-1]]
    assert text.startswith(f"{which} missing, between {before} and {after} ns; ")
    assert sum(each.unjudged for each in findings.deviations.values()) > 0


def test_a_wrong_sample_before_the_gap_of_another_event_is_found(memory):
    without_events(memory, 9)
    place = memory.places("/top/orientation")[3]  # of the first event
    data = memory.messages[place].data
    memory.messages[place].data = data[:-8] + bytes(8)
    assert not check_run(TopLog(memory)).samples_agree


def test_a_log_of_an_earlier_version_opens_and_its_samples_agree(capsys):
    # Recorded by 0.3.0: every kind of event, a sensor, friction and an applied torque.
    assert main([str(Path(__file__).with_name("run_0.3.0.mcap")), "--check"]) == 0
    *rows, agree, words = capsys.readouterr().out.splitlines()
    assert len(rows) == len(SAMPLE_TOPICS) - 1  # a magnetometer came later
    assert all(row.endswith(" 38 samples, largest difference 0") for row in rows)
    assert agree == "the samples agree with the events"
    assert words == "15 events are of symtop_ros 0.3.0: their words and verdicts are not judged"


@pytest.mark.parametrize("number", choose(range(-1, 13), (0, 3, -1)))  # places of events
@pytest.mark.parametrize("field", ["top", "motion.stamp"])
def test_an_event_that_cannot_be_read_is_named_and_the_status_is_1(memory, number, field, capsys):
    message = memory.messages[memory.places("/top/events")[number]]
    (event,) = decode_events(message.data)
    message.data = replace(event, values={**event.values, field: "x"}).encode("world")
    assert _check(TopLog(memory)) == 1
    assert "top_replay: events: " in capsys.readouterr().err
