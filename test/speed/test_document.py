import re

import pytest
from documents import ROOT, find_section

from workshop.load import links, node_cost, starts, stress
from workshop.records import assumptions
from workshop.speed import derivatives, filters, many, summary, testset
from workshop.speed.ahead import TABLES
from workshop.speed.benchmarks import (
    DRIVEN_BEST,
    DRIVEN_OWN,
    ArrayCost,
    DrivenCase,
    Growth,
    HardCase,
    Results,
)
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


@pytest.mark.parametrize(("ours", "is_ahead"), [(1e-3, False), (3e-3, True)])
def test_a_peer_at_a_level_is_compared_with_the_series_at_this_level(ours, is_ahead):
    seconds = {TAYLOR: 4e-3, DRIVEN_OWN: ours, DRIVEN_BEST: 2e-3}
    errors = {TAYLOR: 1e-16, DRIVEN_OWN: 1e-10, DRIVEN_BEST: 1e-10}
    results = Results(driven=[DrivenCase("plain", errors, seconds)])
    lines = [line for line in TABLES["driven"](results) if "faster" in line]
    assert bool(lines) == is_ahead
    table = summary.format_others_ahead(results)
    assert (DRIVEN_BEST in table) == is_ahead


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
