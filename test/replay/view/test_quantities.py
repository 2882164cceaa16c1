"""Quantities that are drawn and not logged, of random tops."""

import math

import numpy as np
import pytest
from physics.tops import FAMILIES, random_case
from replay.view.rows import DRIFT
from trials import trials

from symtop_ros.physics import Motion
from symtop_ros.replay.view.quantities import EPS, constants, scales_of_constants
from symtop_ros.run.log.batch import Columns
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Samples

TOPICS = "orientation", "angular_velocity", "angular_momentum"
PERIODS, COUNT = 20, 200  # nutations, and samples in them
LONGEST = 1e3  # s of a nutation
SHORTEST = 1e-6  # s; stamps are whole ns


@pytest.mark.parametrize("count", trials(40, 1000))
@pytest.mark.parametrize("family", FAMILIES)
@np.errstate(all="ignore")  # as in a view
def test_constants_drift_by_rounding_in_motions_of_every_family(family, count):
    found = [each for seed in range(count) if (each := find_drift(random_case(seed, family)))]
    assert len(found) > count / 3
    assert max(found) <= DRIFT


def find_drift(case):
    """The largest drift in eps; None if the motion has no such samples."""
    motion = Motion(case.top, case.start)
    period = motion.nutation_period
    period = min(period, LONGEST) if math.isfinite(period) and period > 0 else 1.0
    stamps = np.arange(COUNT) * (round(PERIODS * period * 1e9) // COUNT)
    segment = Segment.begin(motion, 0, 1.0)
    if period < SHORTEST or stamps[-1] > segment.last_stamp:
        return None
    samples = Samples.at(segment, stamps)
    columns = {
        name: Columns(stamps, SAMPLE_TOPICS[name].compute(samples), stamps) for name in TOPICS
    }
    _, values = constants(columns, case.top)
    scales = EPS * scales_of_constants(case.top, values[0])
    return float(np.abs((values - values[0]) / scales).max())
