"""Recordings of damaged logs: nothing is drawn of a motion that is not known.

Criteria are those of the run before it was damaged: its constants of motion do not change between
its events, and each ghost continues a motion of its events.
"""

from functools import cache
from random import Random

import numpy as np
import pytest
from replay.view.rows import DRIFT, FLOAT, rows, strict
from run.log.damaged import Log, Recorded
from run.log.ways import OF_BYTES, OF_MESSAGES, RUNS, write_damaged
from trials import seeds

from symtop_ros.replay.view import entities
from symtop_ros.replay.viewer import replay
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.events import KICKS, RESTARTS

INPUTS = 5  # of each seed


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """Return the function that records a run once: its logs, of which the first may be split."""

    @cache
    def record(name, is_split):
        scene, script = RUNS[name]
        recorded = Recorded(tmp_path_factory.mktemp("run"), scene=scene)
        script(recorded)
        first, *others = map(Log.read, recorded.close())
        count = len(first.messages)
        parts = first.split((count // 3, 2 * count // 3)) if is_split else [first]
        return *parts, *others

    return record


def read_events(logs, folder):
    """The events of a run that is not damaged."""
    folder.mkdir()
    paths = [log.write(folder / f"{number}.mcap") for number, log in enumerate(logs)]
    return TopLog(open_run(paths)).catalog.events


def list_ghosts(events):
    """The ghost from each event on: its segment and the shift of its stamps (ns), or None."""
    ghosts, ghost = [], None
    for before, event in zip((None, *events), events, strict=False):
        if event.name in RESTARTS:
            ghost = None
        elif event.name in KICKS:
            ghost = before.segment(), 0
        elif event.name == "clock" and ghost:
            ghost = ghost[0], ghost[1] + event.previous_end - event.stamp
        ghosts.append(ghost)
    return ghosts


def find_ghosts(events, ghosts, stamp):
    """Attitudes of what was not kicked at a stamp, of all events that can hold there."""
    ends = [*(event.previous_end for event in events[1:]), 2**62]
    for event, end, ghost in zip(events, ends, ghosts, strict=True):
        if event.stamp <= stamp < end and ghost:
            segment, shift = ghost
            yield segment.state_at(stamp + shift).orientation[[1, 2, 3, 0]]


@pytest.mark.parametrize("seed", seeds(2, 200))
def test_nothing_is_drawn_of_a_motion_that_is_not_known(seed, record, tmp_path):
    rng = Random(seed)
    for number in range(INPUTS):
        folder = tmp_path / f"{number}"
        folder.mkdir()
        # each run of the tests takes two runs of the top only: to record them takes a while
        name = rng.choice(list(RUNS) if seed > 1 else ["kicked", "back"])
        logs = record(name, rng.random() < 0.5)
        paths = write_damaged(logs, rng.choice((*OF_MESSAGES, *OF_BYTES)), rng, folder)
        target = folder / "run.rrd"
        try:
            log = TopLog(open_run(paths))
            with strict():
                replay(log, target)
        except LogError:
            continue  # one sentence, which other tests have
        assert_right(target, read_events(logs, folder / "whole"), log.catalog.events)


def assert_right(target, events, left):
    times, texts = rows(target, entities.EVENTS, "TextLog:level")
    own = [time for time, level in zip(times, texts, strict=True) if level == ["INFO"]]
    assert len(own) == len(left)
    if not left:
        return
    # Events before the first sample are shown at that sample.
    origin = max(event.stamp for event in left) - max(own)
    if not any(event.segment().motion.friction for event in events):
        _, values = rows(target, entities.DRIFT, "Scalars:scalars")
        assert np.abs(np.array(values)).max(initial=0.0) <= DRIFT
    ghosts = list_ghosts(events)
    for time, (drawn,) in zip(*rows(target, entities.GHOST, "Transform3D:quaternion"), strict=True):
        assert any(
            np.abs(np.array(drawn) - exact).max() <= FLOAT
            for exact in find_ghosts(events, ghosts, int(time) + origin)
        )
