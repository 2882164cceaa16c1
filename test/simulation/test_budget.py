"""The compute budget, with a clock that advances when it is read, and the end of a motion."""

import pytest
from simulation.runs import SECOND, Run

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.simulation.budget import STEPS_AT_ONCE, ComputeBudget
from symtop_ros.simulation.segment import Segment

TOP, START = Top(1e-3, 1e-3, 1.0), State.from_euler(theta=1.0, psi_dot=1e4)


def fast():
    """A motion that takes some thousand steps a second."""
    return Motion(TOP, START, Friction(transverse=1e-3))


class Clock:
    """Advances by some seconds whenever it is read."""

    def __init__(self, each):
        self.time, self.each = 0.0, each

    def __call__(self):
        self.time += self.each
        return self.time


def count_turns(budget, segment, stamp):
    """Return the number of calls until the state is ready or a shortfall is found."""
    turns = 1
    while not budget.prepare(segment, stamp) and not budget.shortfall:
        turns += 1
    return turns


@pytest.mark.parametrize(
    "segment",
    [Segment.begin(Motion(TOP, START), 0, 100.0), Segment.begin(fast(), 0, 1.0).pause(0)],
    ids=["the closed form", "a pause"],
)
def test_what_needs_no_integration_takes_one_call_for_any_time(segment):
    budget = ComputeBudget(0, Clock(0.001))
    assert count_turns(budget, segment, 10**6 * SECOND) == 1
    assert budget.shortfall is None


def test_a_stretch_that_lasts_longer_than_its_work_is_prepared_in_many_calls():
    budget = ComputeBudget(0, Clock(0.001))
    turns = count_turns(budget, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns > 10
    assert budget.shortfall is None
    assert budget.spent == pytest.approx(0.001 * turns)


def test_a_stretch_that_takes_longer_than_it_lasts_gives_a_factor_that_can_be_kept():
    each = 0.1  # s for a turn
    budget = ComputeBudget(0, Clock(each))
    turns = count_turns(budget, Segment.begin(fast(), 0, 1.0), SECOND)
    assert turns == 11  # the first with which it takes more than the second
    reached, factor = budget.shortfall
    assert reached == fast().reach(1.0, turns * STEPS_AT_ONCE)
    # a quarter of one core
    assert factor == pytest.approx(0.25 * (reached - fast().reach(1.0, 0)) / (turns * each))


def test_the_factor_of_a_shortfall_can_be_kept():
    budget = ComputeBudget(0, Clock(0.1))
    segment = Segment.begin(fast(), 0, 1.0)
    count_turns(budget, segment, SECOND)
    slower = segment.slow_down(*budget.shortfall, SECOND)
    count_turns(budget, slower, 2 * SECOND)
    assert budget.shortfall is None


def test_after_a_long_stop_the_missed_stretch_may_take_as_long_as_it_lasts():
    budget = ComputeBudget(0, Clock(0.002))  # a tenth of the work that any stretch may take
    segment = Segment.begin(fast(), 0, 1.0)
    count_turns(budget, segment, SECOND // 100)
    count_turns(budget, segment, 5 * SECOND)
    assert budget.shortfall is None


def test_a_state_that_is_asked_for_in_between_does_not_make_the_factor_negative():
    budget, motion = ComputeBudget(0, Clock(0.1)), fast()
    segment = Segment.begin(motion, 0, 1.0)
    while not budget.prepare(segment, SECOND) and not budget.shortfall:
        motion.at(0.0)  # moves the integration back to its start
    assert budget.shortfall.factor > 0


def test_another_pace_is_that_of_the_motion_that_follows():
    simulation = Run("cusps").simulation
    change = simulation.timeline.set_pace(simulation.stamp, 1.0, 0.25)
    assert (simulation.segment.factor, change.following.segment.factor) == (1.0, 0.25)


def test_a_motion_that_comes_to_its_last_state_is_stopped_there():
    motion = Motion(Top(1e-3, 1e-3, 1.0), State.from_euler(theta=1.0, psi_dot=1e12))
    segment, budget = Segment.begin(motion, 0, 1.0), ComputeBudget(0)
    last = int(segment.last_stamp)
    assert 0 < last * 1e-9 < motion.farthest_time
    assert budget.prepare(segment, last)
    assert not budget.prepare(segment, last + SECOND)
    assert segment.state_at(last) == motion.at(segment.times_at(last))
    assert budget.end == segment.time_at(last)
