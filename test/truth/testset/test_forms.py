"""Forms of a body: each is in the set and in the README, and says one thing in other words."""

import re

import pytest
from documents import ROOT

from symtop_ros.run.models import FORMATS, name_file
from symtop_ros.truth.testset import forms, score

README = (ROOT / "symtop_ros/truth/testset/README.md").read_text()


@pytest.mark.slow
def test_each_form_has_a_file_and_a_name_for_the_scorer(folder):
    assert {name for name, _ in forms.FORMS} == {*score.FORMS}
    for name, form in forms.FORMS:
        assert (folder / "models" / name_file(f"{score.FORMED}.{name}", form)).exists()
        assert score.find_problem(score.read_problems(), f"{score.FORMED}.{name}")


def test_another_problem_has_no_forms():
    with pytest.raises(ValueError, match=r"description must be one of turned, .*, got euler"):
        score.find_problem(score.read_problems(), "looping.euler")


def test_the_table_of_the_readme_has_exactly_the_forms_that_there_are():
    _, _, section = README.partition("\n## Forms\n")
    head, _, *rows = re.findall(r"^\|.*\|$", section.partition("\n## ")[0], re.MULTILINE)
    columns = [each.strip().lower() for each in head.strip("|").split("|")][1:]
    assert columns == ["mjcf", "sdf", "urdf", "usd"]
    assert {*columns} == {*FORMATS}
    found = {
        (name, form)
        for name, *cells in ([each.strip() for each in row.strip("|").split("|")] for row in rows)
        for form, cell in zip(columns, cells, strict=True)
        if cell
    }
    assert found == {(f"`.{name}`", form) for name, form in forms.FORMS}


def test_a_part_that_is_not_there_once_is_no_place_for_an_edit():
    for text in ("b", "aab"):
        with pytest.raises(ValueError, match="a model must have a once, got "):
            forms.change(text, {"a": "c"})
    assert forms.change("ab", {"a": "c"}) == "cb"
