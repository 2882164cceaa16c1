"""Another pace, and the last state of a motion."""

from simulation.runs import SECOND, Run

from symtop_ros.physics import Motion, State, Top
from symtop_ros.simulation.budget import ComputeBudget
from symtop_ros.simulation.segment import Segment


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
