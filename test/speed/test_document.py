from dataclasses import fields

import pytest

from workshop.speed import document
from workshop.speed.ahead import FRICTION, TABLES, list_ahead
from workshop.speed.benchmarks import ArrayCost, DrivenCase, Growth, HardCase, Results
from workshop.speed.many import ManyCost
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.reference import Reference
from workshop.speed.sweep import Curve, Measurement


def curve(peer, motion):
    return Curve(peer, motion, 10.0, (Measurement(0.0, 1e-9, 1e-9, 9, 1e-3, 0.0),), "finest")


def test_the_table_of_other_motions_has_a_row_for_each_peer():
    problem = Reference.read().article[0]
    curves = [curve(peer, name) for name in ("looping", "sleeping") for peer in ("a", "b")]
    results = Results(curves=[curve("a", problem.name), *curves])
    text = document._format_other_motions(results, problem)
    rows = [line for line in text.splitlines() if line.startswith("|")]
    assert rows[0] == "|  | looping | sleeping |"
    assert rows[2:] == [f"| {peer} | 1e-09 in 1 | 1e-09 in 1 |" for peer in ("a", "b")]


COMMAND = "make -C workshop report"


def test_the_conditions_of_a_report_are_a_list():
    environment = document.Environment(
        "make -C workshop report", "a machine", {"numpy": "2"}, ["drake"], 4.0
    )
    text = document.format_chapters(Results(), Reference.read().article[0], environment)
    first, empty, *lines = text.partition("\n\n## ")[0].splitlines()
    assert (first, empty) == ("Conditions:", "")
    assert all(line.startswith("- ") for line in lines)
    # the command, the machine, the versions, what is missing, and what a figure means
    for part in ("make -C workshop report", "a machine", "numpy 2", "drake", *document.CONDITIONS):
        assert sum(part in line for line in lines) == 1


@pytest.mark.parametrize("by", ["peer", "motion"])
def test_a_report_can_be_written_after_each_curve(by):
    motion = Reference.read().article[0]
    names = [motion.name, "looping", "regular", FRICTION]
    pairs = [(CLOSED_FORM, name) for name in names[:-1]] + [(TAYLOR, FRICTION)]
    curves = [curve(*each) for each in [*pairs, *((peer, n) for peer in "ab" for n in names)]]
    curves.sort(key=lambda each: 0 if by == "peer" else names.index(each.motion))
    where = document.Environment(COMMAND, "a machine", {}, [], 4.0)
    for count in range(1, len(curves) + 1):
        checks = dict.fromkeys((CLOSED_FORM, TAYLOR, "a", "b"), 0.0)
        text = document.format_document(Results(checks, curves[:count]), motion, where)
        assert "## Where a peer is ahead" in text
    assert "## Other motions" in text
    assert text.count("\n| b |") >= 3


def test_every_case_in_which_a_peer_is_ahead_is_named():
    def swept(peer, *points):
        found = tuple(Measurement(1.0, e, e, 9, s, 0.0) for e, s in points)
        return Curve(peer, "cusps", 10.0, found, "finest")

    results = Results(
        curves=[
            swept(CLOSED_FORM, (1e-15, 3e-4)),
            swept("fast", (1e-3, 1e-5), (1e-9, 1e-4), (1e-12, 1e-3)),
            swept("exact", (1e-17, 1.0)),
            swept("behind", (1e-12, 1.0)),
        ],
        states=[
            ArrayCost(CLOSED_FORM, (1, 10), (1.0, 2.0), 1e-15),
            ArrayCost("dense", (1, 10), (2.0, 1.0), 1e-14),
        ],
    )
    lines = [line for line in document._format_ahead(results).splitlines() if line.startswith("-")]
    # the sentences are the result: numbers are compared where they are found
    assert lines == [
        "- cusps: fast reaches 1.0e-09 rad in 0.1 ms, closed form 1.0e-15 in 0.3 ms.",
        "- cusps: exact is more exact, 1.0e-17 against 1.0e-15 rad, in 1e+03 ms.",
        "- cusps, mean error: exact is more exact, 1.0e-17 against 1.0e-15 rad.",
        "- Arrays of 10 states: dense is faster.",
    ]


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


def test_a_peer_that_is_faster_in_a_family_of_driven_motions_is_named():
    """Its errors are larger: only the median time is ahead."""
    errors, seconds = {TAYLOR: 1e-16, "peer": 1e-12}, {TAYLOR: 2e-3, "peer": 1e-3}
    results = Results(driven=[DrivenCase("rods", errors, seconds)] * 3)
    (line,) = list_ahead(results)
    assert line == "Friction and torques, rods, median: peer is faster, 1 against 2 ms."
