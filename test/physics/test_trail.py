"""The grid of an integration: the same whatever was asked before, and of bounded size."""

from itertools import pairwise

import numpy as np
import pytest

from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.physics.splitting import Point, Splitting
from symtop_ros.physics.trail import KEPT, Trail

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
FRICTION = Friction(2e-6, 1e-5)


def trail(direction=1):
    w, x, y, z = CUSPS.orientation.tolist()
    start = Point(0.0, complex(w, z), complex(x, y), 0j, 200.0)
    return Trail(Splitting(ARTICLE, FRICTION, (0.0, 0.0, 0.0)), start, direction)


def test_a_state_is_the_same_bit_for_bit_whatever_was_asked_before():
    times = np.random.default_rng(1).uniform(-8.0, 12.0, 60)  # beyond what is kept at first
    path = motion(ARTICLE, CUSPS, FRICTION)
    together = path.at(times)
    for k in (0, 7, 33, 59):
        for alone in (path.at(times[k]), motion(ARTICLE, CUSPS, FRICTION).at(times[k])):
            assert alone.orientation.tolist() == together.orientation[k].tolist()
            assert alone.angular_velocity.tolist() == together.angular_velocity[k].tolist()


def test_the_start_is_the_start():
    assert motion(ARTICLE, CUSPS, FRICTION).at(0.0) == CUSPS


@pytest.mark.parametrize("shape", [(), (0,), (1,), (2, 3)])
def test_shapes_follow_those_of_the_times(shape):
    state = motion(ARTICLE, CUSPS, FRICTION).at(np.ones(shape))
    assert state.orientation.shape == (*shape, 4)
    assert state.angular_velocity.shape == (*shape, 3)


@pytest.mark.parametrize("direction", [1, -1])
def test_what_is_kept_is_bounded_and_one_can_come_back(direction):
    way = trail(direction)
    early, end = direction * 0.321, direction * 15.0
    first = way.at(early)
    way.at(end)
    assert KEPT / 2 <= len(way._kept) <= KEPT
    assert way.at(early) == first
    assert way.at(end) == trail(direction).at(end)


@pytest.mark.parametrize("t", [3.0, -3.0])
def test_reach_goes_as_far_as_its_steps_and_then_the_rest(t):
    path = motion(ARTICLE, CUSPS, FRICTION)
    reached = [path.reach(t, 50) for _ in range(20)]
    assert all(0 < a / t < b / t <= 1 or a == b == t for a, b in pairwise(reached))
    assert reached[0] != t
    assert reached[-1] == t
    assert path.at(t) == motion(ARTICLE, CUSPS, FRICTION).at(t)


def test_the_closed_form_is_everywhere_at_once():
    assert motion(ARTICLE, CUSPS).reach(1e9, 0) == 1e9
