"""Gaps and repetitions in a log are named; what a run leaves out by itself is not."""

from dataclasses import replace

import pytest
from log_files import Run

from symtop_ros.check.course import Course, _list_jumps
from symtop_ros.check.run import check_run
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback import main as module
from symtop_ros.simulation.events import MAX_STAMP
from symtop_ros.wire.diagnostics import decode_statuses, encode_statuses


def missing_in(memory):
    findings = check_run(TopLog(memory))
    assert findings.samples_agree
    assert findings.mismatches == []
    return findings.missing


@pytest.mark.parametrize("begin", [0.1, 0.5, 0.9])
def test_eighty_messages_that_are_missing_in_a_row_are_counted(memory, begin):
    samples = memory.places("/top/orientation")
    place = samples[int(begin * len(samples))]
    lost = {k for k in range(place, place + 80) if "event" not in name_of(memory, k)}
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    assert sum("samples are missing, most of them" in text for text in missing_in(memory)) > 0


def name_of(memory, place):
    return memory.channels[memory.messages[place].channel_id].topic


def test_every_message_twice_is_said_of_samples_and_events(memory):
    memory.messages = [each for message in memory.messages for each in (message, message)]
    events, *samples = missing_in(memory)
    count = len(memory.places("/top/events")) // 2
    assert events == f"{count} events are repeated"
    assert all(" samples are repeated" in text for text in samples)
    assert len(samples) > 0


@pytest.mark.parametrize("number", [0, 4, -1])
def test_an_event_twice_is_said(memory, number):
    place = memory.places("/top/events")[number]
    memory.messages.insert(place, replace(memory.messages[place]))
    assert missing_in(memory) == ["1 events are repeated"]


def test_only_an_event_right_after_itself_may_be_the_first_of_another_file(memory):
    first, second, *_ = TopLog(memory).events()
    assert list(Course([first, first, second]).list_repeated(allowed=1)) == []
    apart = Course([first, second, first])
    assert list(apart.list_repeated(allowed=1)) == ["1 events are repeated"]


def test_where_events_are_missing_anything_may_hold(memory):
    events = list(TopLog(memory).events())
    assert list(Course(events).list_unknown()) == []
    unknown = [(events[-1].stamp, MAX_STAMP)]
    assert list(Course(events, all_readable=False).list_unknown()) == unknown
    missing = [(events[2].stamp, events[4].stamp)]
    assert list(Course([*events[:3], *events[4:]]).list_unknown()) == missing


def test_a_beginning_that_is_missing_is_said_with_its_samples(tmp_path, capsys):
    run = Run()
    del run.messages[0]
    assert module.main([str(run.write(tmp_path)), "--check"]) == 1
    error = capsys.readouterr().err
    text = "200 samples are before the first event, which is number 2"
    assert error == f"top_replay: the beginning is missing: {text}\n"


def test_a_log_that_begins_in_the_middle_of_a_run_is_whole_and_says_so(tmp_path, capsys):
    run = Run()
    del run.messages[: run.places("events")[1]]
    assert module.main([str(run.write(tmp_path)), "--check"]) == 0
    assert "\nthe log begins with event 2 of the run\n" in capsys.readouterr().out


@pytest.mark.parametrize("counted", [20, 19])
def test_samples_that_the_node_has_counted_as_missed_are_no_error(memory, counted):
    lost = memory.places("/top/orientation")[30:50]
    before, after = (memory.messages[place].log_time for place in (lost[0], lost[-1]))
    last = memory.messages[memory.places("/diagnostics")[-1]]
    last.data = set_missed(last.data, counted)
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    expected = "orientation: 20 samples are missing, most of them between "
    expected += (
        f"{before - 5_000_000} and {after + 5_000_000} ns; the node has counted 19 as missed"
    )
    assert missing_in(memory) == ([expected] if counted == 19 else [])


def set_missed(data, count):
    """Diagnostics in which the node has missed so many samples."""
    statuses = [
        each._replace(values={**each.values, "missed": str(count)})
        if each.name == "top: pace"
        else each
        for each in decode_statuses(data)
    ]
    return encode_statuses(statuses[0].stamp, "world", statuses)


KINDS = (1, "ended"), (3, "begun"), (13, "ended")


def test_pauses_of_a_recording_have_no_samples(memory):
    """Random sessions have jumps, steps and times without /tf."""
    first = replace(next(TopLog(memory).events()), name="record")
    told = ((at, {"format": "3", "outcome.kind": kind}) for at, kind in KINDS)
    events = [replace(first, stamp=at, values=values) for at, values in told]
    assert list(_list_jumps(events)) == [(1, 3)]


def test_events_that_are_missing_are_named_by_their_numbers_also_by_hostile_ones(memory):
    first = next(TopLog(memory).events())
    later = [replace(first, values={"number": str(number)}) for number in (3, 10**12)]
    one, many = Course([first, *later]).list_missing()
    assert one.startswith("event 2 is missing, between ")
    assert many.startswith("events 4 to 999999999999 are missing, between ")


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
    assert module.main([*map(str, paths), "--check"]) == 0
