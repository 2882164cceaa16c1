from pathlib import Path

import pytest

from workshop.load import node_cost, stress
from workshop.speed import derivatives, document, filters, publish, testset
from workshop.speed.ahead import FRICTION
from workshop.speed.benchmarks import Results
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


ROOT = Path(__file__).parents[2]
TESTSET = ROOT / "symtop_ros" / "testset" / "README.md"
PAGES = [TESTSET, ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SECTIONS = (
    *("chapters", "summary"),
    *(each.NAME for each in (derivatives, filters, testset, node_cost, stress)),
)


def read_tables(text):
    """The cells of each table of a text."""
    return [
        [[cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines()]
        for table in text.split("\n\n")
        if table.startswith("|")
    ]


def test_each_table_of_a_command_stands_in_one_page():
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    for name in SECTIONS:
        (table,) = filter(None, (publish.find_section(text, name) for text in texts))
        assert read_tables(table)
    assert sum(text.count("<!-- figures: ") for text in texts) == len(SECTIONS)


def test_sections_are_written_into_the_pages_that_have_them(docs):
    page = docs / "accuracy_tables.md"
    text = "# Title\n\n<!-- figures: chapters -->\nold\n<!-- end of figures -->\nend\n"
    page.write_text(text)
    publish.publish({"chapters": "new", "summary": "other"}, docs)
    assert page.read_text() == text.replace("old", "new")
    assert (docs.parent / "README.md").read_text() == "no section\n"
