"""Columns of values and shapes for a recording, whose timeline begins with the first sample."""

from typing import Any

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real, Stamps
from symtop_ros.playback.view.entities import TIMELINE, lighten
from symtop_ros.playback.view.mesh import Mesh


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
        self.recording.set_time(TIMELINE, duration=np.timedelta64(nanoseconds, "ns"))

    def send(self, entity: str, stamps: Stamps, columns: Any) -> None:
        """Send one value for each stamp."""
        durations = (stamps - (self.origin or 0)).astype("timedelta64[ns]")
        times = rr.TimeColumn(TIMELINE, duration=durations)
        self.recording.send_columns(entity, [times], columns)

    def send_scalars(self, entity: str, stamps: Stamps, values: Real) -> None:
        """Send values (n, width) to the lines of a plot."""
        columns = rr.Scalars.columns(scalars=values.ravel())
        self.send(entity, stamps, columns.partition([values.shape[1]] * len(values)))

    def send_turns(self, entity: str, stamps: Stamps, quaternions: Real) -> None:
        """Send attitudes x, y, z, w (n, 4) of an entity."""
        self.send(entity, stamps, rr.Transform3D.columns(quaternion=quaternions))

    def send_lines(self, entity: str, stamps: Stamps, strips: Real) -> None:
        """Send lines (n, points, 3), one for each stamp."""
        self.send(entity, stamps, rr.LineStrips3D.columns(strips=list(strips)))

    def send_arrows(
        self, entity: str, stamps: Stamps, vectors: Real, places: Real, origins: Any = None
    ) -> None:
        """Send arrows (n, 3) with the places of their labels; origins are the pivot if None."""
        self.send(entity, stamps, rr.Arrows3D.columns(vectors=vectors, origins=origins))
        self.send(f"{entity}/name", stamps, rr.Points3D.columns(positions=places))

    def style_lines(self, entity: str, color: tuple[int, ...], radius: float) -> None:
        """Set the look of the lines of an entity."""
        self.log(entity, rr.LineStrips3D.from_fields(colors=[color], radii=[radius]), static=True)

    def style_arrows(self, entity: str, color: tuple[int, ...], radius: float, label: str) -> None:
        """Set the look of an arrow, and the text of its label.

        The label is a separate point: the label of an arrow would be drawn at its middle.
        """
        self.log(entity, rr.Arrows3D.from_fields(colors=[color], radii=[radius]), static=True)
        self.log_labels(f"{entity}/name", [label], color)

    def log_labels(
        self, entity: str, labels: list[str], color: tuple[int, ...], positions: Real | None = None
    ) -> None:
        """Log texts at points that are too small to be seen."""
        points = rr.Points3D.from_fields(
            positions=positions,
            radii=[0.001],
            colors=[lighten(color)],
            labels=labels,
            show_labels=True,
        )
        self.log(entity, points, static=True)

    def log_mesh(
        self, entity: str, mesh: Mesh, opacity: int | None = None, static: bool = False
    ) -> None:
        """Log a body; it is translucent if an opacity (of 255) is given."""
        body = rr.Mesh3D(
            vertex_positions=mesh.positions,
            vertex_normals=mesh.normals,
            vertex_colors=mesh.colors,
            triangle_indices=mesh.triangles,
            albedo_factor=None if opacity is None else [255, 255, 255, opacity],
        )
        self.log(entity, body, static=static)
