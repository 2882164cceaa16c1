from pathlib import Path

import numpy as np
import pytest

from workshop.load import node_cost
from workshop.load.listener import Traffic
from workshop.speed.publish import find_section

ROOT = Path(__file__).parents[2]


@pytest.mark.long
def test_the_node_is_measured_and_compared_with_bare_ones(capsys, monkeypatch, docs):
    monkeypatch.setattr(node_cost, "COST_RATES", (200.0,))
    monkeypatch.setattr(node_cost, "RATES", (500.0,))
    monkeypatch.setattr(node_cost, "KICKS", 10)
    page = docs / "reliability.md"
    page.write_text("<!-- figures: node cost --><!-- end of figures -->")
    kept, write = [], node_cost.format_sections
    monkeypatch.setattr(node_cost, "format_sections", lambda each: kept.append(each) or write(each))
    assert node_cost.main(["--seconds", "1", "--runs", "1", "--docs", str(docs)]) == 0
    (facts,) = kept
    assert facts["count"] == 1
    cpu = facts["runs"][f"200 Hz: {node_cost.CPU}"]
    assert set(cpu) == set(node_cost.list_commands(""))
    assert all(0 < value < 200 for values in cpu.values() for value in values)
    assert all(0 < value < 1e4 for (value,) in facts["runs"][f"200 Hz: {node_cost.KICK}"].values())
    sections = write(facts)
    assert sections["node cost"] in capsys.readouterr().out
    assert find_section(page.read_text(), "node cost") == sections["node cost"]


def test_late_samples_and_jitter_are_counted_from_the_time_of_publishing():
    sent = np.array([0.0, 0.010, 0.020, 0.0305, 0.0605, 0.070])
    figures = node_cost.summarize(Traffic(sent, 1.0, messages=30, cpu=0.003), 100.0, 0.07)
    assert figures[node_cost.LATE_SAMPLES] == pytest.approx(100 / 5)
    assert figures[node_cost.JITTER] == pytest.approx(20.0, rel=0.05)  # ms; p99 of five gaps
    assert figures[node_cost.CPU] == pytest.approx(100 * 0.003 / 0.07)


def test_lost_samples_are_late():
    sent = np.arange(100) * 0.01
    figures = node_cost.summarize(Traffic(sent, 0.75, messages=100, cpu=0.0), 100.0, 1.0)
    assert figures[node_cost.LATE_SAMPLES] == pytest.approx(25.0)
