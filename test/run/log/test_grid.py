"""Samples that are missing or repeated, and times that have none."""

import numpy as np
import pytest
from run.log.test_event_order import KICKS, START, event, order

from symtop_ros.run.log.grid import Grid, Recording
from symtop_ros.run.log.stamps import ROUNDING, StampRows

MS = 1_000_000
PERIOD = 10 * MS


def rows_of(stamps, places=None, events=0):
    rows = StampRows()
    stamps = np.array(stamps, dtype=np.int64)
    places = np.arange(len(stamps)) + 1 if places is None else np.array(places)
    rows.add(stamps, places, np.broadcast_to(events, len(stamps)))
    return rows


def judge(stamps, *events, rate="100", name="torque", places=None):
    ordered = order(START, *events)
    return Grid(ordered, [Recording(0, rate)]).judge(name, rows_of(stamps, places))


GRID = [k * PERIOD for k in range(20)]


def test_a_gap_has_its_neighbours_and_the_number_of_the_missing():
    (gap,) = judge(GRID[:5] + GRID[8:]).gaps
    assert (gap.before, gap.after, gap.missing, gap.place) == (GRID[4], GRID[8], 3, 6)


@pytest.mark.parametrize(("rate", "missing"), [("100", 0), ("200", 19), ("x", 0), ("", 0)])
def test_the_metadata_has_the_rate_and_else_the_samples_show_it(rate, missing):
    found = judge(GRID, rate=rate)
    assert (found.missing, found.rate) == (missing, 200.0 if missing else 100.0)


def test_an_event_changes_the_rate():
    slower = GRID[:10] + [GRID[9] + 2 * k * PERIOD for k in range(1, 6)]
    assert judge(slower, event(2, GRID[10], "parameters", publish_rate=50)).missing == 0
    assert judge(slower).missing == 5


def test_each_recording_has_its_rate():
    ordered = order(START, event(2, GRID[10]))
    stamps = GRID[:10] + [GRID[10] + k * PERIOD // 2 for k in range(10)]
    places = [*range(1, 11), *range(12, 22)]
    recordings = [Recording(0, "100"), Recording(1, "200")]
    # The second event, at the place 1, is the first one of the second recording.
    assert Grid(ordered, recordings).judge("torque", rows_of(stamps, places)).missing == 0


JUMP = event(2, GRID[15], "clock", **{"from": GRID[5], "to": GRID[15]})
STEP = event(2, GRID[5], "step", to=GRID[15])
ENDED = event(2, GRID[5], "record")
BEGUN = event(3, GRID[15], "record")
ENDED.values["outcome.kind"], BEGUN.values["outcome.kind"] = "ended", "begun"


@pytest.mark.parametrize("events", [[JUMP], [STEP], [ENDED, BEGUN]])
def test_jumps_steps_and_pauses_of_a_recording_have_no_samples(events):
    stamps = GRID[:5] + GRID[15:]
    assert judge(stamps, *events).missing == 0
    assert judge(stamps, KICKS[0]).missing == 10
    assert judge(GRID[:4] + GRID[15:], *events).missing == 1


def test_tf_has_no_samples_while_it_is_switched_off():
    off = event(2, GRID[5], "parameters", publish_tf="false")
    on = event(3, GRID[15], "parameters", publish_tf="true")
    stamps = GRID[:5] + GRID[15:]
    assert judge(stamps, off, on, name="tf").missing == 0
    assert judge(stamps, off, on).missing == 10


def test_a_stamp_may_be_there_once_for_each_event_that_holds_at_it():
    back = event(2, GRID[5], "clock", **{"from": GRID[10], "to": GRID[5]})
    stamps = GRID[:10] + GRID[5:]
    places = [*range(10), *range(12, 27)]
    rows = StampRows()
    rows.add(np.array(GRID[:10]), np.arange(2, 12), np.ones(10, dtype=int))
    rows.add(np.array(GRID[5:]), np.arange(13, 28), np.full(15, 2))
    grid = Grid(order(START, back), [Recording(0, "100")])
    assert grid.judge("torque", rows).repeated == 0
    assert judge(stamps, places=places).repeated == 5
    assert judge([*GRID, *GRID]).repeated == 20


def test_time_that_goes_back_without_an_event_is_a_loss():
    assert judge(GRID[10:] + GRID[:5]).returns == (11,)
    assert judge(GRID).returns == ()


@pytest.mark.parametrize("rate", [300.0, 1000.0, 7.0])
def test_rows_of_a_grid_expand_to_its_stamps(rate):
    stamps = [round(k * 1e9 / rate) for k in range(500)]
    stamps = stamps[:100] + stamps[130:200] + stamps[150:]
    rows = rows_of(stamps[:77])
    rows.add(np.array(stamps[77:]), np.arange(78, len(stamps) + 1), np.zeros(len(stamps) - 77, int))
    found, places = rows.expand()
    assert np.abs(found - np.array(stamps)).max() <= ROUNDING
    assert places.tolist() == list(range(1, len(stamps) + 1))
    assert len(rows.rows) < 10
    assert rows.find_stamp(0, 51) == pytest.approx(stamps[49], abs=ROUNDING)
    assert rows.find_stamp(0, 1) is None
