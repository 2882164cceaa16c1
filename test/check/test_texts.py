"""Descriptions, fixed frames and diagnostics of a log are those that its events give."""

import random
from dataclasses import replace

import pytest
from trials import seeds

from symtop_ros import __version__
from symtop_ros.check.events import find_wrong_texts
from symtop_ros.log.top_log import TopLog
from symtop_ros.wire.diagnostics import decode_statuses
from symtop_ros.wire.layout import Reader

STATUS = "top: motion"


def mismatches(memory):
    log = TopLog(memory)
    return list(find_wrong_texts(log, list(log.events())))


def swap(memory, place, data):
    memory.messages[place].data, old = data, memory.messages[place].data
    found = mismatches(memory)
    memory.messages[place].data = old
    return found


def alter(rng, memory, place, k):
    """The mismatches if another digit stands at a place of a message."""
    data = memory.messages[place].data
    digit = rng.choice([each for each in b"0123456789" if each != data[k]])
    return swap(memory, place, data[:k] + bytes([digit]) + data[k + 1 :])


def test_a_run_with_all_events_agrees(memory):
    for topic in ("/robot_description", "/tf_static", "/diagnostics"):
        assert memory.places(topic), topic
    assert mismatches(memory) == []


@pytest.mark.parametrize("seed", seeds(1, 5))
def test_an_altered_digit_of_a_description_is_found(memory, seed):
    rng = random.Random(seed)
    for place in memory.places("/robot_description"):
        data = memory.messages[place].data
        digits = [k for k in range(4, len(data)) if chr(data[k]).isdigit()]
        for k in rng.sample(digits, 10):
            (found,) = alter(rng, memory, place, k)
            assert (found.topic, found.field) == ("/robot_description", "text")


def test_an_altered_number_of_a_fixed_frame_is_found(memory):
    for place in memory.places("/tf_static"):
        data = memory.messages[place].data
        assert swap(memory, place, data[:-1] + bytes([data[-1] ^ 1]))


@pytest.mark.parametrize("seed", seeds(1, 5))
def test_an_altered_digit_of_diagnostics_of_the_motion_is_found(memory, seed):
    rng = random.Random(seed)
    for place in memory.places("/diagnostics"):
        data = memory.messages[place].data
        status = next(each for each in decode_statuses(data) if each.name == STATUS)
        texts = [text for text in status.values.values() if any(map(str.isdigit, text))]
        text = rng.choice(texts)
        k = data.index(text.encode())  # the first with this text: its value or an equal one
        k += rng.choice([number for number, letter in enumerate(text) if letter.isdigit()])
        assert alter(rng, memory, place, k), text


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
    (place, *_) = memory.places("/robot_description")
    text = Reader(memory.messages[place].data).string()
    other = memory.messages[place].data.replace(b"robot", b"tobor", 1)
    assert "robot" in text
    assert swap(memory, place, other)
    version = b"0" * len(__version__)
    for place_of_event in memory.places("/top/events"):
        event = memory.messages[place_of_event]
        assert __version__.encode() in event.data
        memory.messages[place_of_event] = replace(
            event, data=event.data.replace(__version__.encode(), version)
        )
    assert swap(memory, place, other) == []
