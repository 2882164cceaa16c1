"""Tables are written between the comments that name them, and nothing else changes."""

from pathlib import Path

import pytest

from workshop.load import node_cost, stress
from workshop.speed import derivatives, filters, publish, testset

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


@pytest.mark.parametrize("kept", [1, 2])
@pytest.mark.parametrize("columns", range(2, 25))
def test_a_wide_table_is_several_narrow_ones_with_all_its_cells(columns, kept):
    head = [f"h{k}" for k in range(max(columns, kept))]
    rows = [[f"{row}{k}" for k in range(len(head))] for row in "ab"]
    tables = read_tables(publish.format_tables(head, rows, kept))
    for table in tables:
        assert {len(row) for row in table} == {len(table[0])}
        assert len(table[0]) <= publish.COLUMNS
        assert table[0][:kept] == head[:kept]
    for number, row in ((0, head), (2, rows[0]), (3, rows[1])):
        assert row[kept:] == [cell for table in tables for cell in table[number][kept:]]
    widths = [len(table[0]) for table in tables]
    assert max(widths) - min(widths) <= 1


def test_each_table_of_a_command_stands_in_one_page():
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    for name in SECTIONS:
        (table,) = filter(None, (publish.find_section(text, name) for text in texts))
        assert read_tables(table)
    assert sum(text.count("<!-- figures: ") for text in texts) == len(SECTIONS)


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*_tables.md")), ids=lambda p: p.stem)
def test_the_tables_of_a_page_of_tables_are_narrow(page):
    tables = read_tables(page.read_text(encoding="utf-8"))
    assert len(tables) > 3
    assert max(len(row) for each in tables for row in each) <= publish.COLUMNS


def test_sections_are_written_into_the_pages_that_have_them(docs):
    page = docs / "accuracy_tables.md"
    text = "# Title\n\n<!-- figures: chapters -->\nold\n<!-- end of figures -->\nend\n"
    page.write_text(text)
    publish.publish({"chapters": "new", "summary": "other"}, docs)
    assert page.read_text() == text.replace("old", "new")
    assert (docs.parent / "README.md").read_text() == "no section\n"
