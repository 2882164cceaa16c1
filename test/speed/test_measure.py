"""The report in a small form: errors are asserted, never times."""

import json
import re

import pytest
from documents import ROOT, find_section
from PIL import Image

from symtop_ros.base import figure_style
from workshop.speed import benchmarks
from workshop.speed import measure as module
from workshop.speed.measure import measure
from workshop.speed.peers import CLOSED_FORM, TAYLOR, find_peers
from workshop.speed.plots import DRAWINGS
from workshop.speed.provenance import seal
from workshop.speed.reference import Reference
from workshop.speed.summary import NAME as MEASURED

DOCS = ROOT / "docs"
SECTION = re.compile("(?<=<!-- figures: ).*?(?=<!-- end of figures -->)", re.DOTALL)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folder of a report, and that of the documents into which it is written."""
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("workshop.speed.peers.peer.RECORDED", 256)  # a fortieth
        patch.setattr(benchmarks, "SPAN", 1.0)  # a tenth
        patch.setattr(benchmarks, "DRIVEN_RUNS", 1)
        patch.setattr(benchmarks, "FIRST_MOTION", ("SciPy DOP853, quaternion", "MuJoCo RK4"))
        patch.setattr(figure_style, "RESOLUTION", 100)
        patch.setitem(figure_style.SETTINGS, "figure.constrained_layout.use", False)
        docs = tmp_path_factory.mktemp("root") / "docs"
        docs.mkdir()
        for name in ("../README.md", "accuracy.md", "accuracy_tables.md", "many.md"):
            (docs / name).write_text((DOCS / name).read_text())
        assert measure(folder, benchmarks.SMALL, "make -C workshop report", docs) == 0
        yield folder, docs


@pytest.fixture(scope="module")
def report(written):
    return json.loads((written[0] / "report.json").read_text())


@pytest.fixture
def facts(report):
    return report["results"]


@pytest.mark.slow
def test_our_errors_are_rounding_at_all_times_and_in_all_hard_cases(facts):
    # As angles, twice the distances, as promised.
    (growth,) = [each for each in facts["growth"] if each["peer"] == CLOSED_FORM]
    assert growth["times"][-1] == 1e6
    assert max(growth["errors"]) <= benchmarks.LARGEST_ERROR
    assert len(facts["hard"]) == len(Reference.read().hard)
    assert max(case["error"] for case in facts["hard"]) <= benchmarks.LARGEST_ERROR


@pytest.mark.slow
def test_the_taylor_series_are_as_good_as_promised(facts):
    (curve,) = [each for each in facts["curves"] if each["peer"] == TAYLOR]
    # the largest of a second, as an angle
    assert curve["points"][-1]["error"] <= benchmarks.LARGEST_TAYLOR_ERROR
    assert len(facts["driven"]) == 14  # each ninth of 124
    # the largest is that after 50 s of the article's top, which docs/accuracy.md names
    largest = max(case["errors"][TAYLOR] for case in facts["driven"])
    assert largest <= benchmarks.LARGEST_DRIVEN_ERROR


@pytest.mark.slow
def test_every_peer_is_the_same_top_and_every_curve_has_points(facts, report):
    peers, missing = find_peers()
    chosen = [peer for peer in peers if benchmarks.SMALL.includes(peer, 0)]
    frictionless = [peer for peer in chosen if peer.friction != "only"]
    assert set(facts["checks"]) == {peer.name for peer in frictionless}
    scipy = [error for name, error in facts["checks"].items() if name.startswith("SciPy")]
    assert max(scipy) < 1e-9  # the finest tolerance is 1e-13
    assert all(curve["points"] for curve in facts["curves"])
    arrays = [state["peer"] for state in facts["states"]]
    every = [peer for peer in chosen if benchmarks.SMALL.includes(peer, 1)]
    assert arrays == [peer.name for peer in every if peer.prepare_arrays]
    assert report["environment"]["missing"] == missing


@pytest.mark.slow
def test_the_documents_have_the_tables_and_plots_of_the_report(written):
    folder, docs = written
    text = (folder / "report.md").read_text().partition("\n\n")[2].strip()
    page = (docs / "accuracy_tables.md").read_text()
    assert find_section(page, "chapters") == seal("chapters", text)
    summary = find_section((docs / "accuracy.md").read_text(), "summary")
    assert "| symtop_ros | closed form |" in summary
    readme = find_section((docs / "../README.md").read_text(), MEASURED)
    assert "|  | symtop_ros | " in readme
    for name in ("../README.md", "accuracy.md", "accuracy_tables.md", "many.md"):
        before, after = (SECTION.sub("", (each / name).read_text()) for each in (DOCS, docs))
        assert before == after  # what is written by hand is not changed
    assert {path.stem for path in docs.glob("*.png")} == {*DRAWINGS}


@pytest.mark.slow
@pytest.mark.parametrize("name", DRAWINGS)
def test_a_plot_is_a_picture(written, name):
    folder, _ = written
    assert (folder / f"{name}.svg").read_text().startswith("<?xml")
    with Image.open(folder / f"{name}.png") as picture:
        assert min(picture.size) > 200
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 50


def test_errors_that_are_too_large_fail_the_report(tmp_path, capsys, monkeypatch):
    def list_one(_, __, results):
        yield "a peer: model", lambda: results.checks.update({"a peer": 0.5})

    monkeypatch.setattr(module, "list_steps", list_one)
    monkeypatch.setattr(module, "_write", lambda *_: None)
    assert measure(tmp_path, benchmarks.SMALL, "make -C workshop report") == 1
    progress, failure = capsys.readouterr().err.splitlines()
    assert progress == "1 of 1: a peer: model"
    assert failure.startswith("workshop: above the limit: a peer: ")
