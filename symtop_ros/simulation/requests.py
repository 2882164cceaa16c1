"""The meaning of each request: it is validated, changes the simulation and returns its answer."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from symtop_ros.physics import kick_verdict
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.kick import plan_kick
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.simulation.summary import summarize_state
from symtop_ros.simulation.validation import RefusedError, number, refuse, validate_names

MAX_STEP = 1e9  # s of the motion
STEPS_OF_A_REQUEST = 6_000  # integration steps; the lock is held for up to 0.5 s


class Requests:
    """Requests to a simulation, from plain mappings.

    Call them in a turn, for example by `simulation.answer("kick", lambda: requests.kick(...))`.
    Each returns its answer in a sentence and raises RefusedError if it is refused; the motion is
    then unchanged.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def set_initial_conditions(self, values: Mapping[str, Any]) -> str:
        """Restart from named values; see `initial.initial_state`."""
        simulation = self._simulation
        settings = simulation.settings
        simulation.start = initial_state(settings.top, settings.initial, values)
        return self._restart("start", values)

    def reset(self) -> str:
        """Restart from the last initial conditions."""
        return self._restart("reset", {})

    def _restart(self, name: str, request: Mapping[str, Any]) -> str:
        simulation = self._simulation
        before = simulation.state
        segment = simulation.segment.restart(simulation.start, simulation.stamp)
        return simulation.change_at_once(name, segment, request, before, lambda: simulation.verdict)

    def kick(self, values: Mapping[str, Any]) -> str:
        """Kick by named values; see `kick.plan_kick`."""
        simulation = self._simulation
        before = simulation.state
        motion, hold = plan_kick(simulation.segment.motion, before, values)
        segment = simulation.segment.replace_motion(motion, simulation.stamp)
        return simulation.change_at_once(
            "kick", segment, values, before, lambda: kick_verdict(motion, before, hold)
        )

    def hurry_precession(self) -> str:
        """Multiply the precession rate by the parameter `hurry_factor`."""
        return self.kick({"precession_rate_factor": self._simulation.settings.hurry_factor})

    def pause(self, paused: bool) -> str:
        """Stop the motion, or continue it."""
        simulation, segment = self._simulation, self._simulation.segment
        if paused != segment.running:
            return "already paused" if paused else "already running"
        name = "pause" if paused else "resume"
        segment = (segment.pause if paused else segment.resume)(simulation.stamp)
        verdict = f"{name}d at {_seconds(segment)} s of the motion"
        return simulation.change(name, segment, {}, verdict)

    def step(self, values: Mapping[str, Any]) -> str:
        """Advance a paused motion by `duration` seconds."""
        simulation = self._simulation
        duration = self._step_duration(values)
        segment = simulation.segment.step(duration, simulation.stamp)
        verdict = f"stepped to {_seconds(segment)} s of the motion"
        return simulation.change("step", segment, values, verdict)

    def _step_duration(self, values: Mapping[str, Any]) -> float:
        validate_names(values, ("duration",))
        if "duration" not in values:
            msg = f"duration must be 0 to {MAX_STEP:g} s, got none"
            raise RefusedError(msg)
        duration = number("duration", values["duration"], "s", 0.0, MAX_STEP)
        segment = self._simulation.segment
        if segment.running:
            msg = "step must be requested while paused (~/pause), got it while running"
            raise RefusedError(msg)
        now = segment.time_at(segment.stamp)
        end = segment.step(duration, segment.stamp).time_at(segment.stamp)
        reached = segment.motion.reach(end, STEPS_OF_A_REQUEST)
        if reached != end:
            longest = reached - now
            condition = f"up to {longest:.6g} s in one step under friction or an applied torque"
            raise refuse("duration", condition, duration)
        return duration

    def get_state(self) -> str:
        """Return the state, the constants of motion and the verdict as JSON."""
        simulation = self._simulation
        summary = summarize_state(simulation.segment, simulation.stamp, simulation.motion_begin)
        return json.dumps(summary)


def _seconds(segment: Segment) -> str:
    return f"{segment.time_at(segment.stamp):.6f}"
