"""The log of a node: begun, ended and failed, each with a sentence and an event."""

from __future__ import annotations

from pathlib import Path

from rclpy.impl.rcutils_logger import RcutilsLogger

from symtop_ros.node.course import Course
from symtop_ros.node.fields import RefusedError
from symtop_ros.node.metadata import metadata
from symtop_ros.node.parameters import Settings
from symtop_ros.recording.recorder import Limits, Recorder, reason


def limits(settings: Settings) -> Limits:
    """Return when a new file begins."""
    return Limits(settings["record.max_size"], settings["record.max_duration"])


class Log:
    """Begins and ends recordings.

    Parameters
    ----------
    recorder : Recorder
    course : Course
        What is recorded.
    scene : str
    logger : RcutilsLogger
    """

    def __init__(
        self, recorder: Recorder, course: Course, scene: str, logger: RcutilsLogger
    ) -> None:
        self._recorder, self._course = recorder, course
        self._scene, self._logger = scene, logger
        self._failure_told = False

    def begin(self) -> Path:
        """Begin a file and return its path; RefusedError where that cannot be."""
        settings = self._course.settings
        try:
            facts = metadata(self._scene, settings.values, self._course.now)
            path = self._recorder.start(facts)
        except (OSError, ImportError) as error:
            msg = f"record: no log in {settings['record.directory']!r}: {reason(error)}"
            raise RefusedError(msg) from None
        self._failure_told = False
        self._logger.info(f"recording to {path}")
        return path

    def switch(self, on: bool) -> str:
        """Begin or end a recording; return what was done."""
        self.report_failure()
        path = self._recorder.path
        if on == bool(path):
            return f"recording already, to {path}" if path else "not recording"
        if path:
            self._note(f"recording to {path} ended")
            self._recorder.stop()
            if self._recorder.failure:
                self.report_failure()
                msg = f"record: {self._recorder.failure}"
                raise RefusedError(msg)
            return f"recorded to {path}"
        return self._note(f"recording to {self.begin()}")

    @property
    def untold(self) -> str:
        """Why a recording failed, as long as nobody was told."""
        return "" if self._failure_told else self._recorder.failure

    def report_failure(self) -> None:
        """Say once that a recording has ended by itself; the motion goes on."""
        if self.untold:
            self._failure_told = True
            self._logger.error(self._note(f"recording stopped: {self._recorder.failure}"))

    def _note(self, sentence: str) -> str:
        return self._course.change("record", self._course.segment, {}, sentence)
