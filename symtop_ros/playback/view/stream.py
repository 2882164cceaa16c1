"""Columns of values on the timeline of a recording, which begins with the first sample."""

from __future__ import annotations

from typing import Any

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real, Stamps
from symtop_ros.playback.view import entities


class Stream:
    """A recording with the stamp at which its time is zero."""

    def __init__(self, recording: rr.RecordingStream) -> None:
        self.recording = recording
        self.origin: int | None = None  # that stamp in ns; None before the first sample or event

    def log(self, entity: str, *values: Any, static: bool = False) -> None:
        """Log values at the time that was set."""
        self.recording.log(entity, *values, static=static)

    def set_time(self, stamp: int) -> None:
        """Set the time of an event; events before the first sample are shown at that sample."""
        nanoseconds = max(0, stamp - (self.origin or 0))
        self.recording.set_time(entities.TIMELINE, duration=np.timedelta64(nanoseconds, "ns"))

    def send(self, entity: str, stamps: Stamps, columns: Any) -> None:
        """Send one value for each stamp."""
        durations = (stamps - (self.origin or 0)).astype("timedelta64[ns]")
        times = rr.TimeColumn(entities.TIMELINE, duration=durations)
        self.recording.send_columns(entity, [times], columns)

    def send_scalars(self, entity: str, stamps: Stamps, values: Real) -> None:
        """Send values (n, width) to the lines of a plot."""
        columns = rr.Scalars.columns(scalars=values.ravel())
        self.send(entity, stamps, columns.partition([values.shape[1]] * len(values)))
