"""Samples computed in blocks."""

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, CUSPS

from symtop_ros.physics import Friction, motion
from symtop_ros.run.block import Block
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment

STAMPS = [BEGIN + 1_000_003 * k for k in range(16)]
SEGMENTS = {
    "closed form": Segment.begin(motion(ARTICLE, CUSPS), BEGIN, 0.7),
    "splitting": Segment.begin(motion(ARTICLE, CUSPS, Friction(1e-6, 1e-5)), BEGIN, 0.7),
    "paused": Segment.begin(motion(ARTICLE, CUSPS), BEGIN - 10**9, 0.7).paused(BEGIN),
}


@pytest.mark.parametrize("segment", SEGMENTS.values(), ids=SEGMENTS)
@pytest.mark.parametrize("name", SAMPLES)
def test_samples_are_those_of_each_stamp_alone_bit_for_bit(segment, name):
    block = Block(segment, STAMPS)
    for stamp in STAMPS:
        expected = SAMPLES[name](segment.path, segment.state_at(stamp)).tolist()
        assert block.numbers(name, stamp) == expected


def test_it_holds_its_own_segment_and_stamps_alone():
    segment, other = SEGMENTS["closed form"], SEGMENTS["splitting"]
    block = Block(segment, STAMPS)
    assert block.holds(segment, STAMPS[0])
    assert not block.holds(segment, STAMPS[0] + 1)
    assert not block.holds(other, STAMPS[0])
    assert not Block(segment, []).holds(segment, STAMPS[0])


def test_what_nobody_asks_for_is_not_computed(monkeypatch):
    computed = []
    for name, function in SAMPLES.items():
        monkeypatch.setitem(
            SAMPLES, name, lambda *a, n=name, f=function: computed.append(n) or f(*a)
        )
    block = Block(SEGMENTS["closed form"], STAMPS)
    for stamp in STAMPS:
        assert np.isfinite(block.numbers("torque", stamp)).all()
    assert computed == ["torque"]
    after = block.following(SEGMENTS["splitting"], STAMPS)
    assert computed == ["torque", "torque"]  # at hand
    after.numbers("torque", STAMPS[0])
    assert computed == ["torque", "torque"]
    after.following(SEGMENTS["splitting"], STAMPS)
    assert len(computed) == 3
