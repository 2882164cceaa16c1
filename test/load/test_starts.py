"""Starts of the node in a small form: every figure is there, none is asserted."""

import pytest
from documents import find_section

from workshop.load import starts

ALONE = ("CPU to the first sample, s", "first sample after, s", "first answer, ms")


@pytest.mark.long
@pytest.mark.realtime
def test_starts_of_the_node_are_measured_and_compared_with_bare_ones(capsys, tmp_path):
    (tmp_path / "README.md").touch()
    (docs := tmp_path / "docs").mkdir()
    page = docs / "reliability_tables.md"
    page.write_text("<!-- figures: starts --><!-- end of figures -->")
    given = ["--seconds", "0.5", "--runs", "2", "--nodes", "2", "--docs", str(docs)]
    assert starts.main(given) == 0
    section = find_section(page.read_text(), "starts")
    assert section in capsys.readouterr().out
    cells = [line.split("|")[1:-1] for line in section.splitlines() if line.startswith("| ")][2:]
    assert [name.strip() for name, *_ in cells[:3]] == [*ALONE]
    assert len(cells) == 9
    assert all(float(each.split("(")[0]) > 0 for _, *values in cells for each in values)


def test_a_table_has_the_middle_of_the_runs_and_many_nodes_last():
    runs = {
        "3 nodes: memory of each, MB": {name: [90.0] for name in starts.COMMANDS},
        ALONE[0]: {name: [0.4, 0.6, 0.5] for name in starts.COMMANDS},
    }
    section = starts.format_section(runs, conditions="here", seconds=5.0, count=3, requests=5)
    lines = section.splitlines()
    assert lines[-2] == f"| {ALONE[0]} | 0.5 (0.4 to 0.6) | 0.5 (0.4 to 0.6) |"
    assert lines[-1] == "| 3 nodes: memory of each, MB | 90 | 90 |"
