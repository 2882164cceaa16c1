"""The log that a node would have written of a run of the page: run.json as MCAP.

The run is done again: a session with its own clock gets the same starts, kicks and changes at
the same nanoseconds, and records what it publishes.
"""

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Motion
from symtop_ros.run.session.outputs import Publisher
from symtop_ros.run.session.session import Session
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.events import KICKS
from symtop_ros.run.simulation.points import Points
from symtop_ros.run.simulation.run_file import RATE, RunEvent
from symtop_ros.run.simulation.settings import Settings, list_body
from symtop_ros.run.simulation.topics import Topic
from symtop_ros.run.wire.diagnostics import Status
from symtop_ros.run.wire.layout import NANOSECONDS

NODE = "/top"  # name of the node that would have written the log
CLAMPED = "initial.clamped"
Values = Mapping[str, Any]
# A run may be of another version of the kernel, whose states may differ by rounding, and an event
# of a node may be half a nanosecond away from its place in the run.
ROUNDING, HALF_NANOSECOND = 1e-9, 0.5e-9


class SetClock:
    """The time of the run, which the writer sets."""

    now = steady = 0
    is_simulated = True


class Silent:
    """The host of a session without a user."""

    is_open = True

    def __init__(self) -> None:
        self.failures: list[str] = []

    def resolve(self, topic: Topic) -> str:
        """Return the name of a topic of the node."""
        return topic.resolve(NODE)

    def create_publisher_of(self, topic: Topic) -> Publisher | None:
        """Return None: topics are only logged."""

    def update_statuses(self) -> list[Status]:
        """Return no statuses."""
        return []

    def inform(self, text: str) -> None:
        """Do nothing: the log has it."""

    def warn(self, text: str) -> None:
        """Keep a warning: the motion could not be followed."""
        self.failures.append(text)

    report_error = warn

    def fail(self, failure: Failure) -> None:
        """Keep the reason for which the run ended."""
        self.failures.append(str(failure))


def write_run_log(
    events: Sequence[RunEvent],
    end: int,
    path: Path,
    rate: float = RATE,
    points: Points | None = None,
) -> None:
    """Write the log of a run that has reached a time in ns, in samples per second.

    Measured points become a message of their own, which bags keep as well.

    Raises
    ------
    RefusedError
        If an event is not what a node makes of the request, or the motion cannot be followed.
    OSError
        If the file cannot be written.
    """
    with tempfile.TemporaryDirectory(dir=path.absolute().parent) as folder:
        seen = json.dumps(points.to_json()) if points else ""
        again = _Again(events[0], rate, folder, seen)
        for place, event in enumerate(events):
            again.go(event.time)
            again.do(event, f"events[{place}]", is_first=place == 0)
        again.go(end + 1)  # with the sample at the end
        os.replace(again.close(), path)


class _Again:
    """A run that is done again."""

    def __init__(self, first: RunEvent, rate: float, folder: str, points: str) -> None:
        self._clock, self._host = SetClock(), Silent()
        self._session = Session(
            Settings.from_values(
                {
                    **_list_values(first.motion, first.mass, first.gravity),
                    **{f"initial.{name}": value for name, value in _start_values(first).items()},
                    CLAMPED: first.motion.clamped,
                    "publish_rate": rate,
                    "record.enabled": True,
                    "record.directory": folder,
                }
            ),
            self._clock,
            self._host,
            "run.json",
            {"program": "top_replay"},
            NODE,
            points,
        )
        self._simulation = self._session.simulation
        self._told = 0  # s of the last diagnostics
        self._clock.now = -1  # events at one time come before the sample at that time

    def go(self, time: int) -> None:
        """Publish what is due before a time in ns, with diagnostics once a second."""
        now = self._clock.now
        step = NANOSECONDS // 4  # ns; so near that the recorder keeps up
        for stamp in chain(range((now // step + 1) * step, time, step), [max(time - 1, now)]):
            self._clock.now = stamp
            self._publish()
            if stamp // NANOSECONDS > self._told:
                self._told = stamp // NANOSECONDS
                self._session.keep_up()

    def _publish(self) -> None:
        while self._simulation.stamp <= self._clock.now:
            self._simulation.tick()
            self._session.await_recorder()
        if self._host.failures:
            raise RefusedError(f"the run cannot be computed: {self._host.failures[0]}")

    def do(self, event: RunEvent, name: str, *, is_first: bool) -> None:
        """Do what an event says, at its time."""
        if not is_first:
            segment = self._simulation.segment
            old = _list_values(segment.motion, segment.rig.mass, segment.rig.gravity)
            new = _list_values(event.motion, event.mass, event.gravity)
            self._simulation.restart_grid(event.time)
            if event.kind == "start":
                self._prepare_start(event.motion)
            if changes := {key: value for key, value in new.items() if value != old[key]}:
                self._session.apply_settings(changes)
            self._ask(event, name)
        self._compare(event, name)

    def _prepare_start(self, motion: Motion) -> None:
        """Set whether a start is clamped, and release a clamp if forces are to act."""
        if self._simulation.settings.initial.clamped != motion.clamped:
            self._session.apply_settings({CLAMPED: motion.clamped})
        is_forced = motion.friction or any(motion.applied_torque)
        if self._simulation.segment.motion.clamped and is_forced:
            self._session.answer("clamp", lambda: False)

    def _ask(self, event: RunEvent, name: str) -> None:
        if event.kind in KICKS:
            granted, answer = self._session.answer("kick", lambda: event.act)
        elif event.kind in ("clamp", "unclamp"):
            granted, answer = self._session.answer("clamp", lambda: event.motion.clamped)
        elif event.kind == "start":
            granted, answer = self._session.answer(
                "set_initial_conditions", lambda: _start_values(event)
            )
        else:
            return
        if not granted:
            raise RefusedError(f"{name}: {answer}")

    def _compare(self, event: RunEvent, name: str) -> None:
        """Refuse an event whose motion is not the one that follows.

        A change that was undone while the motion stood still is no change here.
        """
        right = self._simulation.segment.state_at(event.time)
        given = event.motion.at(0.0)
        rate = float(np.abs(right.angular_velocity).max())
        near = ROUNDING + HALF_NANOSECOND * rate
        turned = min(
            float(np.abs(right.orientation - sign * given.orientation).max()) for sign in (1, -1)
        )
        changed = float(np.abs(right.angular_velocity - given.angular_velocity).max())
        if turned > near or changed > near * max(1.0, rate):
            raise RefusedError(
                f"{name}: angular_velocity must be the state after the {event.kind} "
                f"({right.angular_velocity.tolist()} rad/s), got {given.angular_velocity.tolist()}"
            )

    def close(self) -> Path:
        """End the recording; return the path of its file."""
        path = self._session.recording.path
        self._session.close()
        failure = self._session.recording.unreported_failure
        if failure or path is None:
            raise RefusedError(f"the log cannot be written: {failure}")
        return path


def _start_values(event: RunEvent) -> dict[str, Any]:
    """Return the fields of ~/set_initial_conditions with the exact doubles of a start."""
    start = event.motion.start
    w, x, y, z = start.given_orientation.tolist()
    return {
        "orientation": [x, y, z, w],
        "angular_velocity": start.angular_velocity.tolist(),
    }


def _list_values(motion: Motion, mass: float, gravity: float) -> Values:
    """Return the parameters that say what moves, and what acts on it."""
    body = {**list_body(motion), "mass": mass, "gravity": gravity}
    return {**body, "steady_torque": list(motion.applied_torque)}
