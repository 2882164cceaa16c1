"""Which releases run, what differs between them, and rows for those that fail."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from workshop.releases import measure
from workshop.releases.engines import ENGINES, list_cases
from workshop.releases.measure import choose_next, find_jumps, measure_engine
from workshop.releases.page import format_releases

RELEASES = [f"1.{k}" for k in range(23)]
MUJOCO = ENGINES[0]


def row(error):
    return {"scores": {"RK4: level 0, worst": error}}


def run_all(score):
    """Return the releases that are run, in their order, and their rows."""
    rows = {}
    while (release := choose_next(RELEASES, rows)) is not None:
        rows[release] = score(RELEASES.index(release))
    return [*rows], rows


SAMPLE = ["1.0", "1.22", "1.5", "1.10", "1.15", "1.20"]


def test_the_oldest_the_newest_and_every_fifth_release_run():
    assert run_all(lambda _: row(0.25))[0] == SAMPLE


@pytest.mark.parametrize("place", range(1, 23))
def test_a_jump_is_found_between_two_neighbours_in_three_more_runs(place):
    order, _ = run_all(lambda k: row(0.25 if k < place else 0.75))
    assert {f"1.{place - 1}", f"1.{place}"} <= {*order}
    assert order[: len(SAMPLE)] == SAMPLE
    assert len(order) <= len(SAMPLE) + 3


def test_releases_that_fail_are_rows_and_are_passed_over():
    order, rows = run_all(lambda k: {"reason": "no"} if k in (7, 8) else row(0.25 * 4 ** (k > 8)))
    assert {"1.6", "1.9"} <= {*order}
    assert all("reason" in rows[each] for each in order if each in ("1.7", "1.8"))


def test_nothing_is_chosen_without_releases():
    assert choose_next([], {}) is None


def test_jumps_begin_at_a_factor_of_three_above_rounding():
    old = {"a": 0.5, "b": 0.5, "c": 1e-12, "d": 0.5, "gone": 1.0}
    new = {"a": 1.25, "b": 0.125, "c": 1e-10, "d": 2.5, "come": 1.0}
    assert find_jumps({"scores": old}, {"scores": new}) == ["d", "b"]


def test_a_release_that_does_not_install_is_a_row_with_its_reason(tmp_path, monkeypatch):
    monkeypatch.setattr(measure, "HOME", tmp_path)
    monkeypatch.setattr(measure, "list_releases", lambda _: {"1.0": Path("python3.1")})
    missing = replace(MUJOCO, name="Missing")
    (found,) = measure_engine(missing).values()
    assert found["reason"].startswith("does not install: ")
    assert json.loads((tmp_path / "Missing.json").read_text()) == {"1.0": found}
    assert [each.name for each in tmp_path.iterdir()] == ["Missing.json"]  # no environment is left


def test_a_level_is_scored_when_all_of_its_problems_are(tmp_path):
    names = {f"{each}.mjcf" for each in ("gentle_pole", "gentle_looping", "gentle_looping.offset")}
    cases = list_cases(MUJOCO, (0,), frozenset(names))
    assert [case["name"] for case in cases] == [
        "gentle_looping", "gentle_looping.offset", "gentle_pole"
    ]  # fmt: skip
    for name in ("gentle_looping", "gentle_looping.offset"):
        rows = [f"{t!r},1,0,0,0" for t in cases[0]["times"]]
        (tmp_path / f"RK4.{name}.csv").write_text("\n".join(["t,w,x,y,z", *rows]) + "\n")
    found = measure.read_scores(tmp_path, cases)
    assert [*found] == ["RK4: gentle_looping", "RK4: gentle_looping.offset"]
    (tmp_path / "RK4.gentle_pole.csv").write_text("t,w,x,y,z\n")  # it has no attitudes
    found = measure.read_scores(tmp_path, cases)
    assert found["RK4: level 0, worst"] == 3.141592653589793


def test_the_page_says_which_release_changed_what():
    facts = {engine.name: {} for engine in ENGINES}
    facts["MuJoCo"] = {"3.6.0": row(2.0), "3.7.0": row(0.125), "3.8.0": {"reason": "does not run"}}
    text = format_releases(facts)
    assert "| MuJoCo 3.7.0 | 3.6.0 | RK4 | level 0, worst | 2.0e+00 | 1.2e-01 |" in text
    assert f"- MuJoCo 3.7.0: {MUJOCO.log['3.7.0']}" in text
    assert "| MuJoCo 3.8.0 | does not run |" in text
