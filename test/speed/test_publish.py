"""Tables are written between the comments that name them, and nothing else changes."""

from pathlib import Path

from workshop.load import node_cost
from workshop.speed import derivatives, filters, testset
from workshop.speed.publish import find_section, publish, replace_section

ROOT = Path(__file__).parents[2]
TESTSET = ROOT / "symtop_ros" / "testset" / "README.md"
PAGES = [TESTSET, ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SECTIONS = (
    *("chapters", "summary"),
    *(each.NAME for each in (derivatives, filters, testset, node_cost)),
)


def test_each_table_of_a_command_stands_in_one_page():
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    for name in SECTIONS:
        (table,) = filter(None, (find_section(text, name) for text in texts))
        assert table.count("|") > 10
    assert sum(text.count("<!-- figures: ") for text in texts) == len(SECTIONS)


def test_sections_are_written_into_the_pages_that_have_them(tmp_path):
    docs = tmp_path / "docs"
    docs.mkdir()
    page, readme = docs / "accuracy.md", tmp_path / "README.md"
    page.write_text("# Title\n\n<!-- figures: chapters -->\nold\n<!-- end of figures -->\nend\n")
    readme.write_text("no section\n")
    publish({"chapters": "new", "summary": "other"}, docs)
    assert page.read_text() == (
        "# Title\n\n<!-- figures: chapters -->\nnew\n<!-- end of figures -->\nend\n"
    )
    assert readme.read_text() == "no section\n"


def test_a_text_without_the_section_is_unchanged():
    assert replace_section("a text", "summary", "new") == "a text"
