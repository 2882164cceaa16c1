"""The stacked energies end at the energy of the start plus the work, whatever happens."""

import numpy as np
import pytest
from log_files import ARTICLE, CUSPS, Run
from physics.tops import EPS

from symtop_ros.physics import Friction
from symtop_ros.replay.view.quantities import EnergyBook

LOWEST = abs(ARTICLE.Mgl)
SIZE = float(ARTICLE.energy(CUSPS)) + LOWEST
ROUNDING = 64 * EPS * SIZE  # four sums of three energies, each of up to five rounded products


def read(run, folder):
    """Return the rows of energies of a run, and its events."""
    book = EnergyBook()
    segment = None
    rows = []
    events = []
    for batch in run.open(folder).batches():
        for event, columns in batch.intervals():
            if event:
                before, segment = segment, event.segment()
                book.follow(event, before, segment)
                events.append(event)
            if columns:
                rows.append(book.rows(columns, segment.motion)[1])
    return np.concatenate(rows), events


def test_without_friction_nothing_is_lost_and_a_kick_does_work(tmp_path):
    rows, (start, kick) = read(Run(seconds=1.0), tmp_path)
    kinetic, stacked, with_lost, done = rows.T
    assert np.abs(with_lost - stacked).max() == 0.0
    assert np.abs(done - stacked).max() <= ROUNDING
    half = len(rows) // 2
    assert done[0] == pytest.approx(float(ARTICLE.energy(start.state())) + LOWEST, rel=8 * EPS)
    work = float(ARTICLE.energy(kick.state())) - float(ARTICLE.energy(start.state()))
    assert done[half] - done[half - 1] == pytest.approx(work, abs=ROUNDING)
    assert (kinetic < stacked).all()


def test_what_friction_takes_is_booked_as_lost(tmp_path):
    friction = Friction(axial=1e-5, transverse=1e-5)
    rows, _ = read(Run(seconds=1.0, hurried=False, friction=friction), tmp_path)
    _, stacked, with_lost, done = rows.T
    assert (np.diff(stacked) < 0).all()
    assert np.abs(with_lost - done).max() <= ROUNDING
    assert np.ptp(done) == 0.0
