"""Every measured figure of three pages has a command or a test that gives it."""

import re

import pytest
import yaml
from documents import ROOT

from workshop.speed.provenance import SECTION

PAGES = ("README.md", "docs/accuracy.md", "docs/many.md")
LIST = ROOT / "workshop/speed/figures.yaml"
GIVEN: dict[str, dict[str, str]] = yaml.safe_load(LIST.read_text(encoding="utf-8"))
UNIT = r"(?:eps|rad|ms|us|s|MB|GB|bytes|%|times|million|thousand|Hz|minutes?|hours?)"
FIGURE = re.compile(rf"(?<![\w.^/-])\d[\d.]*(?:e[-+]?\d+)?(?: to \d[\d.]*)? {UNIT}(?![\w^/])")
HIDDEN = re.compile(r"```.*?```|<!--.*?-->|`[^`]*`|(?<=\])\([^)]*\)", re.DOTALL)
BEGINS = re.compile(r"\n(?=\s*\n|[-|#]|\d\. )")


def list_units(page):
    """Return the paragraphs, entries of lists and rows of tables of a page that have a figure.

    Tables that a command writes are left out: they have a seal.
    """
    text = HIDDEN.sub("", SECTION.sub("", page.read_text(encoding="utf-8")))
    units = (" ".join(each.split()) for each in BEGINS.split(text))
    return [each for each in units if FIGURE.search(each)]


@pytest.mark.parametrize("name", PAGES)
def test_each_figure_of_a_page_has_a_command_or_a_test(name):
    begins = GIVEN[name]
    missing = [
        unit[:60] for unit in list_units(ROOT / name) if not any(each in unit for each in begins)
    ]
    assert not missing, f"name in {LIST.name} what gives these figures"


@pytest.mark.parametrize("name", PAGES)
def test_the_list_names_texts_that_stand_there(name):
    units = list_units(ROOT / name)
    assert all(sum(text in unit for unit in units) == 1 for text in GIVEN[name]), [
        text for text in GIVEN[name] if sum(text in unit for unit in units) != 1
    ]


@pytest.mark.parametrize("by", sorted({by for given in GIVEN.values() for by in given.values()}))
def test_what_gives_a_figure_exists(by):
    targets = re.findall(r"^([\w-]+):.*##", (ROOT / "workshop/Makefile").read_text(), re.M)
    targets += re.findall(r"^([\w-]+):.*##", (ROOT / "Makefile").read_text(), re.M)
    words = by.split()
    if words[0] == "make":
        assert words[-1] in targets
    elif words[0] == "python":
        module = ROOT / (words[2].replace(".", "/"))
        assert module.with_suffix(".py").is_file() or (module / "__main__.py").is_file()
    else:
        assert (ROOT / words[0]).is_file()


def test_a_figure_that_the_list_does_not_know_is_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(
        "Some text.\n\nIt takes 3 ms.\n\n- no figure\n- 5 eps at most\n\n| a | 2 rad |\n"
    )
    assert list_units(page) == ["It takes 3 ms.", "- 5 eps at most", "| a | 2 rad |"]
