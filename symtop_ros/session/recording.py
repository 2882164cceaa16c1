"""Recordings of a simulation: begun, ended and failed, each with a sentence and an event."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Literal

from symtop_ros import __version__
from symtop_ros.log.recorder import Recorder, describe_error
from symtop_ros.simulation.changes.outcomes import Record
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wording import write


class Recording:
    """Begins and ends recordings of a simulation."""

    def __init__(
        self, recorder: Recorder, simulation: Simulation, environment: Mapping[str, str]
    ) -> None:
        self._recorder, self._simulation = recorder, simulation
        self._host, self._environment = simulation.host, environment
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
            package = str(error.name).partition(".")[0]
            raise RefusedError(
                f"{package} must be installed for a recording, got none: pip install {package}, "
                "on Debian and Ubuntu into a venv (docs/ros.md, Installing)"
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
        self.report_failure()
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

    kind: Literal["recorded", "recording", "not_recording", "paused", "running"]
    path: str = ""  # of the log

    def __str__(self) -> str:
        """Return the answer in words."""
        return write("answer", self)
