"""The page of the article names every claim, every figure and only scenes that there are."""

import re
from pathlib import Path

import pytest

from symtop_ros.article.figures import FIGURES
from symtop_ros.article.retell import check_claims
from symtop_ros.simulation.presets import scene_names

TEXT = (Path(__file__).parents[2] / "docs/article.md").read_text()


@pytest.fixture(scope="module")
def rows():
    table = TEXT[TEXT.index("## Passage by passage") : TEXT.index("[The lesson](lesson.md)")]
    return [row.split("|")[1:-1] for row in table.splitlines() if row.startswith("| ")][1:]


def test_every_claim_belongs_to_a_passage(rows):
    named = set()
    for row in rows:
        for low, high in re.findall(r"(\d+)(?:-(\d+))?", row[2]):
            named |= set(range(int(low), int(high or low) + 1))
    assert named == set(range(1, len(check_claims()) + 1))


def test_every_figure_belongs_to_a_passage(rows):
    assert {name for row in rows for name in re.findall(r"`(\w+)`", row[3])} == set(FIGURES)


def test_every_scene_of_a_passage_exists(rows):
    assert {name for row in rows for name in re.findall(r"`(\w+)`", row[4])} <= set(scene_names())
