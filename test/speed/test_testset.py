"""Scores in the test set: which run of a peer counts, and the files."""

import json

import pytest

from workshop.speed import testset
from workshop.speed.peers.peer import Peer, Solution
from workshop.speed.reference import read_testset
from workshop.speed.testset import find_best_run, score_testset

PROBLEMS = read_testset()
CUSPS = next(motion for motion in PROBLEMS if motion.name == "cusps")


def make_peer(clock, **settings):
    """Return a peer with given errors (components of a quaternion) and seconds by the setting."""

    def prepare(task, setting):
        error, seconds = settings[f"s{setting}"]

        def reach(t):
            if error is None:
                raise RuntimeError("the step is too large")
            clock["taken"] = seconds
            high, _ = CUSPS.exact
            # the probe asks for a time that is not stored
            q = high[CUSPS.times.index(t)].copy() if t in CUSPS.times else high[0]
            q[0] += error
            return q

        return Solution(reach, None)

    return Peer("a peer", tuple(int(name[1:]) for name in settings), prepare)


@pytest.fixture
def clock(monkeypatch):
    """The time that a run takes, by its setting and not by the load of the machine."""
    taken = {"taken": 0.0}

    def measure(call, number):
        call()
        return taken["taken"]

    monkeypatch.setattr(testset, "timeit", measure)
    return taken


def test_the_best_run_within_the_limit_of_time_counts(clock):
    peer = make_peer(clock, s8=(None, 1e-4), s4=(1e-3, 1e-4), s2=(1e-5, 1e-4), s1=(1e-9, 0.05))
    (entry,) = find_best_run(peer, CUSPS, limit=0.01)
    assert (entry.peer, entry.problem, entry.level, entry.setting) == ("a peer", "cusps", 2, 2)
    assert entry.angle == pytest.approx(2e-5, rel=1e-3)
    limits = [2e-5 / CUSPS.limit(CUSPS.times[k]) for k in testset.PLACES]
    assert entry.limits == pytest.approx(max(limits), rel=1e-3)


def test_a_table_and_the_entries_are_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(testset, "read_testset", lambda: PROBLEMS[:2])
    monkeypatch.setattr(testset, "PROGRAMS", testset.PROGRAMS[:1])
    assert score_testset(tmp_path / "new") == 0
    entries = json.loads((tmp_path / "new" / "testset.json").read_text())["entries"]
    assert [entry["problem"] for entry in entries] == [motion.name for motion in PROBLEMS[:2]]
    assert max(entry["angle"] for entry in entries) <= 10 * 2.0**-52  # as promised
    assert "| 2 of 70 |" in (tmp_path / "new" / "testset.md").read_text()
    assert capsys.readouterr().out.endswith("testset.md and testset.json\n")
