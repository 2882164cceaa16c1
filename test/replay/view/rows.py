"""Recordings of runs, and their rows, read back by the reader of Rerun."""

import contextlib

import numpy as np
import rerun as rr
from log_files import Run
from rerun.chunk import RrdReader

from symtop_ros.replay.view import entities
from symtop_ros.replay.view.view import ViewOptions
from symtop_ros.replay.viewer import replay
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog

# eps of a drift of constants of motion, the difference of two sums. Of each: two vectors that were
# rotated (4 eps each), their product (1.5), and the height (3).
DRIFT = 25
FLOAT = 4 * float(np.finfo(np.float32).eps)  # of a rotation in single precision


def record(log, folder, **options):
    """Return the recording of a run or of the file of its log."""
    with strict():
        opened = log.open(folder) if isinstance(log, Run) else TopLog(McapFile(log))
        replay(opened, folder / "run.rrd", ViewOptions(**options))
    return folder / "run.rrd"


@contextlib.contextmanager
def strict():
    """Warnings of Rerun are errors."""
    rr.set_strict_mode(True)
    yield
    rr.set_strict_mode(False)


@contextlib.contextmanager
def recording_to(path):
    """A stream into a file, which is complete afterwards."""
    recording = rr.RecordingStream("test")
    recording.save(path)
    yield recording
    recording.flush()
    recording.disconnect()


def rows(path, entity, column):
    """Times in ns, and the values of a column, of one entity."""
    times, values = [], []
    for chunk in RrdReader(path).stream():
        if chunk.entity_path == entity and not chunk.is_static:
            batch = chunk.to_record_batch()
            if column in batch.schema.names:
                times += [each.value for each in batch.column(entities.TIMELINE)]
                values += batch.column(column).to_pylist()
    order = np.argsort(times, kind="stable")
    return np.array(times)[order], [values[k] for k in order]


def arrows(path, entity, column="vectors"):
    """Vectors or origins of an arrow at all times, (n, 3)."""
    return np.array(rows(path, entity, f"Arrows3D:{column}")[1])[:, 0]


def entities_of(path):
    """Paths of the entities that a recording has."""
    return {chunk.entity_path for chunk in RrdReader(path).stream()}
