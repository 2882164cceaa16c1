"""The filters' report in a small form: no filter's error is asserted but where it is known."""

import json

import numpy as np
import pytest

from symtop_ros.judge.estimates import Estimates
from workshop import main as report
from workshop.speed import filters
from workshop.speed.filters import MOUNTS, format_trials, judge_filters, record, run_filter


@pytest.fixture
def short(monkeypatch):
    for name, value in {"SPAN": 1, "SCENES": ("conical_pendulum",)}.items():
        monkeypatch.setattr(filters, name, value)
    monkeypatch.setattr(filters, "FILTERS", ("AngularRate", "Mahony"))


def test_a_sensor_in_the_pivot_feels_gravity_alone(short):
    recording = record("cusps", MOUNTS["in the pivot"])
    # white noise of 1.7e-3 sqrt(1000 Hz) = 0.054 m/s^2 in each of 1000 samples, five sigma
    assert np.abs(np.linalg.norm(recording.forces, axis=1) - 9.81).max() < 5 * 0.054
    beside = record("cusps", MOUNTS["1 cm beside the axis"])
    assert np.linalg.norm(beside.forces, axis=1).min() > 300  # 200^2 rad^2/s^2 at 1 cm
    own = Estimates.of(recording.stamps, recording.orientations)
    assert filters.compare(own, recording.truth).total.max() < 1e-15


def test_without_spin_the_integrated_gyroscope_is_good_for_a_second(short):
    pytest.importorskip("ahrs")
    errors = run_filter("AngularRate", record("conical_pendulum", MOUNTS["in the pivot"]))
    # A rate from one end of a step is half a step late: as it turns by up to twice its 3 rad/s, the
    # error is at most 3e-3 rad. The noise adds 2.4e-4 rad/sqrt(s), three sigma. 2e-3 is found.
    assert errors.total.max() < 3.7e-3


def test_tables_and_plot_are_written(short, tmp_path, capsys):
    pytest.importorskip("ahrs")
    assert judge_filters(tmp_path / "new") == 0
    facts = json.loads((tmp_path / "new" / "filters.json").read_text())
    assert (tmp_path / "new" / "filters.md").read_text() == format_trials(facts) + "\n"
    assert len(facts["trials"]) == 2 * len(MOUNTS)
    assert (tmp_path / "new" / "filters.svg").stat().st_size > 1000
    assert capsys.readouterr().out.endswith("filters.json and a plot\n")
    file = tmp_path / "file"
    file.write_text("")
    assert report.main(["filters", str(file)]) == 1
    assert capsys.readouterr().err.startswith(f"workshop: {file}: ")
