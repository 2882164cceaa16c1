"""Render docs/replay.png and docs/six_rates.png: `python test/write_pictures.py`.

The first is a top on cusps that is hurried, as `top_replay` shows it; the second a scene of
`top_report article`.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path += [str(ROOT), str(ROOT / "test"), str(ROOT / "test/load")]

from log_files import ARTICLE, CUSPS  # noqa: E402
from pictures import pause_at, picture, running_viewer, views  # noqa: E402
from PIL import Image  # noqa: E402

from symtop_ros.physics import Motion, hurry, kick_verdict  # noqa: E402
from symtop_ros.playback.replay import create_recording  # noqa: E402
from symtop_ros.playback.view import entities  # noqa: E402
from symtop_ros.playback.view.view import View  # noqa: E402
from symtop_ros.simulation.changes.outcomes import Start  # noqa: E402
from symtop_ros.simulation.segment import Segment  # noqa: E402
from workshop.article.recordings import sample, six_rates, write_scene  # noqa: E402

KICK, END = 1_520_000_000, 3_000_000_000  # ns
PERIOD = 2_000_000  # ns between samples
MENU = 37  # rows of pixels
PATIENCE = 8.0  # s until the viewer's own notes are gone
COLORS = 256


def write_replay(file: Path) -> None:
    """Record a top on cusps that is hurried where it precesses fastest."""
    recording = create_recording(file, "replay")
    view, start = View(recording), Segment.begin(Motion(ARTICLE, CUSPS), 0, 1.0)
    stamps = np.arange(0, END, PERIOD)
    view.send(sample("start", Start.of(start.motion), CUSPS, start, stamps[stamps < KICK]))
    before = start.state_at(KICK)
    kicked = start.restart(hurry(before, factor=1.4), KICK)
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
    shot.quantize(COLORS).save(target, optimize=True)
    print(f"wrote {target}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        write_replay(Path(name, "replay.rrd"))
        render(Path(name, "replay.rrd"), 2.84, ROOT / "docs/replay.png")
        write_scene(six_rates(), Path(name, "six_rates.rrd"))
        render(Path(name, "six_rates.rrd"), 1.2, ROOT / "docs/six_rates.png")
