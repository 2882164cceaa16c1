"""Records from logs and bags: attitudes, or measurements of a sensor on the body."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.reader import list_problems
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.run.wire.messages import IMU
from symtop_ros.truth.fit.aliases import SPINS
from symtop_ros.truth.fit.files import Rows
from symtop_ros.truth.topics.estimates import decode_estimates, read_messages
from symtop_ros.truth.topics.measured import find_absent, read_measured

SENSED = ("angular_velocity", "linear_acceleration")
SEEN = ("attitude", *SPINS)  # kinds of which there are messages


def read_log(path: Path, topic: str | None, frame: str | None, kind: str | None) -> Rows:
    """Return the record of a topic of a log: attitudes, or the requested kind."""
    if topic is None:
        raise RefusedError(f"--topic must name the measurements in {path}, got none")
    chosen = kind or "attitude"
    if chosen not in SEEN:
        raise RefusedError(f"--kind must be one of {', '.join(SEEN)} for a log, got {chosen}")
    source = open_run([path])
    form, messages = read_messages(source, topic)
    rows = _read(form, messages, topic, frame, chosen)
    return replace(rows, notes=(*list_problems(source.problems), *rows.notes))


def _read(form: str, messages: Sequence[bytes], topic: str, frame: str | None, chosen: str) -> Rows:
    """Return the messages of a topic as rows of a kind, by their type."""
    if chosen != "attitude" and form == IMU.type:
        return _read_sensor(topic, messages, chosen)
    found = decode_estimates(form, messages, frame)
    if not len(found):
        raise RefusedError(f"{topic} must have messages with an attitude, got none")
    values = found.orientations if chosen == "attitude" else found.angular_velocities
    if values is None or chosen == "inertial":
        wanted = "angular velocities" if values is None else "accelerations"
        raise RefusedError(f"{topic} must have {wanted}, got {form}")
    return Rows(chosen, _count_seconds(found.stamps), values, found.notes)


def _read_sensor(topic: str, messages: Sequence[bytes], kind: str) -> Rows:
    """Return rates, and forces if they are asked for, of Imu messages with or without attitudes."""
    measured = read_measured(IMU, messages)
    if not len(measured.stamps):
        raise RefusedError(f"{topic} must have messages, got none that can be read")
    names = SENSED[: 1 if kind == "rates" else 2]
    values = np.concatenate([np.asarray(measured.find(name)) for name in names], axis=1)
    notes = [*measured.describe_absent(*names)]
    good = np.flatnonzero(~find_absent(values))
    if not good.size:
        wanted = " and ".join(name.replace("_", " ") for name in names)
        raise RefusedError(f"{topic} must have messages with {wanted}, got {'; '.join(notes)}")
    order = good[np.argsort(measured.stamps[good], kind="stable")]
    if measured.unreadable:
        count = write_count(measured.unreadable, "message")
        notes.append(f"{count} cannot be read: left out")
    return Rows(kind, _count_seconds(measured.stamps[order]), values[order], tuple(notes))


def _count_seconds(stamps: Stamps) -> Real:
    return np.asarray((stamps - stamps[0]) / NANOSECONDS)
