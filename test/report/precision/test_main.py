"""The report in a small form: errors are asserted, never times."""

import json
import re

import pytest
from PIL import Image

from symtop_ros.report.precision import main as report
from symtop_ros.report.precision.chapters import SMALL, Growth, HardCase, Results, _grow
from symtop_ros.report.precision.document import _other_motions, table
from symtop_ros.report.precision.measure import Curve, Point
from symtop_ros.report.precision.peers.own import CLOSED_FORM, SPLITTING
from symtop_ros.report.precision.peers.peer import Peer
from symtop_ros.report.precision.reference import EPS, Reference

PLOTS = ("work_precision", "motions", "long_times", "arrays", "hard_cases")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "made" / "here"
    assert report.measure(folder, SMALL, "top_report") == 0
    return folder


@pytest.fixture(scope="module")
def facts(folder):
    return json.loads((folder / "report.json").read_text())


def test_our_errors_are_rounding_at_all_times_and_in_all_hard_cases(facts):
    # Measured: 2.5 eps and 2.2 eps; what the package promises for a reference motion is 5
    (growth,) = [each for each in facts["growth"] if each["peer"] == CLOSED_FORM]
    assert growth["times"][-1] == 1e6
    assert max(growth["errors"]) <= 5 * EPS
    assert len(facts["hard"]) == len(Reference.read().hard)
    assert max(case["error"] for case in facts["hard"]) <= 5 * EPS


def test_the_splitting_is_as_good_as_promised(facts):
    (curve,) = [each for each in facts["curves"] if each["peer"] == SPLITTING]
    assert curve["points"][0]["error"] < 2e-12  # 9e-13 measured


def test_every_peer_is_the_same_top_and_every_curve_has_points(facts):
    assert max(facts["checks"].values()) < 1e-9  # of those that are always there
    assert all(curve["points"] for curve in facts["curves"])
    assert {state["peer"] for state in facts["states"]} >= {CLOSED_FORM}


def test_the_document_has_every_chapter_and_its_plots(folder):
    text = (folder / "report.md").read_text()
    heads = re.findall(r"^## (.+)$", text, flags=re.MULTILINE)
    assert len(heads) == 5
    for name in re.findall(r"\((\w+)\.svg\)", text):
        assert (folder / f"{name}.svg").read_text().startswith("<?xml")
    for line in (line for line in text.splitlines() if line.startswith("|")):
        assert line.endswith("|")


@pytest.mark.parametrize("name", PLOTS)
def test_a_plot_is_a_picture(folder, name):
    with Image.open(folder / f"{name}.png") as picture:
        assert min(picture.size) > 400
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 50


def test_a_table_has_as_many_cells_in_each_row():
    lines = table(["", "a"], [["b", "1"], ["c", "2"]]).splitlines()
    assert lines == ["|  | a |", "| --- | --: |", "| b | 1 |", "| c | 2 |"]


def test_errors_that_are_too_large_fail_the_report(tmp_path, capsys, monkeypatch):
    results = Results(
        checks={"a peer": 0.5},
        curves=[curve(CLOSED_FORM, "cusps", 1e-10), curve(SPLITTING, "cusps with friction", 1e-9)],
        growth=[Growth(CLOSED_FORM, 0.0, (10.0, 1e5), (1e-16, 1.0), (1e-4, 1e-4))],
        hard=[HardCase("tilt", 0.1, EPS, 20 * EPS, {}), HardCase("spin", 1.0, EPS, EPS, {})],
    )
    monkeypatch.setattr(report, "_measured", lambda *_: results)
    monkeypatch.setattr(report, "_write", lambda *_: None)
    assert report.measure(tmp_path, SMALL, "top_report") == 1
    assert capsys.readouterr().err.splitlines() == [
        "top_report: not as promised: a peer: another model",
        "top_report: not as promised: tilt, 0.1",
        "top_report: not as promised: cusps at 10 s: 1.0e-10",
        "top_report: not as promised: cusps at 100000 s: 1.0e+00",
        "top_report: not as promised: cusps at 1e+06 s: inf",
        "top_report: not as promised: symtop_ros, splitting: 1.0e-09",
    ]


def curve(peer, motion, error):
    return Curve(peer, motion, 10.0, (Point(0.0, error, 1e-3, 0.0),))


def test_a_folder_that_cannot_be_written_is_told_in_one_line(tmp_path, capsys):
    (tmp_path / "file").write_text("in the way")
    assert report.measure(tmp_path / "file", SMALL, "top_report") == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"top_report: {tmp_path / 'file'}: File exists"


def test_the_cheapest_point_is_the_fastest_that_is_good_enough():
    points = (Point(1.0, 1e-3, 1.0, 0.0), Point(0.1, 1e-7, 3.0, 0.0), Point(0.01, 1e-8, 2.0, 0.0))
    found = Curve("a peer", "cusps", 10.0, points)
    assert found.cheapest(1e-6).seconds == 2.0
    assert found.cheapest(1e-9) is None
    assert found.best.setting == 0.01


def test_a_peer_that_cannot_go_on_ends_where_it_is():
    problem = Reference.read().article[0]

    def solve(t):
        if t > 10.0:
            raise RuntimeError("too many steps")
        return problem.start.orientation

    peer = Peer("a peer", (1.0,), lambda *_: solve)
    results = Results(curves=[curve("a peer", "cusps", 1e-3)])
    _grow(peer, problem, SMALL, results)
    assert [each.times for each in results.growth] == [(10.0,)]


def test_the_documents_table_of_other_motions_has_a_row_for_each_peer():
    problem = Reference.read().article[0]
    curves = [curve(peer, name, 1e-9) for name in ("looping", "sleeping") for peer in ("a", "b")]
    text = _other_motions(Results(curves=[curve("a", problem.name, 1e-3), *curves]), problem)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert rows[0] == "|  | looping | sleeping |"
    assert rows[2:] == [f"| {peer} | 1e-09 in 1 | 1e-09 in 1 |" for peer in ("a", "b")]
