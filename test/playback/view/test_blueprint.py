"""The spans of plots: a constant quantity is a line, not its rounding."""

import pytest
from log_files import ARTICLE, REGULAR, SLOW

from symtop_ros.physics import Motion, hurry
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.blueprint import LEAST_SPAN, Framing
from symtop_ros.simulation.segment import Segment

STEADY = Framing.of(Segment.begin(Motion(ARTICLE, REGULAR), 0, 1.0))
KICKED = Framing.of(Segment.begin(Motion(ARTICLE, hurry(REGULAR)), 0, 1.0))


def test_in_regular_precession_the_plots_span_a_part_of_their_quantities():
    held = {entities.THETA: 0.5, entities.PHI_DOT: SLOW, entities.PSI_DOT: 200.0}
    assert STEADY.ranges.keys() == {*held, entities.L_HORIZONTAL}
    for entity, value in held.items():
        low, high = STEADY.ranges[entity]
        assert high - low == pytest.approx(LEAST_SPAN * value)  # sums of two doubles
        assert low < value < high


def test_a_nutation_that_can_be_seen_is_scaled_by_the_viewer_also_after_regular_precession():
    assert not KICKED.ranges.keys() & {entities.THETA, entities.PHI_DOT}
    for first, second in ((STEADY, KICKED), (KICKED, STEADY)):
        assert not second.after(first).ranges.keys() & {entities.THETA, entities.PHI_DOT}
    assert STEADY.after(STEADY).ranges == STEADY.ranges
