from pathlib import Path

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
