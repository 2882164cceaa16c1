"""A session: a simulation with its outputs, its requests, its recording and its upkeep.

The node and the page are hosts of a session. They translate: ROS, or what is pressed in a browser.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from symtop_ros.log.recorder import Recorder
from symtop_ros.session.diagnostics import collect_statuses
from symtop_ros.session.outputs import OutputHost, Outputs
from symtop_ros.session.recording import Recording
from symtop_ros.session.requests import Requests
from symtop_ros.session.services import SERVICES, Response
from symtop_ros.simulation.changes.initial import initial_state
from symtop_ros.simulation.changes.outcomes import Failure
from symtop_ros.simulation.host import Clock
from symtop_ros.simulation.own_time import simulate
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.validation import attempt


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
    ) -> None:
        self._host = host
        self._recorder = Recorder(settings.record)
        self._outputs = Outputs(settings, host, self._recorder, name)
        self.simulation = simulate(settings, clock, self._outputs, host)
        self._recorder.count_missed = lambda: self.simulation.ticker.missed
        first = self.simulation.timeline.announce(self.simulation.stamp, scene)
        verdict = self.simulation.apply(first)
        metadata = {"scene": scene, **environment}
        self.recording = Recording(self._recorder, self.simulation, metadata)
        self._requests = Requests(self.simulation, self.recording.switch)
        if settings.record.enabled:
            self.recording.begin()
        host.inform(f"scene {scene}: {verdict}")

    def answer(self, service: str, read: Callable[[], Any]) -> Response:
        """Carry out a request; `read` returns its argument, or raises RefusedError."""
        act = SERVICES[service].act
        return self.simulation.answer(service, lambda: act(self._requests, read()))

    def log_torque(self, data: bytes) -> None:
        """Log the bytes of an applied torque, accepted or not."""
        log, simulation = self._outputs.log_torque, self.simulation
        simulation.take_turn("~/applied_torque", lambda: log(simulation.stamp, data))

    def hold_torque(self, torque: Sequence[float], frame: str = "") -> str:
        """Apply a torque (N m) until its time-out; return the reason if it is refused."""
        hold = partial(self.simulation.hold_torque, torque, frame)
        found = self.simulation.take_turn("~/applied_torque", partial(attempt, hold))
        return "" if isinstance(found, Failure) else found[1]

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

    def _keep_up(self) -> None:
        own = self._host.update_statuses()
        self.simulation.speed_up()
        self.recording.report_failure()
        if not self.simulation.segment.running:
            # for those who came while it stands still
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
