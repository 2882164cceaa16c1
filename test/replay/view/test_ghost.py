"""The ghost is the run without its last kick, at the same stamps."""

from unittest.mock import Mock

import numpy as np
import pytest
from log_files import ARTICLE, CUSPS
from physics.tops import EPS

from symtop_ros.physics import Friction, Motion, Top, hurry
from symtop_ros.replay.view.ghost import LEFT_OUT, GhostView
from symtop_ros.run.simulation.segment import Segment

SECOND = 1_000_000_000
BEGIN = Segment.begin(Motion(ARTICLE, CUSPS), stamp=0, factor=1.0)


def kicked(segment, stamp):
    return segment.change(stamp, hurry(segment.state_at(stamp), factor=1.4))


@pytest.fixture(name="ghost")
def _ghost():
    """A ghost of a run that is kicked after one second, and the run from there on."""
    ghost = GhostView(Mock())
    after = kicked(BEGIN, SECOND)
    ghost.follow("start", None, BEGIN)
    ghost.follow("kick", BEGIN, after)
    return ghost, after


def test_it_continues_the_motion_before_the_kick_to_the_last_bit(ghost):
    ghost, _ = ghost
    stamps = SECOND + np.arange(0, SECOND, 10_000_000)
    chosen, quaternions = ghost.states_at(stamps)
    expected = BEGIN.state_at(chosen).orientation[:, [1, 2, 3, 0]]
    assert np.array_equal(quaternions, expected)


@pytest.mark.parametrize("name", LEFT_OUT)
def test_a_second_kick_replaces_it_by_the_motion_just_before(ghost, name):
    ghost, after = ghost
    ghost.follow(name, after, kicked(after, 2 * SECOND))
    assert ghost.segment.state_at(3 * SECOND) == after.state_at(3 * SECOND)


@pytest.mark.parametrize("name", ["start", "reset"])
def test_a_restart_removes_it(ghost, name):
    ghost, after = ghost
    ghost.follow(name, after, after.change(2 * SECOND, CUSPS))
    assert ghost.segment is None


def test_pauses_steps_and_another_real_time_factor_act_on_it(ghost):
    ghost, after = ghost
    paused = after.pause(2 * SECOND)
    stepped = paused.step(0.25, 3 * SECOND)
    resumed = stepped.resume(4 * SECOND)
    slowed = resumed.set_factor(0.5, 5 * SECOND)
    run = [after, paused, stepped, resumed, slowed]
    names = ("pause", "step", "resume", "parameters")
    for name, before, changed in zip(names, run[:-1], run[1:], strict=True):
        ghost.follow(name, before, changed)
    # 2 s until the pause, a step, 1 s of running and 1 s at half the speed
    assert ghost.segment.time_at(6 * SECOND) == 2.0 + 0.25 + 1.0 + 0.5
    assert ghost.segment.state_at(6 * SECOND) == BEGIN.motion.at(3.75)


def test_a_parameter_changes_both(ghost):
    ghost, after = ghost
    heavier = Top(ARTICLE.Ix, ARTICLE.Iz, 0.1)
    changed = after.change(2 * SECOND, after.state_at(2 * SECOND), top=heavier)
    ghost.follow("parameters", after, changed)
    assert ghost.segment.motion.top == heavier
    assert ghost.segment.state_at(2 * SECOND) == BEGIN.state_at(2 * SECOND)


def test_a_jump_of_the_clock_leaves_it_where_it_is(ghost):
    ghost, after = ghost
    ghost.follow("clock", after, after.move(2 * SECOND, 50 * SECOND))
    found = ghost.segment.state_at(51 * SECOND)
    expected = BEGIN.state_at(3 * SECOND)
    # one motion, evaluated from two starts or as one: up to the rounding of a start
    assert np.abs(found.orientation - expected.orientation).max() <= 64 * EPS


def test_a_motion_that_is_too_long_to_integrate_has_no_ghost():
    segment = Segment.begin(Motion(ARTICLE, CUSPS, Friction(axial=1e-9)), stamp=0, factor=1.0)
    ghost = GhostView(Mock())
    year = 365 * 86_400 * SECOND
    ghost.follow("start", None, segment)
    ghost.follow("kick", segment, segment.change(SECOND, CUSPS))
    assert len(ghost.states_at(np.array([SECOND]))[0]) == 1
    assert len(ghost.states_at(np.array([year]))[0]) == 0
    assert ghost.segment is None


def test_its_body_is_drawn_for_each_top_once():
    stream = Mock()
    ghost = GhostView(stream)
    after = kicked(BEGIN, SECOND)
    ghost.follow("start", None, BEGIN)
    ghost.follow("kick", BEGIN, after)
    assert stream.log_mesh.call_count == 1
    again = kicked(after, 2 * SECOND)
    ghost.follow("kick", after, again)
    assert stream.log_mesh.call_count == 1  # the same top
    heavier = again.change(3 * SECOND, again.state_at(3 * SECOND), top=Top(0.001, 0.002, 0.1))
    ghost.follow("parameters", again, heavier)
    assert stream.log_mesh.call_count == 2
