"""Records from logs and bags: attitudes, or the angular velocity of a sensor on the body."""

from pathlib import Path

import numpy as np

from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.truth.fit.files import Rows
from symtop_ros.truth.judge.estimates import read_topic


def read_log(path: Path, topic: str | None, frame: str | None, kind: str | None) -> Rows:
    """Return what a topic of a log shows: rates if it has them, else attitudes."""
    if topic is None:
        raise RefusedError(f"--topic must name the measurements in {path}, got none")
    found = read_topic(open_run([path]), topic, frame)
    if not len(found):
        raise RefusedError(f"{topic} must have messages with an attitude, got none")
    chosen = kind or "attitude"
    if chosen not in {"rates", "attitude"}:
        raise RefusedError(f"--kind must be rates or attitude for a log, got {chosen}")
    times = (found.stamps - found.stamps[0]) / NANOSECONDS
    if chosen == "attitude":
        return Rows(chosen, times, found.orientations, found.notes)
    if found.angular_velocities is None:
        raise RefusedError(f"{topic} must have angular velocities, got attitudes alone")
    return Rows(chosen, np.asarray(times), found.angular_velocities, found.notes)
