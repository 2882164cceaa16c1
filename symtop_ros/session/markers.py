"""Markers for viewers that draw no vectors themselves: three arrows, and the trace of the axis."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot

from symtop_ros.arrays import Vector
from symtop_ros.models.urdf import LENGTH
from symtop_ros.simulation.block import Block
from symtop_ros.wire.layout import NANOSECONDS, Writer

PERIOD = NANOSECONDS // 30  # ns between two sets of markers
TRACE_LENGTH = 150  # points of the trace: 5 s
# By topic: colour, and length of the arrow for the largest vector so far, in lengths of the top.
ARROWS = {
    "angular_velocity": ((0.2, 0.55, 0.95), 1.4),
    "angular_momentum": ((0.95, 0.6, 0.1), 1.2),
    "torque": ((0.85, 0.2, 0.25), 0.7),
}
TRACE_COLOR = (0.95, 0.95, 0.95)
WIDTH = 0.02  # of shafts and of the trace, in lengths of the top
ARROW, LINE_STRIP, ADD = 0, 4, 0  # constants of visualization_msgs/Marker
POSE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # in the world frame itself
ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Marker:
    """A marker: its namespace, type, scale, colour and points."""

    name: str
    kind: int
    scale: Vector
    color: Vector
    points: Sequence[Vector]


@dataclass
class Markers:
    """The content of `~/markers`, in a fixed frame."""

    frame: str
    next: int = 0  # stamp (ns) from which on the next set is due
    largest: dict[str, float] = field(default_factory=lambda: dict.fromkeys(ARROWS, 0.0))
    trace: deque[Vector] = field(default_factory=lambda: deque(maxlen=TRACE_LENGTH))

    def is_due(self, stamp: int) -> bool:
        """Return True thirty times a second, on a grid: for any rate of the samples."""
        if self.next - PERIOD <= stamp < self.next:  # a clock may also jump back
            return False
        self.next = (stamp // PERIOD + 1) * PERIOD
        return True

    def encode(self, stamp: int, block: Block) -> bytes:
        """Encode the MarkerArray of a sample (stamp in ns)."""
        self.trace.append(_axis_end(block.numbers("orientation", stamp)))
        scale = (0.5 * WIDTH * LENGTH, 0.0, 0.0)
        markers = [Marker("trace", LINE_STRIP, scale, TRACE_COLOR, list(self.trace))]
        # the last three numbers: messages with six have zeros before the vector
        markers += [self._arrow(name, block.numbers(name, stamp)[-3:]) for name in ARROWS]
        writer = Writer()
        writer.integer(len(markers))
        for each in markers:
            _write(writer, stamp, self.frame, each)
        return writer.data

    def _arrow(self, name: str, vector: Sequence[float]) -> Marker:
        (color, length), size = ARROWS[name], hypot(*vector)
        self.largest[name] = max(self.largest[name], size)
        scale = LENGTH * length / self.largest[name] if size else 0.0
        x, y, z = (scale * each for each in vector)
        widths = (WIDTH * LENGTH, 2.5 * WIDTH * LENGTH, 0.0)  # shaft, head
        return Marker(name, ARROW, widths, color, (ORIGIN, (x, y, z)))


def _write(writer: Writer, stamp: int, frame: str, marker: Marker) -> None:
    """Write a visualization_msgs/Marker; its textures, texts and meshes are empty."""
    writer.stamp(stamp)
    writer.strings([frame, marker.name])
    for number in (0, marker.kind, ADD):  # id, type, action
        writer.integer(number, "i")
    writer.numbers([*POSE, *marker.scale])
    writer.numbers([*marker.color, 1.0], "f")
    writer.stamp(0)  # lifetime: for ever
    writer.integer(0, "B")  # frame_locked
    writer.integer(len(marker.points))
    writer.numbers([each for point in marker.points for each in point])
    writer.integer(0)  # colors
    writer.strings([""])  # texture_resource
    writer.stamp(0)  # of the texture, then its frame, format and data
    writer.strings(["", ""])
    writer.integer(0)
    writer.integer(0)  # uv_coordinates
    writer.strings(["", "", ""])  # text, mesh_resource, and the name of mesh_file
    writer.integer(0)  # its data
    writer.integer(0, "B")  # mesh_use_embedded_materials


def _axis_end(quaternion: Sequence[float]) -> Vector:
    """Return the upper end of the axis for an orientation x, y, z, w."""
    x, y, z, w = quaternion
    up = 1.0 - 2.0 * (x * x + y * y)
    return 2 * LENGTH * (x * z + w * y), 2 * LENGTH * (y * z - w * x), LENGTH * up
