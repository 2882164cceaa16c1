from dataclasses import replace

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, CUSPS

from symtop_ros.physics import Friction, Motion
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment

CLOSED = Motion(ARTICLE, CUSPS)
INTEGRATED = Motion(ARTICLE, CUSPS, Friction(2e-6, 1e-5), (0.0, 1e-5, 1e-4))


def event_of(segment, stamp=BEGIN):
    return Event.of(stamp, "kick", None, {"hold": "spin_rate"}, segment.motion.start, segment)


@pytest.mark.parametrize("running", [True, False])
@pytest.mark.parametrize(("motion", "latest"), [(CLOSED, 10**15), (INTEGRATED, 10**10)])
def test_a_segment_comes_back_from_its_event_bit_for_bit(motion, latest, running):
    segment = Segment.begin(motion, BEGIN, 0.7).step(0.1, BEGIN + 12_345)
    segment = segment if running else segment.pause(BEGIN + 20_000)
    again = event_of(segment, BEGIN + 99_999).segment()
    assert (again.stamp, again.elapsed) == (segment.stamp, segment.elapsed)
    assert (again.factor, again.running) == (0.7, running)
    for later in (0, 1, 10**9, latest):
        assert again.state_at(BEGIN + later) == segment.state_at(BEGIN + later)


def test_an_event_without_a_value_says_which():
    event = event_of(Segment.begin(Motion(ARTICLE, CUSPS), BEGIN, 1.0))
    values = {name: value for name, value in event.values.items() if name != "motion.elapsed_ns"}
    wanted = "event 'kick' must have all values, 'motion.elapsed_ns' is missing"
    with pytest.raises(ValueError, match=wanted):
        replace(event, values=values).segment()


def test_an_event_without_a_valid_top_is_refused():
    event = event_of(Segment.begin(Motion(ARTICLE, CUSPS), BEGIN, 1.0))
    for bad in ("", "1 2", "a b c", "-1.0 1.0 1.0"):
        with pytest.raises(ValueError, match=r"\S"):
            replace(event, values={**event.values, "top": bad}).segment()


def test_a_resting_state_is_one_for_all_stamps():
    segment = Segment.begin(CLOSED, BEGIN, 1.0).pause(BEGIN)
    assert segment.state_at(BEGIN + np.arange(3)) == segment.state_at(BEGIN)
