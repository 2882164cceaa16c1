"""The meaning of each request: it is validated, changes the simulation and returns its answer."""

import json
from collections.abc import Callable, Mapping
from typing import Any

from symtop_ros.session.diagnostics import summarize_state
from symtop_ros.session.recording import Answer
from symtop_ros.simulation.budget import StepBudget
from symtop_ros.simulation.changes.follow import Act
from symtop_ros.simulation.changes.kick import name_kick
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.simulation.validation import RefusedError, number, reject, validate_names

MAX_STEP = 1e9  # s of the motion
STEPS_OF_A_REQUEST = 1_000  # integration steps; samples wait for up to 0.1 s

Values = Mapping[str, Any]


class Requests:
    """Requests to a simulation, from plain values: a method for each record of `services`.

    Call them in a turn. Each returns the text of its answer and raises RefusedError if it is
    refused; the motion is then unchanged.
    """

    def __init__(self, simulation: Simulation, record: Callable[[bool], str]) -> None:
        self._simulation, self.record = simulation, record

    def set_initial_conditions(self, values: Values) -> str:
        """Restart from named values; see `initial.initial_state`."""
        simulation = self._simulation
        return simulation.apply_at_once(simulation.timeline.restart(simulation.stamp, values))

    def reset(self) -> str:
        """Restart from the last initial conditions."""
        simulation = self._simulation
        return simulation.apply_at_once(simulation.timeline.restart(simulation.stamp))

    def kick(self, values: Values) -> str:
        """Kick by named values; see `kick.plan_kick` and `kick.plan_pushes`."""
        simulation = self._simulation
        act = Act(name_kick(values), simulation.stamp, values)
        change = simulation.timeline.follow(act)
        return simulation.apply_at_once(change)

    def hurry_precession(self) -> str:
        """Multiply the precession rate by the parameter `hurry_factor`."""
        return self.kick({"precession_rate_factor": self._simulation.settings.hurry_factor})

    def pause(self, paused: bool) -> str:
        """Stop the motion, or continue it."""
        simulation = self._simulation
        if paused != simulation.segment.running:
            return str(Answer("paused" if paused else "running"))
        return simulation.pause(paused)

    def step(self, values: Values) -> str:
        """Advance a paused motion by `duration` seconds."""
        return self._simulation.step(self._read_duration(values))

    def _read_duration(self, values: Values) -> float:
        validate_names(values, ("duration",))
        if "duration" not in values:
            raise RefusedError(f"duration must be 0 to {MAX_STEP:g} s, got none")
        duration = number("duration", values["duration"], "s", 0.0, MAX_STEP)
        segment = self._simulation.segment
        if segment.running:
            raise RefusedError(
                "step must be requested while paused (~/pause), got it while running"
            )
        end = segment.step(duration, segment.stamp).time_at(segment.stamp)
        if not StepBudget().reach(segment.motion, end, STEPS_OF_A_REQUEST):
            longest = segment.motion.reach(end, 0) - segment.time_at(segment.stamp)
            condition = f"up to {longest:.6g} s in one step under friction or an applied torque"
            raise reject("duration", condition, duration)
        return duration

    def get_state(self) -> str:
        """Return the state, the constants of motion and the verdict as JSON."""
        simulation = self._simulation
        since = simulation.timeline.since
        return json.dumps(summarize_state(simulation.segment, simulation.stamp, since))
