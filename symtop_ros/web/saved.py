"""A run as one file for a browser: its scene in motion, verdicts and charts, without a server.

All of it follows from the events of the run: the motion between two events is exact.
"""

import contextlib
import io
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import viser

from symtop_ros.log.batch import Batch, Columns
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.web.facts import describe, describe_constants, thin
from symtop_ros.web.page import HIDING, write_page
from symtop_ros.web.run import DRAWN, Run
from symtop_ros.web.scene import Scene

FRAME = 1_000_000_000 // 30  # ns
SAMPLES = 7  # of a frame: about 200 a second, as a top publishes
LONGEST = 120 * 1_000_000_000  # ns that are played; of a longer run it is the end
STILL = 6  # frames for which a step of a paused top is shown
DRIVEN_EVERY = 8  # frames after which the potential of a driven motion is drawn anew
POLICY = (
    '<meta http-equiv="Content-Security-Policy" content="default-src data: blob: '
    "'unsafe-inline' 'wasm-unsafe-eval'; form-action 'none'\">"
)


def save_run(events: Sequence[Event], end: int) -> str:
    """Return the page of a run, from its events and the stamp (ns) at which it ends.

    Raises
    ------
    ValueError
        If there is no event, or no time passes.
    """
    stretches = _list_stretches(events, end) if events else []
    if sum(len(stamps) for _, stamps in stretches) < 2:
        raise ValueError("a run must last for some frames to be saved")
    film = _Film()
    with _recording(film):
        for event, stamps in stretches:
            film.play(event, stamps)
    return film.write()


@dataclass
class _Film:
    """The recorded scene, and the data of the charts."""

    run: Run = field(default_factory=Run)
    frames: int = 0
    rows: list[list[float | None]] = field(default_factory=list)  # with the time that is played
    facts: list[tuple[float, dict[str, Any], int, dict[str, Any]]] = field(default_factory=list)
    scene: Scene = field(init=False)
    recorder: Any = field(init=False)
    _taken: int = 0  # rows of the run

    def play(self, event: Event, stamps: list[int]) -> None:
        """Play what follows an event; without stamps nothing of it is shown."""
        self.run.follow(Batch(events=[(0, event)]))
        segment = self.run.segment
        if segment is None:
            return
        self.scene.begin_motion(segment, event.state())
        for number, stamp in enumerate(stamps):
            before = stamp - FRAME if number else stamp
            self._draw(segment, before, stamp)
            driven = segment.motion.is_driven and number % DRIVEN_EVERY == 0
            if number == 0 or driven:
                self._describe()

    def _draw(self, segment: Segment, before: int, stamp: int) -> None:
        samples = np.unique(np.linspace(before, stamp, SAMPLES + 1).astype(np.int64)[1:])
        states = segment.state_at(samples if segment.running else int(samples[0]))
        orientation = np.broadcast_to(states.orientation, (len(samples), 4))[:, [1, 2, 3, 0]]
        self.run.follow(Batch({DRAWN: Columns(samples, orientation, np.arange(len(samples)))}))
        self.scene.draw(self.run, None)
        self._taken, rows = self.run.series_since(self._taken)
        self.rows += [[*row, self.time] for row in thin(rows, self.run.window)] if len(rows) else []
        self.recorder.insert_sleep(FRAME * 1e-9)
        self.frames += 1

    def _describe(self) -> None:
        facts = {**describe(self.run), "history": [], "link": ""}
        begin = next((k for k, row in enumerate(self.rows) if (row[0] or 0) >= facts["since"]), 0)
        self.facts.append((self.time, facts, begin, describe_constants(self.run)))

    @property
    def time(self) -> float:
        """Time of the player in s."""
        return self.frames * FRAME * 1e-9

    def write(self) -> str:
        """Return the page."""
        scene = self.recorder.as_html().replace("<head>", f"<head>{HIDING}", 1)
        data = json.dumps({"rows": self.rows, "facts": self.facts, "scene": scene})
        text = data.replace("<", "\\u003c")  # no end of a script in it
        page = write_page(f"window.SAVED_RUN = {text};\n")
        return page.replace("<head>", f"<head>\n{POLICY}", 1)


def _list_stretches(events: Sequence[Event], end: int) -> list[tuple[Event, list[int]]]:
    """Return each event with the stamps of the frames after it; of a long run the last ones."""
    stretches = []
    ends = [*(after.stamp for _, after in pairwise(events)), end]
    for event, until in zip(events, ends, strict=True):
        running = event.values.get("motion.running") == "true"
        if running:
            stamps = list(range(event.stamp, max(until, event.stamp + 1), FRAME))
        else:
            stamps = [event.stamp] * (STILL if event.name == "step" else 1)
        stretches.append((event, stamps))
    left = LONGEST // FRAME
    for _, stamps in reversed(stretches):
        stamps[: max(0, len(stamps) - left)] = []
        left -= len(stamps)
    return stretches


@contextlib.contextmanager
def _recording(film: _Film) -> Iterator[None]:
    """Let viser record what is drawn in this context; it needs a server for that."""
    with contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer("127.0.0.1", 0, verbose=False)
    try:
        film.scene = Scene(server)
        film.recorder = server.get_scene_serializer()
        yield
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            server.stop()
