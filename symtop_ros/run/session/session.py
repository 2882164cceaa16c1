"""A session: a simulation with its outputs, its requests, its recording and its upkeep.

A host of a session translates: the node between it and ROS, a run of the page into its log.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import partial
from pathlib import Path
from typing import Any, Literal

from symtop_ros import __version__
from symtop_ros.base.missing import find_package, name_remedy
from symtop_ros.base.refusals import (
    RefusedError,
    attempt,
    number,
    refuse,
    show_limit,
    validate_names,
)
from symtop_ros.run.log.recorder import Recorder, describe_error
from symtop_ros.run.session.diagnostics import (
    collect_statuses,
    failure_status,
    log_status,
    summarize_state,
)
from symtop_ros.run.session.outputs import OutputHost, Outputs
from symtop_ros.run.session.services import SERVICES, Response, end_with_event
from symtop_ros.run.simulation.budget import StepBudget
from symtop_ros.run.simulation.changes.follow import Act
from symtop_ros.run.simulation.changes.outcomes import Failure, Record
from symtop_ros.run.simulation.changes.requests import initial_state, name_kick
from symtop_ros.run.simulation.host import Clock
from symtop_ros.run.simulation.own_time import simulate
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.simulation import Simulation
from symtop_ros.words import write

MAX_STEP = 1e9  # s of the motion
STEPS_OF_A_REQUEST = 1_000  # integration steps; samples wait for up to 0.1 s

Values = Mapping[str, Any]


class Session:
    """A run from the start of its program to the end. Methods may be called from any thread."""

    def __init__(
        self,
        settings: Settings,
        clock: Clock,
        host: OutputHost,
        scene: str,
        environment: Mapping[str, str],
        name: str = "/top",
        points: str = "",  # as for `Outputs`
    ) -> None:
        self._host = host
        self._recorder = Recorder(settings.record)
        self._outputs = Outputs(settings, host, self._recorder, name, points)
        self.simulation = simulate(settings, clock, self._outputs, host)
        self._recorder.count_missed = lambda: self.simulation.ticker.missed
        verdict = self.simulation.apply(self.simulation.timeline.announce(scene))
        about = {"node": name, "scene": scene, **environment}
        self.recording = Recording(self._recorder, self.simulation, about)
        self._requests = Requests(self.simulation, self.recording.switch)
        if settings.record.enabled:
            self.recording.begin()
        if settings.start_paused:
            self.simulation.begin_paused()
        host.inform(f"scene {scene}. {verdict}")

    def answer(self, service: str, read: Callable[[], Any]) -> Response:
        """Carry out a request; `read` returns its argument, or raises RefusedError.

        A granted answer ends with the number of its event, or of the latest event if the request
        changed nothing. The answer of `~/get_state` is JSON, and has this number as a field.
        """
        act = self._requests.find(service, read)
        if service != "get_state":
            act = partial(self._add_number, act)
        return self.simulation.answer(service, act)

    def _add_number(self, act: Callable[[], str]) -> str:
        self.recording.report_failure()  # an event of its own
        latest = self.simulation.event_number
        text = act()
        # A step in the time of the run is followed by other events.
        number = min(latest + 1, self.simulation.event_number)
        return end_with_event(text, number)

    def log_torque(self, data: bytes) -> None:
        """Log the bytes of an applied torque, accepted or not."""
        log = self._outputs.log_torque
        simulation = self.simulation
        simulation.take_turn("~/applied_torque", lambda: log(simulation.stamp, data))

    def hold_torque(self, torque: Sequence[float], frame: str = "") -> str:
        """Apply a torque (N m) until its time-out; return the reason if it is refused."""
        hold = partial(self.simulation.hold_torque, torque, frame)
        found = self.simulation.take_turn("~/applied_torque", partial(attempt, hold))
        if isinstance(found, Failure):  # reported, unless it has ended the run long ago
            return str(self.simulation.failure or "")
        return found[1]

    def plan_settings(self, changes: Mapping[str, Any]) -> Settings:
        """Return the settings with changed values; raise RefusedError if they do not fit."""
        settings = Settings.from_values({**self.simulation.settings.values, **changes})
        initial_state(settings.top, settings.initial, {})  # may have no such root
        # the motion that follows may be too fast
        self.simulation.timeline.change_settings(settings, self.simulation.stamp)
        return settings

    def apply_settings(self, changes: Mapping[str, Any]) -> None:
        """Continue with changed values, in a turn of the caller."""
        settings = self.plan_settings(changes)
        self._outputs.enable_tf(settings.publish_tf)
        self._recorder.settings = settings.record
        self.simulation.apply_settings(settings)

    def keep_up(self) -> None:
        """Do what is due once a second: pace, failed recordings, diagnostics."""
        self.simulation.take_turn("/diagnostics", self._keep_up)
        if failure := self.simulation.failure:
            self._report_end(failure)

    def _report_end(self, failure: Failure) -> None:
        """Complete the log, and say why there are no more samples.

        What failed may be the outputs; the program around the run continues.
        """
        with self.simulation.turns, suppress(Exception):
            self._recorder.stop()
            self._outputs.send_diagnostics(
                self.simulation.now,
                lambda: [
                    failure_status(failure, self.simulation.event_number),
                    log_status(self._recorder),
                    *self._host.update_statuses(),
                ],
            )

    def _keep_up(self) -> None:
        own = self._host.update_statuses()
        self.simulation.measure_pace()
        self.simulation.speed_up()
        self.recording.report_failure()
        if not self.simulation.segment.running:
            # for requests that came while the motion stands still
            self._outputs.send_clock(self.simulation.now)
        self._outputs.send_diagnostics(
            self.simulation.stamp,
            lambda: [*collect_statuses(self.simulation, self._recorder), *own],
        )

    def await_recorder(self) -> None:
        """Wait while the recorder lags behind: for a run that is faster than its clock."""
        self._recorder.await_room()

    def close(self) -> None:
        """End the recording."""
        self._recorder.stop()


@dataclass(frozen=True)
class Requests:
    """Requests to a simulation, from plain values. Each service has a method of its name.

    Call them in a turn. Each returns the text of its answer and raises RefusedError if it is
    refused; the motion is then unchanged.
    """

    _simulation: Simulation
    record: Callable[[bool], str]

    def find(self, service: str, read: Callable[[], Any]) -> Callable[[], str]:
        """Return what carries out a request to a service; `read` returns its argument."""
        act: Callable[..., str] = getattr(self, service)
        return act if SERVICES[service].kind == "plain" else lambda: act(read())

    def set_initial_conditions(self, values: Values) -> str:
        """Restart from named values; see `initial_state`."""
        simulation = self._simulation
        return simulation.apply_at_once(simulation.timeline.restart(simulation.stamp, values))

    def reset(self) -> str:
        """Restart from the last initial conditions."""
        simulation = self._simulation
        return simulation.apply_at_once(simulation.timeline.restart(simulation.stamp))

    def kick(self, values: Values) -> str:
        """Kick by named values; see `plan_kick` and `plan_pushes`."""
        return self._follow(name_kick(values), values)

    def release(self) -> str:
        """End the pushes that the motion would still get."""
        return self._follow("release", {})

    def clamp(self, held: bool) -> str:
        """Hold the precession by hand, or let it go."""
        if held == self._simulation.segment.motion.clamped:
            return str(Answer("clamped" if held else "free"))
        return self._follow("clamp" if held else "unclamp", {})

    def _follow(self, name: str, values: Values) -> str:
        simulation = self._simulation
        act = Act(name, simulation.stamp, values)
        return simulation.apply_at_once(simulation.timeline.follow(act, simulation.state))

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
            longest = segment.motion._reach(end, 0) - segment.time_at(segment.stamp)
            driven = "in one step under friction or an applied torque"
            raise refuse("duration", f"up to {show_limit(longest)} s {driven}", duration)
        return duration

    def get_state(self) -> str:
        """Return the state, the constants of motion and the verdict as JSON."""
        simulation = self._simulation
        since = simulation.timeline.since
        state = summarize_state(simulation.segment, simulation.stamp, since)
        return json.dumps({**state, "event": simulation.event_number})


class Recording:
    """Begins and ends recordings of a simulation."""

    def __init__(
        self, recorder: Recorder, simulation: Simulation, environment: Mapping[str, str]
    ) -> None:
        self._recorder, self._simulation = recorder, simulation
        self._host = simulation.host
        self._environment = environment
        self._failure_reported = False

    def begin(self) -> Path:
        """Begin a recording and return the path of its file."""
        try:
            path = self._recorder.start(self._metadata())
        except OSError as error:
            directory = self._simulation.settings.record.directory
            msg = f"record.directory must be a writable folder, got {directory!r}: "
            raise RefusedError(msg + describe_error(error)) from None
        except ModuleNotFoundError as error:
            raise RefusedError(
                f"{find_package(str(error.name))} must be installed for a recording, got none: "
                f"{name_remedy(str(error.name))}"
            ) from None
        self._failure_reported = False
        self._host.inform(f"recording to {path}")
        return path

    @property
    def path(self) -> Path | None:
        """Path of the current file, None if not recording."""
        return self._recorder.path

    def switch(self, on: bool) -> str:
        """Begin or end a recording; return the answer."""
        path = self._recorder.path
        if on == bool(path):
            return str(Answer("recording", str(path)) if path else Answer("not_recording"))
        if path:
            self._simulation.do("record", {}, Record("ended", str(path)))
            self._recorder.stop()
            if self._recorder.failure:
                self.report_failure()
                raise RefusedError(f"recording failed: {self._recorder.failure}")
            return str(Answer("recorded", str(path)))
        return self._simulation.do("record", {}, Record("begun", str(self.begin())))

    @property
    def unreported_failure(self) -> str:
        """Reason why a recording ended by itself, until `report_failure` has reported it."""
        return "" if self._failure_reported else self._recorder.failure

    def report_failure(self) -> None:
        """Report once that a recording ended by itself; the motion keeps running."""
        if self.unreported_failure:
            self._failure_reported = True
            outcome = Record("stopped", failure=self._recorder.failure)
            self._host.report_error(self._simulation.do("record", {}, outcome))

    def _metadata(self) -> dict[str, str]:
        values = self._simulation.settings.values
        return {
            "version": __version__,
            **{f"parameter.{name}": str(value) for name, value in values.items()},
            "clock.host": datetime.now(timezone.utc).isoformat(),
            "clock.node": str(self._simulation.now),
            "missed": str(self._simulation.ticker.missed),
            **self._environment,
        }


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer; `str` of it is its text."""

    kind: Literal["recorded", "recording", "not_recording", "paused", "running", "clamped", "free"]
    path: str = ""  # of the log

    def __str__(self) -> str:
        """Return the answer in words."""
        return write("answer", self)
