"""The article's motions in 3D: each as `top_replay` draws it from a log, and two scenes of many."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rerun as rr

from symtop_ros.article.motions import FAST, cusps, regular, start
from symtop_ros.article.side_by_side import (
    APPLICATION,
    RATE,
    SPAN,
    kicked_and_not_kicked,
    six_rates,
    write_scene,
)
from symtop_ros.log.batch import Batch, Columns
from symtop_ros.physics import Motion, State, perrys_rule
from symtop_ros.playback.view.view import View, ViewOptions
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.topics import STATE_TOPICS, Samples

ANGLES, TORQUES = ViewOptions(angles=True), ViewOptions(torques=True)
MOTIONS: dict[str, tuple[State, ViewOptions]] = {
    "below_slow_root": (start(3.0), ANGLES),
    "regular_precession": (regular().start, ANGLES),
    "above_slow_root": (start(9.0), ANGLES),
    "below_fast_root": (start(67.0), ANGLES),
    "fast_precession": (start(FAST), ANGLES),
    "above_fast_root": (start(73.0), ANGLES),
    "cusps": (cusps().start, ANGLES),
    "torque_of_regular_precession": (regular().start, TORQUES),
    "torque_of_cusps": (cusps().start, TORQUES),
}
SCENES = {"six_rates": six_rates, "kicked": kicked_and_not_kicked}


def write_recordings(folder: Path) -> None:
    """Write each of the `MOTIONS` and the `SCENES` as a Rerun recording NAME.rrd."""
    top = regular().top
    for name, (state, options) in MOTIONS.items():
        _record(Motion(top, state), options, folder / f"{name}.rrd")
    for name, exhibits in SCENES.items():
        write_scene(exhibits(), folder / f"{name}.rrd")


def _record(motion: Motion, options: ViewOptions, file: Path) -> None:
    """Write the scene of a motion as `top_replay` draws it from a log."""
    # Rerun only warns about a file that it cannot write, so that opening it comes first.
    file.open("wb").close()
    recording = rr.RecordingStream(APPLICATION, recording_id=file.stem)
    recording.save(file)
    View(recording, options=options).send(_sample(motion))
    recording.flush()
    recording.disconnect()


def _sample(motion: Motion) -> Batch:
    """Return the start of a motion and its samples in the form in which a log is read."""
    segment = Segment.begin(motion, 0, 1.0)
    stamps = np.arange(round(RATE * SPAN) + 1) * (10**9 // RATE)
    samples, places = Samples.at(segment, stamps), 1 + np.arange(len(stamps))
    columns = {
        name: Columns(stamps, topic.compute(samples), places)
        for name, topic in STATE_TOPICS.items()
    }
    verdict = str(perrys_rule(motion.top, motion.start))
    event = Event.of(0, "start", verdict, {}, motion.start, segment)
    return Batch(columns, [(0, event)])
