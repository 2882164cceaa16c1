"""Events: what changed a run, and all that is needed to compute it again.

Numbers are written in decimals that read back to the same doubles.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.run.segment import Segment

PREFIX = "top: "  # of the name of an event, where it is the status of a message
LATEST = 2**62  # ns; ROS has 32 bits of seconds
LONGEST = 1e18  # s of motion
SLOWEST, FASTEST = 1e-300, 1e6  # seconds of motion per second

Number = TypeVar("Number", int, float)


@dataclass(frozen=True, slots=True)
class Event:
    """One event of a run.

    Attributes
    ----------
    stamp : int
        The instant from which the new motion holds, ns.
    name : str
        start, kick, reset, pause, resume, step, parameters, torque, pace, clock or record.
    verdict : str
        What follows, in a sentence.
    values : mapping
        What was asked, the state before and after, and the motion that holds from then on.
    """

    stamp: int
    name: str
    verdict: str
    values: Mapping[str, str]

    @classmethod
    def of(
        cls,
        stamp: int,
        name: str,
        verdict: str,
        request: Mapping[str, Any],
        before: State,
        now: Segment,
    ) -> Event:
        """Return the event after which the segment `now` holds."""
        after, path = now.state_at(stamp), now.path
        values = {
            "request": "; ".join(f"{key}={_text(value)}" for key, value in request.items()),
            "top": _text(path.top.moments),
            "friction": _text((path.friction.axial, path.friction.transverse)),
            "applied_torque": _text(path.applied_torque),
            "before.orientation": _text(before.orientation.tolist()),
            "before.angular_velocity": _text(before.angular_velocity.tolist()),
            "after.orientation": _text(after.orientation.tolist()),
            "after.angular_velocity": _text(after.angular_velocity.tolist()),
            "motion.orientation": _text(path.start.orientation.tolist()),
            "motion.angular_velocity": _text(path.start.angular_velocity.tolist()),
            "motion.stamp": _text(now.stamp),
            "motion.elapsed": _text(now.elapsed),
            "motion.real_time_factor": _text(now.factor),
            "motion.running": _text(now.running),
            "kind": path.kind,
            "engine": path.engine,
        }
        return cls(stamp, name, verdict, values)

    def segment(self) -> Segment:
        """Return the segment that holds from the event on: the run again, bit for bit.

        The state at any later stamp, up to the next event, is `event.segment().state_at(stamp)`.

        Raises
        ------
        ValueError
            Where a value is missing or is not what it should be.
        """
        try:
            return self._segment()
        except (KeyError, TypeError) as error:
            msg = f"event {self.name!r}: {error} is missing or incomplete"
            raise ValueError(msg) from None
        except ArithmeticError:
            msg = f"event {self.name!r}: no motion has such numbers"
            raise ValueError(msg) from None

    def state(self) -> State:
        """Return the state right after the event, as it was told: nothing is computed.

        Raises
        ------
        ValueError
            Where it is missing or is not what it should be.
        """
        names = ("after.orientation", "after.angular_velocity")
        return State(*(_numbers(self.values.get(name, "")) for name in names))

    def _segment(self) -> Segment:
        values = self.values
        start = State(
            _numbers(values["motion.orientation"]), _numbers(values["motion.angular_velocity"])
        )
        return Segment(
            path=motion(
                Top(*_numbers(values["top"])),
                start,
                Friction(*_numbers(values["friction"])),
                _numbers(values["applied_torque"]),
            ),
            stamp=_within(-LATEST, "motion.stamp", int(values["motion.stamp"]), LATEST),
            elapsed=_within(-LONGEST, "motion.elapsed", float(values["motion.elapsed"]), LONGEST),
            factor=_within(
                SLOWEST,
                "motion.real_time_factor",
                float(values["motion.real_time_factor"]),
                FASTEST,
            ),
            running=values["motion.running"] == "true",
        )


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return " ".join(repr(float(part)) for part in value)
    return repr(value) if isinstance(value, float) else str(value)


def _within(low: float, name: str, value: Number, high: float) -> Number:
    if not low <= value <= high:
        msg = f"{name}: got {value:.6g}, allowed is {low:.6g} to {high:.6g}"
        raise ValueError(msg)
    return value


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split()]
