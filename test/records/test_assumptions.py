"""The table of what is assumed: medians, and which violations are seen."""

from workshop.records.assumptions import ASSUMPTIONS, write_assumptions
from workshop.records.draws import FAULTS


def make_row(name, pull, verdict="holds", unknown=()):
    pulls = {"Mgl/Ix": pull, "theta": -pull}
    totals = {"Mgl/Ix": pull / 4}
    return {
        "name": name,
        "verdict": verdict,
        "unknown": unknown,
        "pulls": pulls,
        "totals": totals,
    }


def read_cells(rows):
    """The cells of the only row of the table."""
    (line,) = [*write_assumptions(rows)][2:]
    return [cell.strip() for cell in line.strip("|").split("|")]


def test_an_error_is_the_median_of_its_size_in_deviations_of_the_noise():
    rows = [make_row("barrel", pull) for pull in (-1.0, 2.0, -9.0)]
    assert read_cells(rows)[2:] == ["2.0", "-", "2.0", "0 of 3", "2 of 3"]


def test_a_record_in_doubt_counts_as_seen_and_so_does_a_mirrored_film_that_is_named():
    rows = [make_row("crop", 1.0, "unclear"), make_row("crop", 1.0)]
    assert read_cells(rows)[5] == "1 of 2"
    named = ["as a mirrored picture: ..."]
    rows = [make_row("mirrored", 1.0, unknown=named), make_row("mirrored", 1.0)]
    assert read_cells(rows)[5] == "1 of 2"
    assert read_cells([make_row("crop", 1.0, unknown=named)])[5] == "0 of 1"


def test_each_assumption_has_records():
    assert {each.record for each in ASSUMPTIONS} <= set(FAULTS)
