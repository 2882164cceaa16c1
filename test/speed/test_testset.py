"""Scores in the test set: which run of a peer counts, and the files."""

import json

from workshop.speed import testset
from workshop.speed.reference import read_testset
from workshop.speed.testset import score_testset

PROBLEMS = read_testset()


def test_a_table_and_the_entries_are_written(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(testset, "read_testset", lambda: PROBLEMS[:2])
    monkeypatch.setattr(testset, "PROGRAMS", testset.PROGRAMS[:1])
    score_testset(tmp_path)
    entries = json.loads((tmp_path / "testset.json").read_text())["entries"]
    assert [entry["problem"] for entry in entries] == [motion.name for motion in PROBLEMS[:2]]
    assert max(entry["angle"] for entry in entries) <= 10 * 2.0**-52  # as promised
    assert "| 2 of 70 |" in (tmp_path / "testset.md").read_text()
    assert capsys.readouterr().out.endswith("testset.md and testset.json\n")
