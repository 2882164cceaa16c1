"""How much of a motion the views show at once."""

import math

import pytest
from log_files import ARTICLE
from physics.tops import CUSPS

from symtop_ros.physics import Motion
from symtop_ros.replay.view.blueprint import PLOT_NUTATIONS, TRACE_NUTATIONS, Framing
from symtop_ros.run.simulation.segment import Segment

MOTION = Motion(ARTICLE, CUSPS)
TURN, NUTATION = 2 * math.pi / MOTION.mean_precession_rate, MOTION.nutation_period


@pytest.mark.parametrize("factor", [1.0, 0.25])
def test_trace_and_plots_show_the_same_of_a_motion_that_is_slowed(factor):
    framing = Framing.of(Segment.begin(MOTION, 0, factor))
    # in s of the clock, of which a slow motion takes more: one turn, and nutations on each side
    assert TURN < TRACE_NUTATIONS * NUTATION
    assert framing.trace == pytest.approx(TURN / factor, rel=1e-12)
    assert framing.window == pytest.approx(PLOT_NUTATIONS * NUTATION / factor, rel=1e-12)
