from dataclasses import fields

import pytest

from workshop.speed import document
from workshop.speed.ahead import FRICTION, TABLES
from workshop.speed.benchmarks import ArrayCost, DrivenCase, Growth, HardCase, Results
from workshop.speed.many import ManyCost
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.reference import Reference
from workshop.speed.sweep import Curve, Measurement


def curve(peer, motion):
    return Curve(peer, motion, 10.0, (Measurement(0.0, 1e-9, 1e-9, 9, 1e-3, 0.0),), "finest")


@pytest.mark.parametrize("by", ["peer", "motion"])
def test_a_report_can_be_written_after_each_curve(by):
    motion = Reference.read().article[0]
    names = [motion.name, "looping", "regular", FRICTION]
    pairs = [(CLOSED_FORM, name) for name in names[:-1]] + [(TAYLOR, FRICTION)]
    curves = [curve(*each) for each in [*pairs, *((peer, n) for peer in "ab" for n in names)]]
    curves.sort(key=lambda each: 0 if by == "peer" else names.index(each.motion))
    where = document.Environment("make report", "a machine", {}, [], 4.0)
    for count in range(1, len(curves) + 1):
        checks = dict.fromkeys((CLOSED_FORM, TAYLOR, "a", "b"), 0.0)
        text = document.format_document(Results(checks, curves[:count]), motion, where)
        assert "## Where a peer is ahead" in text
    assert "## Other motions" in text
    assert text.count("\n| b |") >= 3


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


def test_every_table_is_looked_at():
    assert {each.name for each in fields(Results)} == {*TABLES, "footprint"}


def test_a_peer_that_is_nowhere_ahead_is_not_named():
    assert document._format_ahead(results_of(1e-3, 2e-3)).endswith("- None.")
