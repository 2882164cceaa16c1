"""Derivatives compared with heyoka: the reference, and the table."""

import json

import numpy as np
import pytest
from physics.differences import differentiate

from workshop.main import main
from workshop.speed import derivatives
from workshop.speed.derivatives import derive_by_package, find_error, read_case

CASE = read_case()


def test_the_reference_is_made_again():
    found = differentiate(CASE.motion, CASE.times[:1])
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


def test_heyoka_has_the_same_derivatives():
    pytest.importorskip("heyoka")
    from workshop.speed.derivatives import Variations

    variations = Variations(CASE.motion)
    # its errors grow with the time: 5e-13 after 10 s
    assert find_error(variations.derive(CASE.times[0]), CASE.exact[0]) < 1e-12
    assert np.isfinite(variations.derive(1.0)).all()
