"""The grid of an integration: the same whatever was asked before, and of bounded size."""

from itertools import pairwise

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import Friction, Motion

FRICTION = Friction(2e-6, 1e-5)


def test_a_state_is_the_same_bit_for_bit_whatever_was_asked_before():
    times = np.random.default_rng(1).uniform(-8.0, 12.0, 60)  # beyond what is kept at first
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    assert motion.at(0.0) == CUSPS
    together = motion.at(times)
    for k in (0, 7, 33, 59):
        for alone in (motion.at(times[k]), Motion(ARTICLE, CUSPS, FRICTION).at(times[k])):
            assert alone == together[k]


@pytest.mark.parametrize("count", [2, 3, 8, 63, 1000, 3000])
def test_a_state_is_the_same_bit_for_bit_among_any_number_of_others(count):
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    times = np.linspace(0.001, 0.04, count)  # of one step
    together = motion.at(times)
    for k in {0, 1, count // 2, count - 1}:
        alone = motion.at(times[k])
        assert alone == together[k]


# Backwards the spin grows, and the steps become shorter: of the 512 points that are kept every
# other one is dropped twice in 45 s, and four times in 75 s.
@pytest.mark.parametrize("end", [75.0, -45.0, pytest.param(-75.0, marks=pytest.mark.long)])
def test_one_can_come_back_from_anywhere(end):
    motion, early = Motion(ARTICLE, CUSPS, FRICTION), 0.321 if end > 0 else -0.321
    first, far = motion.at(early), motion.at(end)
    assert motion.at(early) == first
    assert motion.at(end) == far == Motion(ARTICLE, CUSPS, FRICTION).at(end)


@pytest.mark.parametrize("t", [3.0, -3.0])
def test_reach_goes_as_far_as_its_steps_and_then_the_rest(t):
    motion = Motion(ARTICLE, CUSPS, FRICTION)
    reached = [motion.reach(t, 5) for _ in range(20)]
    assert all(0 < a / t < b / t <= 1 or a == b == t for a, b in pairwise(reached))
    assert reached[0] != t
    assert reached[-1] == t
    assert motion.at(t) == Motion(ARTICLE, CUSPS, FRICTION).at(t)
