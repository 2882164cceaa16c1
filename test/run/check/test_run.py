"""A whole check: what is missing or repeated is named, and nothing is judged by it."""

from dataclasses import replace
from pathlib import Path

import pytest
from log_files import Run
from trials import choose

from symtop_ros.replay.check import check
from symtop_ros.replay.main import main
from symtop_ros.run.check.run import check_run
from symtop_ros.run.check.samples import Deviation
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.events import decode_events
from symtop_ros.run.simulation.topics import (
    DESCRIPTION,
    DIAGNOSTICS,
    EVENTS,
    SAMPLE_TOPICS,
    TF_STATIC,
)
from symtop_ros.run.wire.diagnostics import decode_statuses, encode_statuses


def without_events(memory, *numbers):
    """Take events out, as a recorder that loses messages does; return their stamps."""
    places = memory.places("/top/events")
    stamps = [memory.messages[place].log_time for place in places]
    lost = {places[number - 1] for number in numbers}
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    return stamps


def judge(memory):
    """The findings of a check in a log without a contradiction."""
    log = TopLog(memory)
    findings = check_run(log)
    assert findings.samples_agree
    assert findings.mismatches == []
    return log.catalog, findings


def test_all_messages_of_a_whole_run_are_compared_and_judged(memory):
    findings = judge(memory)[1]
    assert (findings.unjudged, findings.foreign) == (0, 0)
    assert set(findings.reasons) == {"clock", "markers", "applied_torque", "points"}  # not computed
    others = {EVENTS: "/top/events", DESCRIPTION: "/top/robot_description"}
    others |= {TF_STATIC: "/tf_static", DIAGNOSTICS: "/diagnostics"}
    expected = {each.name: len(memory.places(topic)) for each, topic in others.items()}
    assert findings.compared == expected
    assert min(expected.values()) > 0


def test_a_sample_that_is_not_judged_counts_for_whatever_reason(memory):
    findings = check_run(TopLog(memory))
    for reasons, count in (((1, 0, 0), 1), ((0, 2, 0), 2), ((0, 0, 4), 4), ((1, 2, 4), 7)):
        unjudged, unchecked, unreached = reasons
        one = Deviation(unjudged=unjudged, unchecked=unchecked, unreached=unreached)
        found = replace(findings, deviations={"torque": one, "tf": Deviation(samples=8)})
        assert found.unjudged == count


def test_diagnostics_from_before_an_event_may_follow_it_in_the_log(memory):
    """As where a log has its events first."""
    moved = 0
    for place in memory.places("/top/events"):
        event = memory.messages[place]
        for before in memory.places("/diagnostics"):
            if before < place and memory.messages[before].log_time == event.log_time:
                memory.messages.insert(before, memory.messages.pop(place))
                moved += 1
                break
    assert moved >= 2
    compared = len(memory.places("/diagnostics"))
    assert judge(memory)[1].compared[DIAGNOSTICS.name] == compared


@pytest.mark.parametrize("lost", [(3,), (4, 5, 6), (9,), (12, 13)])
def test_missing_events_are_named_and_what_follows_from_them_is_not_judged(memory, lost):
    stamps = without_events(memory, *lost)
    catalog, findings = judge(memory)
    (text,) = catalog.problems
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
    out, err = capsys.readouterr()
    assert "topics are recognised by their types" in err
    agree, words, *rows = out.splitlines()
    compared = [row for row in rows if " 38 samples, largest difference " in row]
    assert len(compared) == len(SAMPLE_TOPICS) - 1  # a magnetometer came later
    assert agree == "the samples agree with the events"
    assert words == "15 events are of symtop_ros 0.3.0: their words and verdicts are not judged"


@pytest.mark.parametrize("number", choose(range(-1, 13), (0, -1)))  # places of events
@pytest.mark.parametrize("field", ["top", "motion.stamp"])
def test_an_event_that_cannot_be_read_is_named_and_the_status_is_1(memory, number, field, capsys):
    message = memory.messages[memory.places("/top/events")[number]]
    (event,) = decode_events(message.data)
    message.data = replace(event, values={**event.values, field: "x"}).encode("world")
    log = TopLog(memory)
    assert check(log) == 1
    assert any(text.startswith("events: ") for text in log.catalog.problems)
    assert "DO NOT" not in capsys.readouterr().out


def test_every_message_twice_is_said_of_samples_and_events(memory):
    memory.messages = [each for message in memory.messages for each in (message, message)]
    events, *samples = judge(memory)[0].problems
    count = len(memory.places("/top/events")) // 2
    assert events == f"{count} events are repeated"
    assert all(" samples are repeated" in text for text in samples)
    assert len(samples) > 0


@pytest.mark.parametrize("number", [0, 4, -1])
def test_an_event_twice_is_said(memory, number):
    place = memory.places("/top/events")[number]
    memory.messages.insert(place, replace(memory.messages[place]))
    assert judge(memory)[0].problems == ("1 event is repeated",)


def test_a_beginning_that_is_missing_is_said_with_its_samples(tmp_path, capsys):
    run = Run()
    del run.messages[0]
    assert main([str(run.write(tmp_path)), "--check"]) == 1
    error = capsys.readouterr().err
    text = "200 samples are before the first event, which is number 2"
    assert error == f"top_replay: the beginning is missing: {text}\n"


def test_a_log_that_begins_in_the_middle_of_a_run_is_whole_and_says_so(tmp_path, capsys):
    run = Run()
    del run.messages[: run.places("events")[1]]
    assert main([str(run.write(tmp_path)), "--check"]) == 0
    assert "\nthe log begins with event 2 of the run\n" in capsys.readouterr().out


PERIOD = 5_000_000  # ns


@pytest.mark.parametrize("counted", [20, 19])
def test_samples_that_the_node_has_counted_as_missed_are_no_error(memory, counted):
    lost = memory.places("/top/orientation")[30:50]
    before, after = (memory.messages[place].log_time for place in (lost[0], lost[-1]))
    last = memory.messages[memory.places("/diagnostics")[-1]]
    last.data = set_missed(last.data, counted)
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    expected = "orientation: 20 samples are missing, between "
    expected += f"{before - PERIOD} and {after + PERIOD} ns; the node has counted 19 as missed"
    assert judge(memory)[0].problems == ((expected,) if counted == 19 else ())


def test_in_a_log_that_names_no_rate_the_first_samples_say_the_period(tmp_path):
    run = Run(hurried=False)
    lost = run.places("torque")[30:50]
    run.messages = [each for k, each in enumerate(run.messages) if k not in lost]
    (found,) = run.open(tmp_path).catalog.problems
    assert found.startswith("torque: 20 samples are missing, ")


def set_missed(data, count):
    """Diagnostics in which the node has missed so many samples."""
    statuses = {each.name: each for each in decode_statuses(data)}
    pace = statuses["top: pace"]
    statuses["top: pace"] = pace._replace(values={**pace.values, "missed": str(count)})
    return encode_statuses(pace.stamp, "world", [*statuses.values()])


def test_two_files_of_one_run_share_an_event_and_lose_nothing(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    run = Run()
    kick = run.places("events")[1]
    whole = run.messages
    run.messages = whole[: kick + 60]
    paths = [run.write(first)]
    # Every file begins with the last event, stamped like its first sample.
    run.messages = [whole[kick], *whole[kick + 60 :]]
    paths.append(run.write(second))
    assert main([*map(str, paths), "--check"]) == 0
