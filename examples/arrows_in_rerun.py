"""Arrows of L, omega and the torque in plain Rerun, drawn with Rerun's own log reader and lenses.

    pip install rerun-sdk
    python examples/arrows_in_rerun.py run.mcap run.rrd
    rerun run.rrd

The recording has all that `rerun run.mcap` shows, and the arrows in the frames of their messages.
It needs nothing of this package.
"""

import sys
from typing import Any

import numpy as np
import rerun as rr
from rerun.chunk import DeriveLens, McapReader, Selector

# For each topic: the type, the field, and the metres per unit for a top like that of the article.
VECTORS = {
    "angular_momentum": ("Vector3Stamped", "vector", 20.0),  # per kg m^2/s
    "angular_velocity": ("TwistStamped", "twist.angular", 1e-3),  # per rad/s
    "torque": ("WrenchStamped", "wrench.torque", 2.0),  # per N m
}


def lens(kind: str, field: str, scale: float) -> DeriveLens:
    """Return the lens that makes arrows of the vectors in messages of a type."""

    def to_arrows(vectors: Any) -> Any:
        numbers = scale * np.column_stack([vectors.field(axis) for axis in "xyz"])
        return rr.components.Vector3DBatch(numbers).as_arrow_array()

    return (
        DeriveLens(f"geometry_msgs.msg.{kind}:message")
        .to_component(rr.Arrows3D.descriptor_vectors(), Selector(f".{field}").pipe(to_arrows))
        .to_component(rr.CoordinateFrame.descriptor_frame(), ".header.frame_id")
    )


if len(sys.argv) != 3:
    sys.exit("usage: arrows_in_rerun.py LOG.mcap RECORDING.rrd")
log, recording = sys.argv[1:]
stream = McapReader(log, recover=True).stream()
for topic, how in VECTORS.items():
    stream = stream.lenses(lens(*how), output_mode="forward_all", content=f"/top/{topic}")
stream.write_rrd(recording, application_id="symtop", recording_id=log)
