"""The example with VQF: a magnetometer gives it the heading, and the page has its numbers."""

import pytest
from documents import ROOT

pytest.importorskip("vqf", reason="no vqf: pip install vqf")
from examples.heading_with_vqf import find_headings

PAGE = ROOT / "docs" / "filters.md"


@pytest.mark.parametrize(
    ("scene", "rate", "shown"),
    [("conical_pendulum", 1e3, "0.0006"), ("cusps", 1e3, "0.01"), ("cusps", 1e4, "0.002")],
)
def test_a_filter_with_a_magnetometer_finds_the_heading(scene, rate, shown):
    found = find_headings(scene, rate)
    assert found["without"] == pytest.approx(2.0, rel=0.2)  # it keeps the heading of its start
    assert f"{found['with']:.1g}" == shown  # the noise is the same in every run
    assert f" {shown} " in PAGE.read_text().replace("\n", " ")
