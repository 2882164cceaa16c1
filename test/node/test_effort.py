"""How the engine's work is bounded, with a clock that a test turns."""

import pytest

from symtop_ros.node.effort import PATIENCE, SHARE, STEPS, Effort
from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.run.segment import Segment

TOP, START = Top(1e-3, 1e-3, 1.0), State.from_euler(theta=1.0, psi_dot=1e4)
SECOND = 1_000_000_000


def fast():
    """A motion that takes some thousand steps a second."""
    return motion(TOP, START, Friction(transverse=1e-3))


class Clock:
    """Goes on by some seconds whenever it is read."""

    def __init__(self, each):
        self.time, self.each = 0.0, each

    def __call__(self):
        self.time += self.each
        return self.time


def prepared(effort, segment, stamp):
    """How many turns it takes until the engine is there, or gives up."""
    turns = 1
    while not effort.prepare(segment, stamp) and not effort.shortfall:
        turns += 1
    return turns


def test_the_closed_form_takes_one_turn_however_far_it_is():
    effort = Effort(0, Clock(0.001))
    assert prepared(effort, Segment.begin(motion(TOP, START), 0, 100.0), 10**6 * SECOND) == 1
    assert effort.shortfall is None


def test_at_rest_there_is_nothing_to_prepare():
    effort = Effort(0, Clock(1.0))
    assert prepared(effort, Segment.begin(fast(), 0, 1.0).paused(0), 10**6 * SECOND) == 1


def test_what_lasts_longer_than_its_work_is_prepared_in_turns():
    effort = Effort(0, Clock(0.001))
    turns = prepared(effort, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns > 10
    assert effort.shortfall is None
    assert effort.spent == pytest.approx(0.001 * turns)


def test_what_takes_longer_than_it_lasts_is_given_up_and_says_what_can_be_done():
    each = 0.1  # s for a turn
    effort = Effort(0, Clock(each))
    turns = prepared(effort, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns == 11  # the first with which it takes more than the second
    reached, factor = effort.shortfall
    assert reached == fast().reach(1.0, turns * STEPS)
    assert factor == pytest.approx(SHARE * (reached - fast().reach(1.0, 0)) / (turns * each))


def test_a_speed_that_it_says_it_can_do_is_one_that_it_can_do():
    effort = Effort(0, Clock(0.1))
    segment = Segment.begin(fast(), 0, 1.0)
    prepared(effort, segment, SECOND)
    slower = segment.slowed(*effort.shortfall, SECOND)
    prepared(effort, slower, 2 * SECOND)
    assert effort.shortfall is None


def test_after_a_long_stop_there_is_as_much_time_for_what_was_missed():
    effort = Effort(0, Clock(PATIENCE / 10))
    segment = Segment.begin(fast(), 0, 1.0)
    prepared(effort, segment, SECOND // 100)
    prepared(effort, segment, 5 * SECOND)
    assert effort.shortfall is None
