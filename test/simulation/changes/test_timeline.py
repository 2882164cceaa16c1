"""Requests that lead to where a motion has no states are refused, and leave it as it was."""

import pytest
from simulation.runs import SECOND, Run

from symtop_ros.physics import Motion, State, Top
from symtop_ros.simulation.budget import ComputeBudget
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.settings import Settings

TOO_FAST = "motion must be so slow that it stays within 1e15 turns for a day"


def test_a_step_beyond_1e15_turns_is_refused_and_the_motion_keeps_running():
    run = Run("cusps")
    run.advance(0.1)
    run.ask("pause", True)
    before = run.simulation.segment
    succeeded, reason = run.ask("step", {"duration": 1e15})
    assert not succeeded
    assert reason.startswith("duration must be")
    assert run.simulation.segment is before
    run.ask("pause", False)
    run.advance(0.1)
    run.assert_recomputed()


@pytest.mark.parametrize("changes", [{"top.Mgl": 1e24}, {"real_time_factor": 100.0}])
def test_parameters_that_lead_beyond_1e15_turns_within_a_day_are_refused(changes):
    run = Run("cusps", **{"top.Mgl": 1e16})  # it swings at 7e9 rad/s
    settings = Settings.from_values({**run.simulation.settings.values, **changes})
    with pytest.raises(ValueError, match=f"^{TOO_FAST}"):
        run.simulation.timeline.change_settings(settings, run.simulation.stamp)


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
