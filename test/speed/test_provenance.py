"""Tables of the documents are those that a command wrote, and say which sources they measure."""

import pytest
from documents import ROOT, find_section

from workshop.load.node_cost import BARE, COST_RATES, CPU, HIGHEST, PREPARED, TOP, format_few
from workshop.speed.provenance import (
    LIST,
    TABLES,
    digest_sources,
    find_pages,
    list_tables,
    seal,
)
from workshop.speed.publish import replace_section
from workshop.speed.tables import format_list_of_tables

FOUND = [*list_tables(find_pages(ROOT / "docs"))]
PAGE = "before\n<!-- figures: starts -->\n<!-- end of figures -->\nafter\n"
TABLE = "| | top_node |\n| --- | --: |\n| first answer, ms | 2.95 |"


def test_every_table_that_a_command_writes_has_sources_that_exist():
    assert sorted(each.name for each in FOUND) == sorted(TABLES)
    for command, patterns in TABLES.values():
        makefile = (ROOT / "workshop/Makefile").read_text(encoding="utf-8")
        assert f"\n{command}: " in makefile
        assert all([*ROOT.glob(each)] for each in patterns)


@pytest.mark.parametrize("table", FOUND, ids=lambda each: each.name)
def test_no_hand_has_changed_a_table(table):
    assert table.is_whole, f"{table.name} in {table.page}: write it by make -C workshop"


def test_a_figure_that_a_hand_changes_is_found(tmp_path):
    page = tmp_path / "page.md"
    written = replace_section(PAGE, "starts", TABLE)
    page.write_text(written)
    (table,) = list_tables([page])
    assert table.is_whole
    assert table.is_of_these_sources()
    page.write_text(written.replace("2.95", "2.59"))
    (changed,) = list_tables([page])
    assert not changed.is_whole


def test_a_table_that_is_written_again_has_one_seal():
    once = replace_section(PAGE, "starts", TABLE)
    assert replace_section(once, "starts", TABLE) == once
    assert once.count("<!-- of sources") == 1


def test_sources_that_change_have_another_digest(tmp_path):
    file = tmp_path / "workshop/speed/derivatives.py"
    file.parent.mkdir(parents=True)
    digests = set()
    for text in ("one", "two"):
        file.write_text(text)
        digests.add(digest_sources("derivatives", tmp_path))
    file.write_bytes(b"two\r\n")  # the ends of lines are those of the checkout
    digests.add(digest_sources("derivatives", tmp_path))
    assert len(digests) == 2


def test_the_list_says_which_tables_have_other_sources():
    page = (ROOT / "docs/accuracy_tables.md").read_text(encoding="utf-8")
    told = "run python -m workshop tables: sources of a table have changed"
    assert find_section(page, LIST) == format_list_of_tables(FOUND), told


def test_tables_of_one_run_have_the_same_sources():
    of = {each.name: each.sources for each in FOUND}
    assert of["chapters"] == of["summary"] == of["others ahead"] == of["measured motion"]
    assert of["node cost"] == of["measured node"]


def test_the_list_itself_has_no_seal():
    assert seal(LIST, TABLE) == TABLE


def test_the_figures_of_the_readme_show_where_a_bare_node_is_ahead():
    runs = {
        f"{COST_RATES[0]:.0f} Hz: {CPU}": {TOP: [14.0, 15.0], BARE: [21.0], PREPARED: [14.5]},
        HIGHEST: {TOP: [1000.0], BARE: [1500.0], PREPARED: [1000.0]},
    }
    _, _, cpu, rate = format_few(runs).splitlines()
    assert cpu.endswith("| 14 % | 21 % | 14 % |")
    assert rate.endswith("| 1000 Hz | 1500 Hz | 1000 Hz |")
