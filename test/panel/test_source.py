"""The top of the page itself: requests, a clock that only a watched page moves, and its log."""

import threading
from itertools import pairwise

import pytest
from exact_log import assert_exact

from symtop_ros.log.reader import McapFile
from symtop_ros.panel import source
from symtop_ros.panel.source import LONGEST_STEP, LocalTop
from symtop_ros.session.recording import Answer
from symtop_ros.simulation.changes.timeline import Change

SECOND = 1_000_000_000


@pytest.fixture(name="clock")
def _clock(monkeypatch):
    """The time that `time.monotonic` returns; the test advances it."""
    now = [100.0]
    monkeypatch.setattr(source.time, "monotonic", lambda: now[0])
    return now


@pytest.fixture(name="top")
def _top(clock, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    top = LocalTop("hurry_slow", factor=0.1)
    top.watch(True)
    top.batch()
    yield top
    top.close()


def names(batch):
    return [event.name for _, event in batch.events]


def advance(top, clock, seconds):
    """Watch the top in frames of 20 ms, and return all batches."""
    batches = []
    for _ in range(round(seconds / 0.02)):
        clock[0] += 0.02
        batches.append(top.batch())
    return batches


def test_a_request_is_answered_as_by_the_node(top):
    granted, answer = top.request("kick", {"precession_rate_factor": 1.4})
    assert granted
    batch = top.batch()
    assert names(batch) == ["kick"]
    assert answer == batch.events[0][1].verdict


def test_a_batch_never_ends_between_the_first_sample_of_a_kick_and_its_event(
    top, clock, monkeypatch
):
    kicked, collected = threading.Event(), threading.Event()

    describe = Change.event

    def describe_late(change, number):
        """Take time, as a verdict does; the sample has been sent, the event has not."""
        kicked.set()
        collected.wait(0.2)
        return describe(change, number)

    monkeypatch.setattr(Change, "event", describe_late)
    kick = threading.Thread(target=top.request, args=("kick", {"precession_rate_factor": 1.4}))
    monkeypatch.setattr(top, "_keep_up", lambda: (kick.start(), kicked.wait(10.0)))
    clock[0] += 0.02
    batch = top.batch()
    collected.set()
    kick.join()
    assert names(batch) == ["kick"]


def test_a_refused_request_changes_nothing(top):
    assert top.request("kick", {"precession_rate": float("nan")})[0] is False
    granted, answer = top.set_parameters({"top.Iz": 1.0})
    assert not granted
    assert "top.Iz must be" in answer
    assert names(top.batch()) == []


def test_samples_come_at_the_rate_of_the_scene_while_somebody_watches(top, clock):
    batches = advance(top, clock, 0.5)
    stamps = [stamp for each in batches for stamp in each.columns["orientation"].stamps.tolist()]
    assert len(stamps) == 100  # 200 Hz
    assert {later - earlier for earlier, later in pairwise(stamps)} == {5_000_000}


def test_an_unwatched_top_waits(top, clock):
    before = top._clock.now
    top.watch(False)
    assert not any(batch.columns for batch in advance(top, clock, 1.0))
    top.watch(True)
    advance(top, clock, 0.02)
    advance(top, clock, 0.02)
    # The first batch only begins to count.
    assert top._clock.now - before == pytest.approx(0.02 * SECOND, abs=1)  # rounded to 1 ns


def test_a_slow_browser_makes_a_slow_motion_and_no_gap(top, clock):
    before = top._clock.now
    clock[0] += 10.0
    batch = top.batch()
    assert top._clock.now - before == LONGEST_STEP * SECOND
    assert len(batch.columns["orientation"].stamps) == 10
    assert top.reports() == []


def test_a_torque_acts_until_its_time_out(top, clock):
    top.hold_torque((0.0, 0.0, 5e-4))
    batches = advance(top, clock, 0.6)
    assert [name for batch in batches for name in names(batch)] == ["torque", "torque"]
    events = [event for batch in batches for _, event in batch.events]
    assert events[0].values["applied_torque"] == "0.0 0.0 0.0005"
    assert events[1].values["applied_torque"] == "0.0 0.0 0.0"
    top.hold_torque((0.0, 0.0, float("inf")))
    (report,) = top.reports()
    assert report.startswith("applied_torque must be 3 numbers")


def test_a_recording_is_a_log_that_agrees_with_its_events_to_the_last_bit(top, clock):
    assert top.log is None
    granted, answer = top.request("record", True)
    assert granted
    advance(top, clock, 0.3)
    top.request("kick", {"precession_rate_factor": 1.4})
    advance(top, clock, 0.3)
    granted, answer = top.request("record", False)
    assert granted
    assert answer == str(Answer("recorded", str(top.log)))
    assert assert_exact(top.log) >= 110  # samples: 0.6 s at 200 Hz, less the first frames


def test_a_recording_is_finished_when_the_program_ends(top, clock, tmp_path):
    top.request("record", True)
    advance(top, clock, 0.3)
    top.close()
    (path,) = (tmp_path / "logs").glob("*.mcap")
    assert McapFile(path).problems == []
    assert assert_exact(path) >= 50  # samples: 0.3 s at 200 Hz, less the first frames


def test_a_folder_that_cannot_be_written_is_refused(clock, tmp_path, monkeypatch):
    (tmp_path / "logs").write_text("a file in place of the folder")
    monkeypatch.chdir(tmp_path)
    top = LocalTop("cusps", factor=1.0)
    granted, answer = top.request("record", True)
    assert not granted
    assert answer.startswith("record.directory must be ")
    top.close()


def test_an_integrated_motion_is_sampled_as_well(top, clock):
    assert top.set_parameters({"friction.axial": 1e-6})[0]
    batches = advance(top, clock, 0.5)
    assert sum(len(each.columns["orientation"].stamps) for each in batches if each.columns) == 100
