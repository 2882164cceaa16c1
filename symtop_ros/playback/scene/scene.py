"""Batches of a run into a Rerun recording, in columns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from symtop_ros.physics import Top
from symtop_ros.playback.batch import Batch, Columns
from symtop_ros.playback.scene import paths, quantities, surroundings
from symtop_ros.playback.scene.blueprint import blueprint
from symtop_ros.playback.scene.colors import BLUE, GOLD, GREEN, ORANGE, RED
from symtop_ros.playback.scene.framing import Framing
from symtop_ros.playback.scene.mesh import top_mesh
from symtop_ros.playback.scene.panel import panel
from symtop_ros.playback.scene.trace import Trace
from symtop_ros.run.events import Event
from symtop_ros.run.segment import Segment

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]
EPS = float(np.finfo(float).eps)


class Arrow(NamedTuple):
    """How a vector is drawn: `length` is that of the first one, in scene units."""

    path: str
    label: str
    unit: str
    color: tuple[int, int, int]
    length: float
    first: int  # of the three numbers among those of the topic


ARROWS = {
    "angular_momentum": Arrow(paths.MOMENTUM, "L", "N m s", BLUE, 1.45, 0),
    "angular_velocity": Arrow(paths.VELOCITY, "omega", "rad/s", GREEN, 1.2, 3),
    "torque": Arrow(paths.TORQUE, "torque", "N m", RED, 0.6, 3),
}
LINES = {
    paths.THETA: (["theta"], [GOLD]),
    paths.PHI_DOT: (["phi'"], [ORANGE]),
    paths.PSI_DOT: (["psi'"], [GREEN]),
    paths.L: (["L_x'", "L_y'", "L_z'"], [RED, GREEN, BLUE]),
    paths.L_HORIZONTAL: (["L\u00b2 - L_z'\u00b2"], [BLUE]),
    paths.DRIFT: (["E", "L_z", "L_z'"], [GOLD, RED, BLUE]),
}


class Scene:
    """A recording of one top.

    Parameters
    ----------
    recording : RecordingStream
        Where everything goes.
    live : bool
        Whether the newest sample is what matters, or the whole run.
    """

    def __init__(self, recording: rr.RecordingStream, live: bool = False) -> None:
        self._recording, self._live = recording, live
        self._origin: int | None = None
        self._segment: Segment | None = None
        self._framing: Framing | None = None
        self._top: Top | None = None
        self._scales: dict[
            str, float
        ] = {}  # of the arrows: units of the vector in one of the scene
        self._reference: Real | None = None  # constants of motion when the segment began
        self._trace = Trace()
        self._style()

    def send(self, batch: Batch) -> None:
        """Add a batch; of numbers that cannot be drawn nothing is seen."""
        with np.errstate(all="ignore"):
            self._send_batch(batch)

    def _send_batch(self, batch: Batch) -> None:
        for event, columns in batch.stretches():
            if self._origin is None:
                self._origin = _first_stamp(event, columns)
            if columns:
                self._measure(columns)
            if event:
                self._event(event)
            if columns and self._origin is not None:
                self._samples(columns)

    def tell(self, sentence: str, level: str = "WARN") -> None:
        """Add a sentence to the events, where the recording is now."""
        self._recording.log(paths.EVENTS, rr.TextLog(sentence, level=level))

    def _event(self, event: Event) -> None:
        self._segment = event.segment()
        self._reference = None
        path, framing = self._segment.path, Framing.of(self._segment)
        before, self._framing = self._framing, framing
        if before is None:
            self._lay_out(framing)
        self._set_time(event.stamp)
        if self._top != path.top:
            self._body(path.top)
        if before is None or before.low != framing.low:
            surroundings.draw(self._recording, framing.low)
        circles = surroundings.circles(path.turning_angles)
        self._recording.log(paths.CIRCLES, circles)
        asked = event.values.get("request", "")
        sentence = f"{event.name}{f' ({asked})' if asked else ''}: {event.verdict}"
        self._recording.log(paths.EVENTS, rr.TextLog(sentence, level="INFO"))
        text = panel(self._segment, event.state(), self._scale_texts())
        self._recording.log(paths.PANEL, rr.TextDocument(text, media_type="text/markdown"))

    def _samples(self, columns: Mapping[str, Columns]) -> None:
        if self._framing is None:  # no event has said which top it is
            self._framing = Framing()
            self._lay_out(self._framing)
            self._body(None)
        attitude = quantities.attitude(columns)
        if attitude:
            stamps, quaternions = attitude
            self._send(paths.BODY, stamps, rr.Transform3D.columns(quaternion=quaternions))
            times, strips = self._trace.strips(stamps, quantities.axis_of(quaternions))
            self._send(paths.TRACE, times, rr.LineStrips3D.columns(strips=list(strips)))
        for name, arrow in ARROWS.items():
            if name in columns:
                vectors = _vectors(columns[name], arrow) / self._scales[name]
                stamps = columns[name].stamps
                self._send(arrow.path, stamps, rr.Arrows3D.columns(vectors=vectors))
                ends = rr.Points3D.columns(positions=vectors)
                self._send(f"{arrow.path}/name", stamps, ends)
        self._plots(columns)

    def _plots(self, columns: Mapping[str, Columns]) -> None:
        if "euler_angles" in columns:
            euler = columns["euler_angles"]
            for path, column in ((paths.THETA, 1), (paths.PHI_DOT, 3), (paths.PSI_DOT, 5)):
                self._scalars(path, euler.stamps, euler.numbers[:, column : column + 1])
            nodes = surroundings.line_of_nodes(euler.numbers[:, 0])
            self._send(paths.NODES, euler.stamps, rr.LineStrips3D.columns(strips=list(nodes)))
        if "angular_momentum" in columns:
            momentum = columns["angular_momentum"]
            self._scalars(paths.L, momentum.stamps, momentum.numbers)
            square = quantities.horizontal_square(momentum)
            self._scalars(paths.L_HORIZONTAL, momentum.stamps, square[:, None])
        if self._segment:
            self._drift(columns, self._segment.path.top)

    def _drift(self, columns: Mapping[str, Columns], top: Top) -> None:
        found = quantities.constants(columns, top)
        if found and len(found[0]):
            stamps, values = found
            if self._reference is None:
                self._reference = values[0]
            drift = (values - self._reference) / quantities.sizes(top, self._reference) / EPS
            self._scalars(paths.DRIFT, stamps, drift)

    def _measure(self, columns: Mapping[str, Columns]) -> None:
        """Choose the scales of the arrows by their first vectors."""
        for name, arrow in ARROWS.items():
            if name in columns and name not in self._scales:
                lengths = np.linalg.norm(_vectors(columns[name], arrow), axis=1)
                self._scales[name] = float(f"{lengths.max() / arrow.length:.2g}") or 1.0

    def _scale_texts(self) -> dict[str, str]:
        return {
            arrow.label: f"{self._scales[name]:g} {arrow.unit}"
            for name, arrow in ARROWS.items()
            if name in self._scales
        }

    def _lay_out(self, framing: Framing) -> None:
        self._trace.length = framing.trail
        self._recording.send_blueprint(blueprint(framing, self._live))

    def _style(self) -> None:
        for arrow in ARROWS.values():
            style = rr.Arrows3D.from_fields(colors=[arrow.color], radii=[0.012])
            self._recording.log(arrow.path, style, static=True)
            name = rr.Points3D.from_fields(  # an arrow's own label stands at its middle
                colors=[arrow.color], radii=[0.001], labels=[arrow.label], show_labels=True
            )
            self._recording.log(f"{arrow.path}/name", name, static=True)
        for path, color, radius in ((paths.TRACE, GOLD, 0.007), (paths.NODES, ORANGE, 0.005)):
            lines = rr.LineStrips3D.from_fields(colors=[color], radii=[radius])
            self._recording.log(path, lines, static=True)
        for path, (names, colors) in LINES.items():
            series = rr.SeriesLines(names=names, colors=colors, widths=[1.6] * len(names))
            self._recording.log(path, series, static=True)

    def _body(self, top: Top | None) -> None:
        self._top = top
        self._recording.log(paths.BODY, top_mesh(top).drawn())

    def _scalars(self, path: str, stamps: Stamps, values: Real) -> None:
        """Send the lines of a plot, (n, width)."""
        columns = rr.Scalars.columns(scalars=values.ravel())
        self._send(path, stamps, columns.partition([values.shape[1]] * len(values)))

    def _send(self, path: str, stamps: Stamps, columns: Any) -> None:
        self._recording.send_columns(path, [self._time(stamps)], columns)

    def _time(self, stamps: Stamps) -> rr.TimeColumn:
        durations = (stamps - (self._origin or 0)).astype("timedelta64[ns]")
        return rr.TimeColumn(paths.TIMELINE, duration=durations)

    def _set_time(self, stamp: int) -> None:
        """Events from before the first sample are shown at it."""
        nanoseconds = max(0, stamp - (self._origin or 0))
        self._recording.set_time(paths.TIMELINE, duration=np.timedelta64(nanoseconds, "ns"))


def _vectors(columns: Columns, arrow: Arrow) -> Real:
    return columns.numbers[:, arrow.first : arrow.first + 3]


def _first_stamp(event: Event | None, columns: Mapping[str, Columns]) -> int | None:
    """Return the stamp of the first sample; of the event where there is none yet."""
    stamps = [int(each.stamps[0]) for each in columns.values()]
    if stamps:
        return min(stamps)
    return event.stamp if event else None
