"""The pictures of the documents that show motions, Rerun's viewer, and the steps of docs/lesson.md.

Those of the page, which need a browser, are drawn by page.py; the plots of what was measured are
written with their tables.
"""

import io
import sys
import tempfile
import time
from pathlib import Path
from unittest import SkipTest

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from symtop_ros.base.figure_style import GREY, RED
from symtop_ros.physics import Motion, State, hurry, kick_verdict
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.view import View
from symtop_ros.replay.viewer import create_recording
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.segment import Segment
from workshop.article import means
from workshop.article.figures import FIGURES
from workshop.article.maps import draw_map, make_map
from workshop.article.motions import PSI_DOT, SLOW, THETA, TOP
from workshop.article.recordings import sample, six_rates, write_scene
from workshop.lesson.page import PAGE, write_page
from workshop.lesson.pictures import write_lesson
from workshop.pictures.pack import pack, pack_figure, pack_shaded
from workshop.pictures.viewer import pause_at, picture, running_viewer, views

MAP_COLORS = 64
STARTS = {"regular precession": SLOW, "cusps": 0.0, "loops": -8.0, "hurried: it rises": 1.4 * SLOW}
TURN = 2 * np.pi / SLOW  # s; regular precession closes its circle
POINTS = 900  # of a trace; with fewer, its cusps would be blunt
SIZE, SCALE = 220, 125  # points; points per unit of the sphere, seen from above
CUSPS = State.from_euler(theta=THETA, psi_dot=PSI_DOT)
KICK, END = 1_520_000_000, 3_000_000_000  # ns
PERIOD = 2_000_000  # ns between samples
MENU = 37  # rows of pixels
PATIENCE = 8.0  # s until the viewer's own notes are gone


def write_pictures(folder: Path) -> int:
    """Write the pictures into a folder such as docs; return the exit status."""
    (folder / "article").mkdir(exist_ok=True)
    (folder / "lesson").mkdir(exist_ok=True)
    (folder / PAGE.name).write_text(write_page(), encoding="utf-8")
    (folder / "traces.svg").write_text(draw_traces(), encoding="utf-8")
    for name, draw in FIGURES.items():
        (folder / f"article/{name}.png").write_bytes(pack_figure(draw))
    print(f"wrote {len(FIGURES)} figures to {folder / 'article'}")
    write_lesson(folder / "lesson")
    drawn = io.BytesIO()
    draw_map(make_map("spin"), drawn)
    (folder / "perry.png").write_bytes(pack(drawn, MAP_COLORS))
    print(f"wrote {folder / 'perry.png'}")
    drawn = io.BytesIO()
    means.draw_map(drawn)
    (folder / "perry_in_the_mean.png").write_bytes(pack(drawn, MAP_COLORS))
    try:
        write_replays(folder)
    except SkipTest as reason:  # no program that renders without a screen
        print(f"workshop: {reason}", file=sys.stderr)
        return 1
    return 0


def draw_curve(points: NDArray[np.float64], style: str) -> str:
    """Draw a curve (n, 3) on the sphere, seen from above: steps in tenths of a point."""
    tenths = np.rint(10 * (SIZE / 2 + SCALE * points[:, :2] * (1, -1))).astype(int)
    steps = " ".join(f"{x},{y}" for x, y in np.diff(tenths, axis=0, prepend=[[0, 0]]).tolist())
    return f'<path d="m{steps}" transform="scale(0.1)" fill="none" {style}/>'


def draw_circle(theta: float, style: str) -> str:
    """Draw a circle of equal tilt."""
    radius = SCALE * np.sin(theta)
    return f'<circle cx="{SIZE / 2}" cy="{SIZE / 2}" r="{radius:.1f}" fill="none" {style}/>'


def panel(name: str, phi_dot: float) -> str:
    """One start: turning circles, and the trace of the axis."""
    path = Motion(TOP, State.from_euler(theta=THETA, psi_dot=PSI_DOT, phi_dot=phi_dot))
    trace = path.at(np.linspace(0.0, TURN, POINTS)).to_world(np.array([0.0, 0.0, 1.0]))
    circles = "".join(
        draw_circle(theta, f'stroke="{GREY}" stroke-width="1" stroke-dasharray="3 3"')
        for theta in path.turning_angles
    )
    curve = draw_curve(trace, f'stroke="{RED}" stroke-width="20" stroke-linejoin="round"')
    label = f'<text x="{SIZE / 2}" y="{SIZE + 8}" text-anchor="middle">{name}</text>'
    return circles + curve + label


def draw_traces() -> str:
    """Return the picture."""
    panels = "".join(
        f'<g transform="translate({i * SIZE},0)">{panel(name, rate)}</g>'
        for i, (name, rate) in enumerate(STARTS.items())
    )
    width = SIZE * len(STARTS)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {SIZE + 16}" '
        f'font-family="sans-serif" font-size="14" fill="#555">{panels}</svg>\n'
    )


def write_replay(file: Path) -> None:
    """Record a top on cusps that is hurried where it precesses fastest."""
    recording = create_recording(file, "replay")
    view = View(recording)
    start = Segment.begin(Motion(TOP, CUSPS), 0, 1.0)
    stamps = np.arange(0, END, PERIOD)
    view.send(sample("start", Start.of(start.motion), CUSPS, start, stamps[stamps < KICK]))
    before = start.state_at(KICK)
    kicked = start.change(KICK, hurry(before, factor=1.4))
    verdict = kick_verdict(kicked.motion, before, "spin_rate")
    view.send(sample("kick", verdict, before, kicked, stamps[stamps >= KICK]))
    recording.flush()
    view.close()


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
