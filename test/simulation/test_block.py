"""Samples computed in blocks."""

from dataclasses import replace
from itertools import product

import pytest
from log_files import ARTICLE, BEGIN, CUSPS

from symtop_ros.physics import Friction, Motion
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.sensor import Imu, Rig
from symtop_ros.simulation.topics import SAMPLE_TOPICS, SENSOR_TOPICS, STATE_TOPICS, Samples

STAMPS = [BEGIN + 1_000_003 * k for k in range(16)]
MOTION = Motion(ARTICLE, CUSPS)
NOISES = 2e-3, 3e-4, 0.02, 0.005
RIG = Rig(9.81, Imu((0.01, -0.02, 0.05), (0.5, 0.5, 0.5, 0.5), *NOISES, seed=11, rate=400.0))
SEGMENTS = {
    "closed form": Segment.begin(MOTION, BEGIN, 0.7, RIG),
    "taylor": Segment.begin(Motion(ARTICLE, CUSPS, Friction(1e-6, 1e-5)), BEGIN, 0.7, RIG),
    "paused": Segment.begin(MOTION, BEGIN - 10**9, 0.7, RIG).pause(BEGIN),
}


LAYOUTS = {name: topic.layout("world", "top") for name, topic in SAMPLE_TOPICS.items()}


def make(segment, stamps):
    return Block(segment, stamps, lambda name, *given: LAYOUTS[name].encode_many(*given))


@pytest.mark.parametrize("segment", SEGMENTS.values(), ids=SEGMENTS)
@pytest.mark.parametrize(
    ("name", "count"), [*product(STATE_TOPICS, (16, 5000)), *product(SENSOR_TOPICS, (40,))]
)
def test_samples_are_those_of_each_stamp_alone_bit_for_bit(segment, name, count):
    stamps = [BEGIN + 1_000_003 * k for k in range(count)]
    block = make(segment, stamps)
    for stamp in stamps[:: 1 + count // 1000]:
        expected = SAMPLE_TOPICS[name].compute(Samples.at(segment, stamp)).tolist()
        assert block.numbers(name, stamp) == expected
        assert block.message(name, stamp) == LAYOUTS[name].encode(stamp, expected)


def test_it_covers_its_segment_and_stamps_only():
    segment, other = SEGMENTS["closed form"], SEGMENTS["taylor"]
    block = make(segment, STAMPS)
    assert block.covers(segment, STAMPS[0])
    assert not block.covers(segment, STAMPS[0] + 1)
    assert not block.covers(other, STAMPS[0])
    assert not make(segment, []).covers(segment, STAMPS[0])


@pytest.fixture
def computed(monkeypatch):
    """Names of the topics that are computed, in their order."""
    names = []
    for name, topic in STATE_TOPICS.items():
        compute = topic.compute
        spy = replace(topic, compute=lambda *a, n=name, f=compute: names.append(n) or f(*a))
        monkeypatch.setitem(SAMPLE_TOPICS, name, spy)
    return names


def test_a_topic_that_is_not_requested_is_not_computed(computed):
    block = make(SEGMENTS["closed form"], STAMPS)
    for stamp in STAMPS:
        assert block.message("torque", stamp)
    assert computed == ["torque"]
    after = block.continue_with(SEGMENTS["taylor"], STAMPS).compute()
    assert computed == ["torque", "torque"]
    after.message("torque", STAMPS[0])
    assert computed == ["torque", "torque"]
    after.continue_with(SEGMENTS["taylor"], STAMPS).compute()
    assert len(computed) == 3


def test_the_next_block_is_computed_a_topic_at_a_time(computed):
    segment, later = SEGMENTS["closed form"], [stamp + 10**8 for stamp in STAMPS]
    block = make(segment, STAMPS)
    for name in STATE_TOPICS:
        block.message(name, STAMPS[0])
    del computed[:]
    for count in range(-2, len(STATE_TOPICS) + 1):
        assert len(computed) == max(0, count)
        block.work_ahead(lambda: later)
    assert sorted(computed) == sorted(STATE_TOPICS)
    for name in STATE_TOPICS:
        assert block.next.message(name, later[3]) == make(segment, later).message(name, later[3])
