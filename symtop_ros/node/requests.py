"""What the services do: each request returns the sentence of its answer, or raises RefusedError."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import SetParametersAtomically
from std_srvs.srv import SetBool, Trigger

from symtop_ros.node import initial, kick
from symtop_ros.node.course import Course, Request
from symtop_ros.node.diagnostics import state_report
from symtop_ros.node.fields import RefusedError, named_values, number, refuse
from symtop_ros.node.log import Log
from symtop_ros.physics import State
from symtop_ros.physics.perry import kick_verdict

LONGEST_STEP = 1e9  # s
STEPS_OF_A_STEP = 20_000  # of the engine: nobody else has a turn for half a second
Handle = Callable[[Any], str]


class Requests:
    """Requests to a run.

    Parameters
    ----------
    course : Course
    log : Log
    start : State
        What the first ~/reset goes back to.
    """

    def __init__(self, course: Course, log: Log, start: State) -> None:
        self._course, self._log, self._start = course, log, start

    @property
    def services(self) -> dict[str, tuple[type, Handle]]:
        """Name, type and handler of every service."""
        return {
            "set_initial_conditions": (SetParametersAtomically, self.set_initial_conditions),
            "kick": (SetParametersAtomically, self.kick),
            "step": (SetParametersAtomically, self.step),
            "hurry_precession": (Trigger, self.hurry_precession),
            "reset": (Trigger, self.reset),
            "pause": (SetBool, self.pause),
            "record": (SetBool, self.record),
            "get_state": (Trigger, self.get_state),
        }

    def set_initial_conditions(self, request: SetParametersAtomically.Request) -> str:
        """Begin anew from named values."""
        values = named_values(request.parameters, initial.NAMES)
        settings = self._course.settings
        self._start = initial.initial_state(settings.top, settings.initial, values)
        return self._restart("start", values)

    def reset(self, _: Trigger.Request) -> str:
        """Go back to the last start."""
        return self._restart("reset", {})

    def _restart(self, name: str, request: Request) -> str:
        course = self._course
        segment = course.segment.restarted(self._start, course.stamp)
        return course.change_at_once(name, segment, request, lambda: course.verdict)

    def kick(self, request: SetParametersAtomically.Request) -> str:
        """Kick by named values."""
        return self._kick_by(named_values(request.parameters, kick.NAMES))

    def hurry_precession(self, _: Trigger.Request) -> str:
        """Kick by the parameter for it."""
        return self._kick_by({"precession_rate_factor": self._course.settings["hurry_factor"]})

    def _kick_by(self, values: Request) -> str:
        course = self._course
        before = course.state
        path, hold = kick.kicked(course.segment.path, before, values)
        segment = course.segment.onto(path, course.stamp)
        return course.change_at_once(
            "kick", segment, values, lambda: kick_verdict(path, before, hold)
        )

    def pause(self, request: SetBool.Request) -> str:
        """Rest, or go on."""
        course, pausing = self._course, bool(request.data)
        segment = course.segment
        if pausing != segment.running:
            return "paused already" if pausing else "running already"
        segment = (segment.paused if pausing else segment.resumed)(course.stamp)
        name = "pause" if pausing else "resume"
        verdict = f"{name}d at {segment.elapsed:.6f} s of the motion"
        return course.change(name, segment, {}, verdict)

    def step(self, request: SetParametersAtomically.Request) -> str:
        """Go on by some seconds of motion, while paused."""
        course = self._course
        values = named_values(request.parameters, ("duration",))
        duration = self._duration(values)
        segment = course.segment.stepped(duration, course.stamp)
        verdict = f"stepped to {segment.elapsed:.6f} s of the motion"
        return course.change("step", segment, values, verdict)

    def _duration(self, values: Request) -> float:
        if "duration" not in values:
            msg = "duration: got none, allowed is a number of seconds"
            raise RefusedError(msg)
        duration = number("duration", values["duration"], 0.0, LONGEST_STEP)
        segment = self._course.segment
        if segment.running:
            msg = "step: got it while running, allowed is while paused (~/pause)"
            raise RefusedError(msg)
        end = segment.elapsed + duration
        reached = segment.path.reach(end, STEPS_OF_A_STEP)
        if reached != end:
            most = reached - segment.elapsed
            allowed = f"up to {most:.6g} s at a time under friction or an applied torque"
            raise refuse("duration", duration, allowed)
        return duration

    def record(self, request: SetBool.Request) -> str:
        """Begin or end a log."""
        return self._log.switch(bool(request.data))

    def get_state(self, _: Trigger.Request) -> str:
        """Return everything as JSON."""
        return json.dumps(state_report(self._course.segment, self._course.stamp))
