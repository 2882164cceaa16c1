"""Each event follows from the one before it, to the last letter, and texts from the events."""

import random
from dataclasses import replace

import pytest
from trials import seeds

from symtop_ros import __version__
from symtop_ros.run.check.events import find_mismatches
from symtop_ros.run.check.mismatch import NOTHING, Mismatch, is_of_this_version
from symtop_ros.run.check.run import check_messages
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.wire.diagnostics import decode_statuses
from symtop_ros.run.wire.layout import Reader

pytestmark = pytest.mark.numbers

# Not said elsewhere in a log: the scene's name, the paths of logs, the frame of /tf, whether
# another version wrote it, and why a torque changed. `GIVEN` is of the first event.
GIVEN = (
    "top",
    "friction",
    "applied_torque",
    "gravity",
    "mass",
    "motion.",
    "imu.",
    "magnetic_field.",
)
FREE = (
    "request.scene",
    "outcome.path",
    "top_frame",
    "version",
    "kernel_version",
    "number",
    "format",
)


@pytest.fixture(scope="module")
def events(path):
    return list(TopLog(McapFile(path)).catalog.events)


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
        "start",
        "reset",
        "kick",
        "push",
        "pause",
        "resume",
        "step",
        "torque",
        "parameters",
        "clock",
        "record",
    }
    assert list(find_mismatches(events)) == []
    assert all(map(is_of_this_version, events))


@pytest.mark.slow
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
        values = {alter(rng, k) if k == key else k: text for k, text in event.values.items()}
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


def mismatches(memory):
    return check_messages(TopLog(memory))[1].mismatches


def swap(memory, place, data):
    memory.messages[place].data, old = data, memory.messages[place].data
    found = mismatches(memory)
    memory.messages[place].data = old
    return found


def alter_digit(rng, memory, place, k):
    """The mismatches if another digit stands at a place of a message."""
    data = memory.messages[place].data
    digit = rng.choice([each for each in b"0123456789" if each != data[k]])
    return swap(memory, place, data[:k] + bytes([digit]) + data[k + 1 :])


def test_a_run_with_all_events_agrees(memory):
    for topic in ("/top/robot_description", "/tf_static", "/diagnostics"):
        assert memory.places(topic), topic
    assert mismatches(memory) == []


@pytest.mark.parametrize("seed", seeds(1, 5))
def test_an_altered_digit_of_a_description_is_found(memory, seed):
    rng = random.Random(seed)
    memory.keep("/top/robot_description")
    for place in memory.places("/top/robot_description"):
        data = memory.messages[place].data
        digits = [k for k in range(4, len(data)) if chr(data[k]).isdigit()]
        for k in rng.sample(digits, 10):
            (found,) = alter_digit(rng, memory, place, k)
            assert (found.topic, found.field) == ("/top/robot_description", "text")


def test_an_altered_number_of_a_fixed_frame_is_found(memory):
    for place in memory.places("/tf_static"):
        data = memory.messages[place].data
        assert swap(memory, place, data[:-1] + bytes([data[-1] ^ 1]))


@pytest.mark.parametrize("seed", seeds(1, 5))
def test_an_altered_digit_of_diagnostics_of_the_motion_is_found(memory, seed):
    rng = random.Random(seed)
    memory.keep("/diagnostics")
    for place in memory.places("/diagnostics"):
        data = memory.messages[place].data
        status = next(each for each in decode_statuses(data) if each.name == "top: motion")
        texts = [text for text in status.values.values() if any(map(str.isdigit, text))]
        text = rng.choice(texts)
        k = data.index(text.encode())  # the first with this text: its value or an equal one
        k += rng.choice([number for number, letter in enumerate(text) if letter.isdigit()])
        assert alter_digit(rng, memory, place, k), text


def test_what_is_left_of_a_balance_is_rounding_and_not_judged(memory):
    place = memory.places("/diagnostics")[-1]
    data = memory.messages[place].data
    (status,) = (each for each in decode_statuses(data) if each.name == "top: balance")
    text = status.values["angular_momentum.balance"]
    assert swap(memory, place, data.replace(text.encode(), text.encode()[::-1])) == []


def test_a_message_that_cannot_be_read_is_named(memory):
    (place, *_) = memory.places("/diagnostics")
    (found,) = swap(memory, place, memory.messages[place].data[:-2])
    assert (found.topic, found.field, found.expected) == ("/diagnostics", "message", "readable")


def test_descriptions_of_a_run_of_another_version_are_not_judged(memory):
    (place, *_) = memory.places("/top/robot_description")
    text = Reader(memory.messages[place].data).string()
    other = memory.messages[place].data.replace(b"robot", b"tobor", 1)
    assert "robot" in text
    assert swap(memory, place, other)
    version = b"0" * len(__version__)
    for place_of_event in memory.places("/top/events"):
        event = memory.messages[place_of_event]
        assert __version__.encode() in event.data
        data = event.data.replace(__version__.encode(), version)
        memory.messages[place_of_event] = replace(event, data=data)
    assert swap(memory, place, other) == []
