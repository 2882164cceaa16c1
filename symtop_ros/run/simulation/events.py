"""Events: every change of a run, with everything that is needed to compute the run again.

Numbers are written in decimals that read back to the same doubles. The sentence of an event stands
next to the fields from which it is made; nothing reads the sentence.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass
from fractions import Fraction
from typing import Any, TypeVar

from symtop_ros import __version__
from symtop_ros.base.refusals import describe_range, one_line, show
from symtop_ros.physics import Friction, Motion, Pushes, State, Top, kernel_version
from symtop_ros.run.simulation.changes.follow import Change
from symtop_ros.run.simulation.changes.outcomes import OUTCOMES, Outcome
from symtop_ros.run.simulation.segment import NO_RIG, Segment
from symtop_ros.run.simulation.sensor.imu import Rig
from symtop_ros.run.wire.diagnostics import (
    OK,
    Status,
    decode_statuses,
    encode_statuses,
    read_fields,
    write_fields,
    write_text,
)
from symtop_ros.words import write

RESTARTS = ("start", "reset")  # names of events after which nothing of the run before counts
KICKS = ("kick", "push")  # names of events by ~/kick
RELEASE = "release"  # name of the event after which pushes no longer follow
PREFIX = "top: "  # of the name of an event as a diagnostic status
FORMAT = "3"  # version of the values of an event
# Events of this format have their request in one text, no number and no outcome. Their motions are
# read; whether they agree with their samples is checked by the version that wrote them.
WITHOUT_FIELDS, LAST_WITHOUT_FIELDS = "2", "0.2.0"
# Limits of the numbers in an event that is read. A log may be damaged or hostile; beyond these
# limits no run of a node can be.
MAX_STAMP = 2**62  # ns; ROS has 32 bits of seconds
MAX_ELAPSED = 1e18  # s of the motion
EXACT = re.compile(r"-?\d{1,400}(/\d{1,400})?")  # a time in ns; doubles need 324 digits
MIN_FACTOR, MAX_FACTOR = 1e-300, 1e6
WHOLE = re.compile(r"-?\d{1,19}")  # a stamp

Number = TypeVar("Number", int, float, Fraction)

# What an event says of the motion and of the segment that follow. This is the only list of them:
# events are made and compared by it, and runs of the page are distinguished by it.
MOTION: dict[str, Callable[[Motion], Any]] = {
    "top": lambda motion: astuple(motion.top),
    "friction": lambda motion: astuple(motion.friction),
    "applied_torque": lambda motion: motion.applied_torque,
    "motion.orientation": lambda motion: motion.start.given_orientation.tolist(),
    "motion.angular_velocity": lambda motion: motion.start.angular_velocity.tolist(),
    # impulse, rate and number of the pushes that it gets from its start on
    "motion.pushes": lambda motion: astuple(motion.pushes) if motion.pushes else (),
    "motion.clamped": lambda motion: motion.clamped,
}
# Fields of the rig on the body: a change of one of them does not change the motion.
BODY = ("gravity", "mass")
SEGMENT: dict[str, Callable[[Segment], Any]] = {
    "motion.stamp": lambda segment: segment.stamp,
    "motion.elapsed": lambda segment: segment.begin_time,
    "motion.elapsed_ns": lambda segment: segment.elapsed,
    "motion.real_time_factor": lambda segment: segment.factor,
    "motion.running": lambda segment: segment.running,
}


def do_nothing() -> None:
    """Let the work continue: nothing else is due."""


@dataclass(frozen=True, slots=True)
class Event:
    """The report of a change, as it is published and logged."""

    stamp: int  # stamp from which the new segment holds, in ns
    # start, kick, push, release, clamp, unclamp, reset, pause, resume, step, parameters, torque,
    # pace, clock, record, failure
    name: str
    verdict: str  # the outcome in a sentence
    # number, request, outcome, the state before and after, and the segment that holds from then on
    values: Mapping[str, str]

    @classmethod
    def of(
        cls,
        change: Change,
        number: int = 1,
        top_frame: str = "top",
        between: Callable[[], object] = do_nothing,
    ) -> "Event":
        """Return the event that reports a change.

        `number` counts the events of a run from 1 on. `top_frame` is the child frame of the top on
        /tf, which is shared by many publishers. `between` is called when the outcome is found, and
        again when the fields are written, before the sentence: each takes longer than a sample may
        wait.
        """
        outcome = change.outcome
        between()
        act = change.act
        segment = change.segment
        before = change.before
        after = segment.state_at(act.stamp)
        motion = segment.motion
        values = {
            "format": FORMAT,
            "number": str(number),
            "top_frame": top_frame,
            **{f"request.{key}": write_text(value) for key, value in act.request.items()},
            **(write_fields("outcome", outcome) if outcome else {}),
            **{name: write_text(read(motion)) for name, read in MOTION.items()},
            **{name: write_text(read(segment)) for name, read in SEGMENT.items()},
            "before.orientation": write_text(before.orientation.tolist()),
            "before.angular_velocity": write_text(before.angular_velocity.tolist()),
            **({} if change.pushes is None else {"before.pushes": str(change.pushes)}),
            "after.orientation": write_text(after.orientation.tolist()),
            "after.angular_velocity": write_text(after.angular_velocity.tolist()),
            **segment.rig.values,
            "kind": motion.kind,
            "engine": motion.engine,
            "kernel_version": kernel_version(),
            "version": __version__,
        }
        between()
        return cls(act.stamp, act.name, write(act.name, outcome) if outcome else "", values)

    def encode(self, frame: str, node: str = "") -> bytes:
        """Encode the event of a node (full name) as a DiagnosticArray with one status."""
        return encode_statuses(
            self.stamp,
            frame,
            [Status(self.stamp, OK, PREFIX + self.name, self.verdict, self.values)],
            node,
        )

    def has_motion_of(self, other: "Event | None") -> bool:
        """Return True if it says the same of the motion itself as another event."""
        return other is not None and all(
            self.values.get(name) == other.values.get(name) for name in (*MOTION, *BODY)
        )

    @property
    def has_fields(self) -> bool:
        """False for an event of a log without numbers, requests and outcomes as fields."""
        return self.values.get("format") != WITHOUT_FIELDS

    @property
    def number(self) -> int:
        """Number of the event in its run, from 1 on; 0 if it is unknown."""
        text = self.values.get("number", "0")
        return int(text) if WHOLE.fullmatch(text) else 0

    @property
    def request(self) -> dict[str, str]:
        """The fields that were asked for, by their names."""
        if not self.has_fields:
            pairs = self.values.get("request", "").split("; ")
            return {name: text for name, _, text in (pair.partition("=") for pair in pairs) if name}
        return {
            name.removeprefix("request."): text
            for name, text in self.values.items()
            if name.startswith("request.")
        }

    @property
    def previous_end(self) -> int:
        """Stamp (ns) up to which the segment before held: a different one if the clock jumped."""
        left = self.request.get("from", "") if self.name == "clock" else ""
        is_stamp = WHOLE.fullmatch(left) and abs(int(left)) <= MAX_STAMP
        return int(left) if is_stamp else self.stamp

    def outcome(self) -> Outcome | None:
        """Return what the event led to; None in a log without fields."""
        kind = OUTCOMES.get(self.name)
        if kind is None or not any(name.startswith("outcome.") for name in self.values):
            return None
        return read_fields("outcome", kind, self.values)

    def segment(self) -> Segment:
        """Return the segment that holds from the event on.

        `event.segment().state_at(stamp)` is the published state at each stamp up to the next event.
        """
        values = self.values
        factor = "motion.real_time_factor"
        try:
            if values["format"] not in (FORMAT, WITHOUT_FIELDS):
                raise ValueError(
                    f"format of an event must be {WITHOUT_FIELDS} or {FORMAT}, got "
                    f"{one_line(values['format'], 20)}"
                )
            return Segment(
                motion=_read_motion(values),
                stamp=_limit(-MAX_STAMP, "motion.stamp", int(values["motion.stamp"]), MAX_STAMP),
                elapsed=_read_elapsed(values["motion.elapsed_ns"]),
                factor=_limit(MIN_FACTOR, factor, float(values[factor]), MAX_FACTOR),
                running=values["motion.running"] == "true",
                rig=Rig.from_values(values),
            )
        except (KeyError, TypeError) as error:
            raise ValueError(
                f"event {self.name!r} must have all values, {error} is missing or incomplete"
            ) from None
        except ArithmeticError:
            raise ValueError(
                f"event {self.name!r} must describe a motion, its numbers are out of range"
            ) from None

    def state(self) -> State:
        """Return the recorded state right after the event (nothing is computed)."""
        return self._read_state("after")

    def state_before(self) -> State:
        """Return the recorded state right before the event (nothing is computed)."""
        return self._read_state("before")

    def _read_state(self, when: str) -> State:
        names = (f"{when}.orientation", f"{when}.angular_velocity")
        return State(*(_numbers(self.values.get(name, "")) for name in names))


def start_event(motion: Motion, rig: Rig = NO_RIG) -> Event:
    """Return the event with which a run of a motion starts at the stamp 0."""
    return Event.of(Change.begin(Segment.begin(motion, 0, 1.0, rig)))


def decode_events(data: bytes) -> list[Event]:
    """Decode the events of a DiagnosticArray: their motions and states, of any version.

    Outcomes are words of the version that reported them, and are read by its check.
    """
    events = [
        Event(status.stamp, status.name.removeprefix(PREFIX), status.message, status.values)
        for status in decode_statuses(data)
    ]
    for event in events:
        event.segment()
        event.state()
        event.state_before()
    return events


def _read_motion(values: Mapping[str, str]) -> Motion:
    body = values["top"], values["motion.orientation"], values["motion.angular_velocity"]
    top, orientation, omega = map(_numbers, body)
    friction = Friction(*_numbers(values["friction"]))
    torque = _numbers(values["applied_torque"])
    given: Any = _numbers(values.get("motion.pushes", ""))  # none in a log of before
    pushes = Pushes(*given) if given else None
    clamped = values.get("motion.clamped") == "true"  # nothing was, in a log of before
    return Motion(Top(*top), State(orientation, omega), friction, torque, pushes, clamped)


def _read_elapsed(text: str) -> Fraction:
    name = "motion.elapsed_ns"
    limit = MAX_ELAPSED * 1e9
    # Fraction itself would also take 1e999999999, and compute it.
    if not EXACT.fullmatch(text):
        raise ValueError(f"{name} must be a whole number of ns or a fraction, got {text[:60]!r}")
    return _limit(-limit, name, Fraction(text), limit)


def _limit(low: float, name: str, value: Number, high: float) -> Number:
    if not low <= value <= high:
        raise ValueError(f"{name} must be {describe_range(low, high)}, got {show(float(value))}")
    return value


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split()]
