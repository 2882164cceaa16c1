"""Messages that are rare, made by rclpy; those of every sample are packed by `wire`."""

from __future__ import annotations

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Header

from symtop_ros.run.events import Event


def header(stamp: int, frame: str) -> Header:
    """Return the header of a stamp in ns."""
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=frame)


def event_message(event: Event, frame: str) -> DiagnosticArray:
    """Return the message of an event."""
    status = DiagnosticStatus(
        level=DiagnosticStatus.OK,
        name=f"top: {event.name}",
        message=event.verdict,
        values=[KeyValue(key=key, value=value) for key, value in event.values.items()],
    )
    return DiagnosticArray(header=header(event.stamp, frame), status=[status])
