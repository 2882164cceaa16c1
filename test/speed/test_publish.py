"""The tables of the documentation are those of the figures that the report wrote."""

import json
import shutil
from pathlib import Path

import pytest

from workshop.speed.filters import format_trials
from workshop.speed.plots import NAMES
from workshop.speed.publish import (
    FIGURES,
    find_section,
    format_sections,
    publish,
    replace_section,
)
from workshop.speed.testset import format_scores

ROOT = Path(__file__).parents[2]
TESTSET = ROOT / "symtop_ros" / "testset" / "README.md"
PAGES = [TESTSET, ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FACTS = json.loads((ROOT / "docs" / FIGURES).read_text())
SECTIONS = {**format_sections(FACTS), "filters": format_trials(FACTS["filters"])}
SECTIONS["testset"] = format_scores(FACTS["testset"])
PUBLISHED = [
    (page, name)
    for page in PAGES
    for name in SECTIONS
    if find_section(page.read_text(), name) is not None
]


@pytest.mark.parametrize(("page", "name"), PUBLISHED, ids=lambda each: getattr(each, "name", each))
def test_no_figure_is_stale(page, name):
    assert find_section(page.read_text(), name) == SECTIONS[name]


def test_each_section_is_in_one_page():
    assert sorted(name for _, name in PUBLISHED) == sorted(SECTIONS)


def test_a_report_is_published_into_pages_and_plots(tmp_path):
    report, docs = tmp_path / "report", tmp_path / "docs"
    report.mkdir()
    docs.mkdir()
    shutil.copy(ROOT / "docs" / FIGURES, report / "report.json")
    for name in NAMES:
        (report / f"{name}.svg").write_text(name)
    page, readme = docs / "accuracy.md", tmp_path / "README.md"
    page.write_text("# Title\n\n<!-- figures: chapters -->\nold\n<!-- end of figures -->\nend\n")
    readme.write_text("no section\n")
    publish(report, docs)
    head, _, rest = page.read_text().partition(SECTIONS["chapters"])
    assert head == "# Title\n\n<!-- figures: chapters -->\n"
    assert rest == "\n<!-- end of figures -->\nend\n"
    assert readme.read_text() == "no section\n"
    assert {path.name for path in docs.iterdir()} == {
        "accuracy.md",
        FIGURES,
        *(f"{name}.svg" for name in NAMES),
    }


def test_a_text_without_the_section_is_unchanged():
    assert replace_section("a text", "summary", "new") == "a text"
