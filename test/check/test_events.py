"""Each event of a log is the one that follows from the event before it, to the last letter."""

import random
from dataclasses import replace

import pytest
from trials import seeds

from symtop_ros.check.events import NOTHING, Mismatch, find_mismatches, is_of_this_version
from symtop_ros.log.reader import McapFile
from symtop_ros.log.top_log import TopLog

# Not said elsewhere in a log: the scene's name, the paths of logs, the frame of /tf, whether
# another version wrote it, and why a torque changed. `GIVEN` is of the first event.
GIVEN = ("top", "friction", "applied_torque", "gravity", "motion.", "imu.", "magnetic_field.")
FREE = (
    *("request.scene", "outcome.path", "top_frame", "version", "kernel_version"),
    *("number", "format"),
)


@pytest.fixture(scope="module")
def events(path):
    return list(TopLog(McapFile(path)).events())


def alter(rng, text):
    """A text with another letter or digit at one place."""
    places = [place for place, letter in enumerate(text) if letter.isalnum()]
    place = rng.choice(places)
    letters = "0123456789" if text[place].isdigit() else "abcdefgh"
    other = rng.choice([letter for letter in letters if letter != text[place]])
    return text[:place] + other + text[place + 1 :]


def found(before, event):
    """The mismatches of one event, or the reason why it cannot be read."""
    try:
        event.segment()
        return list(find_mismatches([*before, event]))
    except ValueError as error:  # as in `decode_events`
        return [error]


def test_events_of_every_kind_are_those_that_follow(events):
    assert {event.name for event in events} == {
        *("start", "reset", "kick", "push", "pause", "resume", "step", "torque", "parameters"),
        *("clock", "record"),
    }
    assert list(find_mismatches(events)) == []
    assert all(map(is_of_this_version, events))


@pytest.mark.parametrize("seed", seeds(1, 20))
def test_an_altered_digit_or_letter_of_a_value_is_found(events, seed):
    rng = random.Random(seed)
    for place, event in enumerate(events):
        before = events[max(0, place - 1) : place]
        for key in event.values:
            if key in FREE or not any(map(str.isalnum, event.values[key])):
                continue
            if key == "outcome.kind" and event.name in ("torque", "record"):
                continue
            if not place and key.startswith(GIVEN):  # the samples are compared with these
                continue
            if event.name == "start" and key.startswith("request."):  # parameters give the rest
                continue
            values = {**event.values, key: alter(rng, event.values[key])}
            assert found(before, replace(event, values=values)), (event.name, key, values[key])


def test_an_altered_name_or_sentence_is_found(events):
    rng = random.Random(2)
    for place, event in enumerate(events):
        before = events[max(0, place - 1) : place]
        if event.name != "record":  # its sentence has the path
            (one,) = found(before, replace(event, verdict=alter(rng, event.verdict)))
            assert (one.field, one.expected) == ("message", event.verdict)
        assert found(before, replace(event, name=alter(rng, event.name)))
        key = rng.choice([each for each in event.values if each not in FREE])
        values = {
            alter(rng, name) if name == key else name: event.values[name] for name in event.values
        }
        assert found(before, replace(event, values=values)), (event.name, key)


def test_a_kick_that_no_node_grants_is_found(events):
    place = next(place for place, event in enumerate(events) if event.name == "kick")
    values = {**events[place].values, "request.angular_impulse": "0.0 0.0 1.0"}
    (one,) = found(events[place - 1 : place], replace(events[place], values=values))
    assert one.field == "request"
    assert one.expected.startswith("a request must have one of precession_rate")


def test_a_field_that_is_missing_and_one_too_many_are_named(events):
    kick = events[2]
    values = {**kick.values, "mass": "1.0"}
    del values["engine"]
    assert found(events[1:2], replace(kick, values=values)) == [
        Mismatch("events", kick.stamp, "engine", "closed form", NOTHING),
        Mismatch("events", kick.stamp, "mass", NOTHING, "1.0"),
    ]


def test_after_a_missing_event_only_what_an_event_says_of_itself_is_judged(events):
    last = next(event for event in events if event.name == "resume")
    wrong = {**last.values, "before.orientation": "1.0 0.0 0.0 0.0"}
    assert found(events[:2], replace(last, values=wrong)) == []
    wrong = {**last.values, "after.orientation": "1.0 0.0 0.0 0.0"}
    assert found(events[:2], replace(last, values=wrong)) != []


def test_events_of_another_version_are_not_judged(events):
    wrong = replace(events[0], verdict="?")
    assert found([], wrong)
    assert not found([], replace(wrong, values={**wrong.values, "version": "0.0"}))
