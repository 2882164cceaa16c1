import numpy as np
import pytest

from symtop_ros.report import load
from symtop_ros.report import main as report
from symtop_ros.report.listener import Traffic


def test_the_node_is_measured_beside_a_bare_one(capsys, monkeypatch):
    monkeypatch.setattr(load, "LOAD_RATES", (1000.0,))
    monkeypatch.setattr(load, "RATES", (500.0,))
    monkeypatch.setattr(load, "KICKS", 10)
    assert report.main(["--node", "--seconds", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    cut = load.NAME
    figures = {line[:cut].strip(): list(map(float, line[cut:].split())) for line in lines[2:]}
    assert 0 < figures["1000 Hz: samples arrived (%)"][0] <= 100
    ours, bare, ratio = figures["1000 Hz: CPU per message (us)"]
    assert ratio == pytest.approx(ours / bare, abs=0.01)  # as printed
    assert figures["1000 Hz, recording: CPU of a core (%)"][0] > 0
    assert all(0 < latency < 1e4 for latency in figures["1000 Hz: kick latency p50 (ms)"][:2])
    assert "highest rate, < 0.1% late (Hz)" in figures


def test_late_samples_and_jitter_are_counted_from_when_they_were_sent():
    sent = np.array([0.0, 0.010, 0.020, 0.0305, 0.0605, 0.070])
    found = load.figures(Traffic(sent, arrived=1.0, messages=30, cpu=0.003), 100.0, 0.07)
    assert found.late == pytest.approx(1 / 5)
    assert found.jitter[2] == pytest.approx(20e3)  # us
    assert found.message == pytest.approx(100.0)
    assert found.core == pytest.approx(0.003 / 0.07)
