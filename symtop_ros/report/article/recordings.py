"""Regular precession and cusps in 3D: the axis on the sphere, L and the torque over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rerun as rr

from symtop_ros.physics import Motion, perry
from symtop_ros.playback.batch import Batch, Columns
from symtop_ros.playback.scene.scene import Scene
from symtop_ros.report.article.motions import cusps, regular
from symtop_ros.run.events import Event
from symtop_ros.run.samples import SAMPLES
from symtop_ros.run.segment import Segment

APPLICATION = "symtop_ros"
RATE, SPAN = 500, 3.0  # samples a second, s: three turns of the precession
MOTIONS = {"regular_precession": regular, "cusps": cusps}


def write_recordings(folder: Path) -> list[Path]:
    """Write both motions for Rerun; return the files.

    Raises
    ------
    OSError
        Where a file cannot be written.
    """
    files = [folder / f"{name}.rrd" for name in MOTIONS]
    for file, motion_named in zip(files, MOTIONS.values(), strict=True):
        record(motion_named(), file)
    return files


def record(path: Motion, target: Path) -> None:
    """Write the scene of a motion, as `top_replay` draws it from a log."""
    target.open("wb").close()  # Rerun would only warn
    recording = rr.RecordingStream(APPLICATION, recording_id=target.stem)
    recording.save(target)
    Scene(recording).send(batch(path))
    recording.flush()
    recording.disconnect()


def batch(path: Motion) -> Batch:
    """Return the start of a motion and its samples, as if they had been logged."""
    segment = Segment.begin(path, 0, 1.0)
    stamps = np.arange(round(RATE * SPAN) + 1) * (10**9 // RATE)
    states, places = segment.state_at(stamps), 1 + np.arange(len(stamps))
    columns = {
        name: Columns(stamps, numbers(path, states), places) for name, numbers in SAMPLES.items()
    }
    event = Event.of(0, "start", str(perry(path.top, path.start)), {}, path.start, segment)
    return Batch(columns, [(0, event)])
