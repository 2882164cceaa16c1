"""Pictures of Rerun's viewer: a top that is hurried, and the article's six rates side by side."""

import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image

from symtop_ros.physics import Motion, State, hurry, kick_verdict
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.view import View
from symtop_ros.playback.viewer import create_recording
from symtop_ros.simulation.changes.outcomes import Start
from symtop_ros.simulation.segment import Segment
from workshop.article.motions import PSI_DOT, THETA, TOP
from workshop.article.recordings import sample, six_rates, write_scene
from workshop.pictures.pack import pack_shaded
from workshop.pictures.viewer import pause_at, picture, running_viewer, views

CUSPS = State.from_euler(theta=THETA, psi_dot=PSI_DOT)
KICK, END = 1_520_000_000, 3_000_000_000  # ns
PERIOD = 2_000_000  # ns between samples
MENU = 37  # rows of pixels
PATIENCE = 8.0  # s until the viewer's own notes are gone


def write_replay(file: Path) -> None:
    """Record a top on cusps that is hurried where it precesses fastest."""
    recording = create_recording(file, "replay")
    view, start = View(recording), Segment.begin(Motion(TOP, CUSPS), 0, 1.0)
    stamps = np.arange(0, END, PERIOD)
    view.send(sample("start", Start.of(start.motion), CUSPS, start, stamps[stamps < KICK]))
    before = start.state_at(KICK)
    kicked = start.change(KICK, hurry(before, factor=1.4))
    verdict = kick_verdict(kicked.motion, before, "spin_rate")
    view.send(sample("kick", verdict, before, kicked, stamps[stamps >= KICK]))
    recording.flush()
    recording.disconnect()


def render(recording: Path, seconds: float, target: Path) -> None:
    """Write the viewer's window at a time, without its menu."""
    with running_viewer(recording) as (client, _):
        views(client, 3)
        pause_at(client, entities.TIMELINE, duration=seconds)
        time.sleep(PATIENCE)
        shot = Image.fromarray(picture(client)[MENU:])
    target.write_bytes(pack_shaded(shot))
    print(f"wrote {target}")


def write_replays(docs: Path) -> None:
    """Write replay.png and six_rates.png."""
    with tempfile.TemporaryDirectory() as name:
        write_replay(Path(name, "replay.rrd"))
        render(Path(name, "replay.rrd"), 2.84, docs / "replay.png")
        write_scene(six_rates(), Path(name, "six_rates.rrd"))
        render(Path(name, "six_rates.rrd"), 1.2, docs / "six_rates.png")
