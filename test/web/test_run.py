"""The state of the page follows events and samples."""

import csv
import io

import numpy as np
import pytest

from symtop_ros.panel.source import LocalTop
from symtop_ros.web.run import ROWS, SERIES, TRACE, Run

FRAME = 0.02  # s; `batch` advances the clock by at most 0.05 s


@pytest.fixture(name="watched")
def _watched(monkeypatch):
    """A top, its run, and a function that lets it move for a number of frames."""
    top, run = LocalTop("hurry_slow", factor=0.1), Run()
    now = [0.0]
    monkeypatch.setattr("symtop_ros.panel.source.time.monotonic", lambda: now[0])
    top.watch(True)

    def move(frames):
        for _ in range(frames):
            now[0] += FRAME
            run.follow(top.batch())

    move(1)
    yield top, run, move
    top.close()


def test_the_state_is_that_of_the_last_sample(watched):
    _, run, move = watched
    move(5)
    expected = run.segment.state_at(run.stamp)
    assert np.array_equal(run.state.orientation, expected.orientation)
    assert np.array_equal(run.state.angular_velocity, expected.angular_velocity)


def test_a_kick_has_a_ghost_and_a_verdict(watched):
    top, run, move = watched
    assert run.ghost.segment is None
    top.request("kick", {"precession_rate_factor": 1.4})
    move(3)
    found = run.announced.event.outcome()
    assert (round(found.before, 2), round(found.after, 2)) == (6.5, 9.1)
    assert run.ghost.segment is not None
    assert run.ghost.segment.motion.kind == "regular"
    assert run.motion.kind == "unidirectional"
    top.request("reset")
    move(1)
    assert run.ghost.segment is None


def test_the_series_go_on_in_the_time_of_the_motion(watched):
    top, run, move = watched
    move(50)
    times = run.series()[:, 0]
    # 200 samples a second at a tenth of real time
    assert np.diff(times) == pytest.approx(0.0005, rel=1e-6)  # times are sums of rounded parts
    top.request("pause", True)
    move(10)
    paused = len(run.series())
    move(10)
    assert len(run.series()) == paused
    before = run.series()[-1, 0]
    top.request("step", {"duration": 0.25})
    move(2)
    assert run.series()[-1, 0] == pytest.approx(before + 0.25, abs=1e-12)  # sums of doubles below 1


def test_the_series_are_those_of_the_closed_form(watched):
    _, run, move = watched
    move(20)
    row = dict(zip(SERIES, run.series()[-1, 1:].tolist(), strict=True))
    assert row["theta"] == pytest.approx(0.5, abs=1e-15)  # regular precession: it does not change
    assert row["L_z"] == pytest.approx(run.motion.top.axial_momentum(run.motion.start), rel=1e-15)
    assert all(
        abs(change) <= 1e-15 for _, change in run.drifts().values()
    )  # J and N m s, all < 1.3


def test_old_rows_are_dropped_in_time(watched):
    _, run, move = watched
    move(5)
    rows = run.series().copy()
    run._make_room(2 * ROWS - len(rows))
    assert len(run.series()) == len(rows)  # there is room for them
    run._count = 2 * ROWS
    run._rows[:, 0] = np.arange(2 * ROWS)
    run._make_room(10)
    assert run.series()[0, 0] == ROWS + 10
    assert run.series()[-1, 0] == 2 * ROWS - 1


def test_the_trace_ends_at_the_axis(watched):
    _, run, move = watched
    move(30)
    assert run.axes.shape == (TRACE + 1, 3)
    assert np.abs(run.axes[-1] - run.state.to_world([0.0, 0.0, 1.0])).max() < 1e-15
    assert np.abs(np.linalg.norm(run.axes, axis=1) - 1).max() < 1e-15  # rounding of one rotation


def test_the_history_keeps_one_of_several_starts_in_a_row(watched):
    top, run, move = watched
    for theta in (0.3, 0.4, 0.5):
        top.request("set_initial_conditions", {"theta": theta})
    top.request("kick", {"precession_rate": 9.0})
    top.request("kick", {"precession_rate": 8.0})
    top.request("pause", True)
    move(2)
    assert [event.name for event in run.history] == ["start", "kick", "kick"]
    assert run.history[0].request == {"theta": "0.5"}


def test_the_file_of_the_series_reads_back_to_the_same_numbers(watched):
    _, run, move = watched
    move(10)
    names, *rows = csv.reader(io.StringIO(run.csv()))
    assert names[:3] == ["time (s)", "theta (rad)", "phi_dot (rad/s)"]
    numbers = np.array([[value or "nan" for value in row] for row in rows], dtype=float)
    assert np.array_equal(numbers, run.series(), equal_nan=True)
    assert np.isnan(numbers[:, -1]).all()  # no kick, no ghost


def test_a_recording_is_noticed(watched, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    top, run, move = watched
    top.request("record", True)
    move(2)
    assert run.is_recording
    top.request("record", False)
    move(2)
    assert not run.is_recording


def test_what_leaves_the_motion_leaves_the_time_of_the_run(watched, tmp_path, monkeypatch):
    """A recording, another hurry factor, another speed, a pause: the motion just goes on."""
    monkeypatch.chdir(tmp_path)
    top, run, move = watched
    move(5)
    window, offset = run.window, run.time - run.segment.time_at(run.stamp)
    for act in (
        lambda: top.request("record", True),
        lambda: top.set_parameters({"hurry_factor": 1.7}),
        lambda: top.request("record", False),
        lambda: top.set_parameters({"real_time_factor": 0.2}),
        lambda: top.request("pause", True),
        lambda: top.request("step", {"duration": 0.01}),
        lambda: top.request("pause", False),
    ):
        assert act()[0]
        move(5)
        assert run.time - run.segment.time_at(run.stamp) == pytest.approx(offset, abs=1e-15)
        assert run.window == window
    times = run.series()[:, 0]
    assert np.diff(times).min() > 1e-9  # no sample twice


def test_the_time_goes_on_over_a_kick(watched):
    top, run, move = watched
    move(5)
    before = run.time
    top.request("kick", {"precession_rate_factor": 1.4})
    move(1)
    assert run.moments[-1].time == pytest.approx(before, abs=0.0006)  # a sample period
    assert 0 < run.time - before < 0.003  # a frame of 0.02 s at a tenth, and a sample period
    assert np.isfinite(run.series()[-1, -1])  # the ghost's tilt


def test_speed_and_torque_are_not_announced(watched):
    top, run, move = watched
    top.request("kick", {"precession_rate_factor": 1.4})
    move(1)
    kick = run.announced
    top.set_parameters({"real_time_factor": 0.3})
    top.hold_torque((0.0, 0.0, 1e-4))
    move(2)
    assert run.event.name == "torque"
    assert run.announced is kick
    top.set_parameters({"top.Mgl": 0.05})
    move(1)
    assert run.announced.event.name == "parameters"


def test_rows_are_given_once(watched):
    _, run, move = watched
    move(3)
    count, rows = run.series_since(0)
    assert count == len(rows) == len(run.series())
    move(2)
    later, more = run.series_since(count)
    assert len(more) == later - count > 0
    run._make_room(2 * ROWS - len(run.series()) + 1)  # rows are dropped
    assert run.series_since(later)[0] == later
