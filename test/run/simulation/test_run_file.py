"""Runs of the page: read, written, and taken from the events of a node."""

import json
import math
import re
from dataclasses import replace

import pytest
from run.simulation.page_runs import (
    KICK,
    change,
    find_refusal,
    list_hostile_runs,
    make_run,
    to_json,
)

from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.simulation.changes.follow import Act
from symtop_ros.run.simulation.changes.timeline import Timeline
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.simulation.run_file import RunRecorder, read_run, record_run
from symtop_ros.run.simulation.settings import Settings

SECOND = 1_000_000_000


def test_a_run_without_an_end_ends_with_its_last_event(tmp_path):
    path = tmp_path / "run.json"
    events = to_json(make_run())
    events[1]["request"] = "x" * TABLE["event"]["request"]["length"]  # the longest text
    path.write_text(json.dumps({"format": 1, "events": events}))
    assert read_run(path)[1] == 2222222212


NO_RUNS = [
    (b"\xff" * 100, "must be a run of the page"),
    ([], "must be a run of the page"),
    ({"format": 6, "events": []}, "must be a run of the page"),
    ({"format": 1, "events": []}, "events must be "),
    ({"format": 1, "events": [3]}, r"events\[0\]: kind must be "),
    (change(0, kind="torque"), r'events\[0\]: kind must be "start" for the first event, got '),
    (change(2, time=1.0), r"events\[2\]: time must be at least that of the previous event, "),
    (change(0, orientation=[2, 0, 0, 0]), r"events\[0\]: .*norm"),
    (change(0, angular_velocity=[math.inf, 0, 0]), r"events\[0\]: angular_velocity must be "),
    (change(0, top=[1, 3, 1]), r"events\[0\]: Iz must be "),
    (change(0, friction=[-1, 0]), r"events\[0\]: friction.axial must be "),
]


@pytest.mark.parametrize(("content", "message"), NO_RUNS)
def test_a_file_that_is_no_run_is_one_message(content, message, tmp_path):
    path = tmp_path / "run.json"
    path.write_bytes(content if isinstance(content, bytes) else json.dumps(content).encode())
    with pytest.raises(RefusedError, match=message):
        read_run(path)


@pytest.mark.parametrize(("name", "content"), list_hostile_runs())
def test_a_field_of_another_kind_is_refused_by_its_name(name, content):
    assert re.match(rf"events\[1\]: {name} must .*, got .*", find_refusal(content))


class Told:
    """Events of a timeline, with their numbers."""

    def __init__(self, **values):
        settings = Settings.from_scene("cusps", **values)
        self.timeline = Timeline.begin(settings, SECOND)
        self.events = []
        self.do(self.timeline.announce("cusps"))

    def act(self, name, stamp, request=None):
        self.do(self.timeline.follow(Act(name, stamp, request or {})))

    def do(self, timeline):
        self.timeline = timeline
        self.events.append(Event.of(timeline.change, len(self.events) + 1))


def test_impulses_and_rates_are_kept_as_they_were_asked_for():
    told = Told()
    acts = {"angular_impulse": [0.0, 1e-4, -0.1]}, {"precession_rate_change": 0.1}
    for seconds, act in zip((2, 3), acts, strict=True):
        told.act("kick", seconds * SECOND, act)
    values = {**told.events[1].values, "request.of a later version": "1", "request.hold": ""}
    told.events[1] = replace(told.events[1], values=values)
    events, _ = record_run(told.events, 3 * SECOND)
    assert [event.act for event in events] == [{}, *acts]
    assert [event.to_json()["hold"] for event in events[1:]] == [None, "spin_rate"]


def test_pushes_have_the_number_that_was_given_until_something_else_was_done():
    told = Told()
    pushes = {"axle_impulse": 1e-6, "rate": 20.0, "number": 20}
    for seconds in (2, 5):
        told.act("push", seconds * SECOND, pushes)
    told.act("kick", 5 * SECOND + SECOND // 3, KICK)
    events, _ = record_run(told.events, 7 * SECOND)
    assert [event.kind for event in events] == ["start", "push", "push", "kick"]
    assert [event.act.get("number") for event in events[1:3]] == [20, 7]
    assert events[1].act == pushes


def test_a_release_is_no_event_of_a_run_but_the_number_of_its_pushes():
    told = Told()
    told.act("push", 2 * SECOND, {"axle_impulse": 1e-6, "rate": 20.0, "number": 20})
    told.act("release", 2 * SECOND + SECOND // 3, {})
    told.act("kick", 4 * SECOND, KICK)
    events, end = record_run(told.events, 7 * SECOND)
    assert [(event.kind, event.time) for event in events[1:]] == [
        ("push", SECOND),
        ("kick", 3 * SECOND),
    ]
    assert (events[1].act["number"], end) == (7, 6 * SECOND)


def test_a_log_that_begins_in_the_middle_of_a_run_begins_with_a_start():
    told = Told()
    told.act("kick", 2 * SECOND, KICK)
    events, end = record_run(told.events[1:], 3 * SECOND)
    assert [(event.kind, event.time) for event in events] == [("start", 0)]
    assert end == SECOND
    assert RunRecorder().time_at(SECOND) == 0
    assert record_run([], SECOND) == ([], 0)
