"""A whole check: what is missing is named, and nothing is judged by it."""

import pytest
from check.run_log import Memory
from python_runs import run_python

from symtop_ros.check.run import check_run
from symtop_ros.log.top_log import TopLog


@pytest.fixture
def memory(path):
    return Memory.read(path)


def without_events(memory, *numbers):
    """Take events out, as a recorder that loses messages does; return their stamps."""
    places = memory.places("/top/events")
    stamps = [memory.messages[place].log_time for place in places]
    lost = {places[number - 1] for number in numbers}
    memory.messages = [each for k, each in enumerate(memory.messages) if k not in lost]
    return stamps


def test_a_whole_run_has_nothing_missing(memory):
    findings = check_run(TopLog(memory))
    assert findings.samples_agree
    assert (findings.missing, findings.mismatches, findings.damage) == ([], [], [])


def test_python_alone_checks_the_log_of_a_kernel_but_for_events_of_driven_motions(path):
    program = (
        "import sys; from pathlib import Path; from symtop_ros.log.reader import McapFile; "
        "from symtop_ros.log.top_log import TopLog; from symtop_ros.check.run import check_run; "
        "found = check_run(TopLog(McapFile(Path(sys.argv[1])))); "
        "assert found.foreign > 0; sys.exit(str(found.mismatches + found.damage))"
    )
    assert run_python(program, path, SYMTOP_PURE="1").stderr == "[]\n"


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
