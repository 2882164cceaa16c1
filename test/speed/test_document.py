import re

import pytest
from documents import ROOT, find_section

from workshop.load import links, node_cost, starts, stress
from workshop.records import assumptions
from workshop.speed import derivatives, filters, many, summary, testset
from workshop.speed.ahead import TABLES
from workshop.speed.benchmarks import ArrayCost, DrivenCase, Growth, HardCase, Results
from workshop.speed.many import ManyCost
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.sweep import Curve, Measurement


def results_of(ours, peer):
    """Results in which the package and a peer each have one number for all errors and times."""
    pairs = {CLOSED_FORM: ours, "peer": peer}
    driven = {TAYLOR: ours, "peer": peer}
    return Results(
        checks=pairs,
        curves=[
            Curve(name, "cusps", 10.0, (Measurement(1.0, n, n, 9, n, n),), "finest")
            for name, n in pairs.items()
        ],
        growth=[Growth(name, 0.0, (10.0,), (n,), (n,)) for name, n in pairs.items()],
        states=[ArrayCost(name, (1,), (n,), n) for name, n in pairs.items()],
        many=[ManyCost(name, 9, n, n, 9, 5) for name, n in pairs.items()],
        hard=[HardCase("tilt", 0.1, 1.0, ours, {"peer": peer})],
        driven=[DrivenCase("plain", driven, driven)],
    )


@pytest.mark.parametrize("name", TABLES)
def test_a_peer_that_is_ahead_in_a_table_is_named(name):
    lines = [*TABLES[name](results_of(2e-3, 1e-3))]
    assert lines
    assert all("peer" in line for line in lines)


TESTSET = ROOT / "symtop_ros/truth/testset/README.md"
PAGES = [TESTSET, ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SECTIONS = (
    "chapters",
    "summary",
    "sources",
    summary.NAME,
    summary.AHEAD,
    node_cost.MEASURED,
    assumptions.NAME,
    *(
        each.NAME
        for each in (derivatives, filters, many, testset, links, node_cost, starts, stress)
    ),
)


def test_each_table_of_a_command_stands_in_one_page():
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    for name in SECTIONS:
        (table,) = filter(None, (find_section(text, name) for text in texts))
        assert re.search(r"^[|-] ", table, re.MULTILINE)
    assert sum(text.count("<!-- figures: ") for text in texts) == len(SECTIONS)
