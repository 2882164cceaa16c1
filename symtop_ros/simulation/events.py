"""Events: every change of a run, with everything that is needed to compute the run again.

Numbers are written in decimals that read back to the same doubles.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeVar

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.simulation.segment import NO_RIG, Segment
from symtop_ros.simulation.sensor import Rig
from symtop_ros.simulation.validation import one_line
from symtop_ros.wire.diagnostics import OK, Status, decode_statuses, encode_statuses

RESTARTS = ("start", "reset")  # names of events after which nothing of the run before counts
PREFIX = "top: "  # of the name of an event as a diagnostic status
FORMAT = "2"  # version of the values of an event
# Limits of the numbers in an event that is read. A log may be damaged or hostile; beyond these
# limits no run of a node can be.
MAX_STAMP = 2**62  # ns; ROS has 32 bits of seconds
MAX_ELAPSED = 1e18  # s of the motion
EXACT = re.compile(r"-?\d{1,400}(/\d{1,400})?")  # a time in ns; doubles need 324 digits
MIN_FACTOR, MAX_FACTOR = 1e-300, 1e6
LEFT = re.compile(r"from=(-?\d{1,19});")  # in the request of a jump of the clock

Number = TypeVar("Number", int, float, Fraction)


@dataclass(frozen=True, slots=True)
class Event:
    """A change of a run."""

    stamp: int  # stamp from which the new segment holds, in ns
    # start, kick, reset, pause, resume, step, parameters, torque, pace, clock, record,
    # failure
    name: str
    verdict: str  # the consequence of the change, in a sentence
    # the request, the state before and after, and the segment that holds from then on
    values: Mapping[str, str]

    @classmethod
    def of(
        cls,
        stamp: int,
        name: str,
        verdict: str,
        request: Mapping[str, Any],
        before: State,
        following: Segment,
        top_frame: str = "top",
    ) -> "Event":
        """Return the event after which the segment `following` holds.

        `top_frame` is the child frame of the top on /tf, which is shared by many publishers.
        """
        after, motion = following.state_at(stamp), following.motion
        values = {
            "format": FORMAT,
            "top_frame": top_frame,
            "request": "; ".join(f"{key}={_text(value)}" for key, value in request.items()),
            "top": _text(motion.top.moments),
            "friction": _text((motion.friction.axial, motion.friction.transverse)),
            "applied_torque": _text(motion.applied_torque),
            "before.orientation": _text(before.orientation.tolist()),
            "before.angular_velocity": _text(before.angular_velocity.tolist()),
            "after.orientation": _text(after.orientation.tolist()),
            "after.angular_velocity": _text(after.angular_velocity.tolist()),
            "motion.orientation": _text(motion.start.given_orientation.tolist()),
            "motion.angular_velocity": _text(motion.start.angular_velocity.tolist()),
            "motion.stamp": _text(following.stamp),
            "motion.elapsed": _text(following.time_at(following.stamp)),
            "motion.elapsed_ns": str(following.elapsed),
            "motion.real_time_factor": _text(following.factor),
            "motion.running": _text(following.running),
            **following.rig.to_values(),
            "kind": motion.kind,
            "engine": motion.engine,
        }
        return cls(stamp, name, verdict, values)

    def encode(self, frame: str) -> bytes:
        """Encode the event as a DiagnosticArray with one status."""
        status = Status(self.stamp, OK, PREFIX + self.name, self.verdict, self.values)
        return encode_statuses(self.stamp, frame, [status])

    @property
    def previous_end(self) -> int:
        """Stamp (ns) up to which the segment before held: another one if the clock jumped."""
        left = LEFT.match(self.values.get("request", "")) if self.name == "clock" else None
        return int(left[1]) if left else self.stamp

    def segment(self) -> Segment:
        """Return the segment that holds from the event on.

        `event.segment().state_at(stamp)` is the published state at each stamp up to the next event.
        """
        try:
            return self._segment()
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

    def _segment(self) -> Segment:
        values = self.values
        start = State(
            _numbers(values["motion.orientation"]), _numbers(values["motion.angular_velocity"])
        )
        factor = "motion.real_time_factor"
        if values["format"] != FORMAT:
            raise ValueError(
                f"format of an event must be {FORMAT}, got {one_line(values['format'], 20)}"
            )
        return Segment(
            motion=Motion(
                Top(*_numbers(values["top"])),
                start,
                Friction(*_numbers(values["friction"])),
                _numbers(values["applied_torque"]),
            ),
            stamp=_limit(-MAX_STAMP, "motion.stamp", int(values["motion.stamp"]), MAX_STAMP),
            elapsed=_read_elapsed(values["motion.elapsed_ns"]),
            factor=_limit(MIN_FACTOR, factor, float(values[factor]), MAX_FACTOR),
            running=values["motion.running"] == "true",
            rig=Rig.from_values(values),
        )


def start_event(motion: Motion, rig: Rig = NO_RIG) -> Event:
    """Return the event with which a run of a motion starts at the stamp 0."""
    segment = Segment.begin(motion, 0, 1.0, rig)
    return Event.of(0, "start", "", {}, motion.start, segment)


def decode_events(data: bytes) -> list[Event]:
    """Decode the events of a DiagnosticArray."""
    events = [
        Event(status.stamp, status.name.removeprefix(PREFIX), status.message, status.values)
        for status in decode_statuses(data)
    ]
    for event in events:
        event.segment()
        event.state()
        event.state_before()
    return events


def _read_elapsed(text: str) -> Fraction:
    name, limit = "motion.elapsed_ns", MAX_ELAPSED * 1e9
    # Fraction itself would also take 1e999999999, and compute it.
    if not EXACT.fullmatch(text):
        raise ValueError(f"{name} must be a whole number of ns or a fraction, got {text[:60]!r}")
    return _limit(-limit, name, Fraction(text), limit)


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return " ".join(repr(float(part)) for part in value)
    return repr(value) if isinstance(value, float) else str(value)


def _limit(low: float, name: str, value: Number, high: float) -> Number:
    if not low <= value <= high:
        raise ValueError(f"{name} must be {low:.6g} to {high:.6g}, got {float(value):.6g}")
    return value


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split()]
