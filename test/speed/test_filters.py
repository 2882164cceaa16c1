"""The filters' report in a small form: no filter's error is asserted but where it is known."""

import json

import pytest
from physics.differences import FEW_DIGITS, differentiate

from workshop.main import main
from workshop.speed import derivatives, filters
from workshop.speed.derivatives import derive_by_package, find_error, read_case
from workshop.speed.filters import MOUNTS, format_trials


def test_tables_and_plot_are_written(monkeypatch, tmp_path, capsys):
    pytest.importorskip("ahrs")
    short = {"SPAN": 1, "SCENES": ("conical_pendulum",), "FILTERS": ("AngularRate", "Mahony")}
    for name, value in short.items():
        monkeypatch.setattr(filters, name, value)
    folder = tmp_path / "made" / "here"
    assert main(["filters", str(folder)]) == 0
    facts = json.loads((folder / "filters.json").read_text())
    assert (folder / "filters.md").read_text() == format_trials(facts) + "\n"
    assert len(facts["trials"]) == 2 * len(MOUNTS)
    assert (folder / "filters.svg").stat().st_size > 1000
    assert capsys.readouterr().out.endswith("filters.json and a plot\n")


CASE = read_case()


def test_the_reference_is_made_again():
    found = differentiate(CASE.motion, CASE.times[:1], FEW_DIGITS)
    # rounded to doubles, both
    assert find_error(found[0], CASE.exact[0]) < 1e-15


def test_the_package_is_as_exact_as_it_says():
    for t, exact in zip(CASE.times, CASE.exact, strict=True):
        assert find_error(derive_by_package(CASE.motion, t), exact) < 2e-12


def test_a_table_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr(derivatives, "RUNS", 1)
    short = CASE._replace(times=CASE.times[:2], exact=CASE.exact[:2])
    monkeypatch.setattr(derivatives, "read_case", lambda: short)
    assert main(["derivatives", str(tmp_path)]) == 0
    facts = json.loads((tmp_path / "derivatives.json").read_text())
    names = {each["program"] for each in facts["entries"]}
    assert "symtop_ros, Motion.jacobian" in names
    assert len(facts["entries"]) == len(names) * len(short.times)
    assert all(each["error"] < 1e-8 and each["seconds"] > 0 for each in facts["entries"])
    assert (tmp_path / "derivatives.md").read_text().startswith("| error, time | 0.1 s |")
