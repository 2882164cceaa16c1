"""Events: what changed the run, and all that is needed to compute it again.

Numbers are written in decimals that read back to the same doubles.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Header

from symtop_ros.node.segment import Segment
from symtop_ros.physics import State, Top, motion


def event(
    header: Header, name: str, verdict: str, request: Mapping[str, Any], before: State, now: Segment
) -> DiagnosticArray:
    """Return the message of one event; its stamp is the instant from which `now` holds."""
    top, after = now.path.top, now.path.at(now.elapsed)
    start = now.path.start
    values = {
        "request": "; ".join(f"{key}={_text(value)}" for key, value in request.items()),
        "top": _text(top.moments),
        "before.orientation": _text(before.orientation.tolist()),
        "before.angular_velocity": _text(before.angular_velocity.tolist()),
        "after.orientation": _text(after.orientation.tolist()),
        "after.angular_velocity": _text(after.angular_velocity.tolist()),
        "motion.orientation": _text(start.orientation.tolist()),
        "motion.angular_velocity": _text(start.angular_velocity.tolist()),
        "motion.elapsed": _text(now.elapsed),
        "motion.real_time_factor": _text(now.factor),
        "motion.running": _text(now.running),
        "kind": now.path.kind,
    }
    status = DiagnosticStatus(
        level=DiagnosticStatus.OK,
        name=f"top: {name}",
        message=verdict,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )
    return DiagnosticArray(header=header, status=[status])


def segment_of(message: DiagnosticArray) -> Segment:
    """Return the segment that an event began: the run again, bit for bit.

    The state at any later stamp, up to the next event, is `segment_of(message).state_at(stamp)`.
    """
    values = {pair.key: pair.value for pair in message.status[0].values}
    Ix, Iz, Mgl = _numbers(values["top"])
    orientation = _numbers(values["motion.orientation"])
    start = State(orientation, _numbers(values["motion.angular_velocity"]))
    stamp = message.header.stamp
    return Segment(
        path=motion(Top(Ix, Iz, Mgl), start),
        stamp=stamp.sec * 1_000_000_000 + stamp.nanosec,
        elapsed=float(values["motion.elapsed"]),
        factor=float(values["motion.real_time_factor"]),
        running=values["motion.running"] == "true",
    )


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return " ".join(repr(float(part)) for part in value)
    return repr(value) if isinstance(value, float) else str(value)


def _numbers(text: str) -> list[float]:
    return [float(part) for part in text.split()]
