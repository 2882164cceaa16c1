"""The page of the article has every claim, every figure, and links that the page takes."""

import io
import re
from pathlib import Path
from urllib.parse import parse_qsl, urlsplit

import numpy as np
import pytest
from PIL import Image

from symtop_ros.panel.actions import Actions
from symtop_ros.panel.main import _parser
from symtop_ros.panel.source import LocalTop
from symtop_ros.web.lesson import read_lesson
from symtop_ros.web.run import Run
from workshop.article.figures import FIGURES
from workshop.article.retell import check_claims
from workshop.pictures.pack import pack_figure

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "article.md").read_text(encoding="utf-8")
LINK = re.compile(r"\]\((http[^)]+)\)")
QUICK = ("euler_angles", "four_masses")


def list_rows():
    """The cells of each passage: article, what it says, claims, figures, page."""
    table = TEXT[TEXT.index("## Passage by passage") : TEXT.index("[The lesson](lesson.md)")]
    return [row.split("|")[1:-1] for row in table.splitlines() if row.startswith("| ")][1:]


ROWS = list_rows()
LINKS = sorted({link for row in ROWS for link in LINK.findall(row[4])})


def test_every_claim_belongs_to_a_passage():
    named = set()
    for row in ROWS:
        for low, high in re.findall(r"(\d+)(?:-(\d+))?", row[2]):
            named |= set(range(int(low), int(high or low) + 1))
    assert named == set(range(1, len(check_claims()) + 1))


def test_every_figure_belongs_to_a_passage_and_is_in_the_page():
    named = [re.findall(r"\[`(\w+)`\]\(article/(\w+)\.png\)", row[3]) for row in ROWS]
    assert all(name == file for found in named for name, file in found)
    assert {name for found in named for name, _ in found} == set(FIGURES)
    assert sorted(re.findall(r"^!\[.+\]\(article/(\w+)\.png\)$", TEXT, re.MULTILINE)) == sorted(
        FIGURES
    )
    assert {file.stem for file in (DOCS / "article").iterdir()} == set(FIGURES)


def test_every_passage_has_a_link_to_the_page():
    assert all(LINK.findall(row[4]) for row in ROWS)
    address = f"http://127.0.0.1:{_parser().parse_args([]).port}/"  # where `top_panel` listens
    assert {link.partition("#")[0] for link in LINKS} == {address}


@pytest.fixture(scope="module", name="top")
def _top():
    top = LocalTop("cusps", factor=0.1)
    yield top
    top.close()


@pytest.mark.parametrize("link", LINKS)
def test_a_link_starts_its_motion_whatever_moved_before(link, top):
    fields = dict(parse_qsl(urlsplit(link).fragment, strict_parsing=True))
    step = fields.pop("lesson", None)
    if step is not None:
        assert 1 <= int(step) <= len(read_lesson())
        return
    run = Run()
    actions = Actions(top, run)
    actions.choose_scene("friction")
    actions.follow_link(fields)
    run.follow(top.batch())
    motion = run.motion
    assert not motion.is_driven
    assert "precession" not in fields or motion.kind == "regular"
    for name in ("phi", "psi"):
        if f"{name}_dot" in fields:
            asked = float(fields[f"{name}_dot"])
            # rates are made of an angular velocity: rounding of sums of three products
            assert getattr(motion.start.euler_rates, name) == pytest.approx(asked, abs=1e-11)


@pytest.mark.parametrize(
    "name",
    [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in FIGURES],
)
def test_a_picture_is_what_the_command_draws(name):
    pictures = []
    for file in (DOCS / "article" / f"{name}.png", io.BytesIO(pack_figure(FIGURES[name]))):
        with Image.open(file) as picture:
            pictures.append(np.asarray(picture.convert("L"), dtype=float))
    assert pictures[0].shape == pictures[1].shape
    # versions of Matplotlib smooth the edges of letters differently
    assert np.abs(pictures[0] - pictures[1]).mean() < 2.0
