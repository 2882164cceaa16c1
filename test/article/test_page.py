"""The page of the article has every claim, every figure, and links that the page takes."""

import io
import re
from urllib.parse import parse_qsl

import pytest
from documents import ROOT, rows
from page.web.opened import UNDRAWN
from shown_pictures import assert_same_picture
from trials import choose

from symtop_ros.page.web.join import write_file
from symtop_ros.physics import Motion, State, Top
from workshop.article.figures import FIGURES
from workshop.pictures.pack import pack_figure

DOCS = ROOT / "docs"
TEXT = (DOCS / "article.md").read_text(encoding="utf-8")
LINK = re.compile(r"\]\(\.\./top\.html#([^)]+)\)")
QUICK = ("euler_angles", "four_masses")


# of each passage: article, what it says, claims, figures, page
ROWS = rows(DOCS / "article.md", "Passage by passage")
LINKS = sorted({link for row in ROWS for link in LINK.findall(row[4])})


def test_every_claim_belongs_to_a_passage():
    named = set()
    for row in ROWS:
        for low, high in re.findall(r"(\d+)(?:-(\d+))?", row[2]):
            named |= set(range(int(low), int(high or low) + 1))
    assert named == set(range(1, 79))  # test_retell.py has their number


def test_every_figure_belongs_to_a_passage_and_is_in_the_page():
    named = [re.findall(r"\[`(\w+)`\]\(article/(\w+)\.png\)", row[3]) for row in ROWS]
    assert all(name == file for found in named for name, file in found)
    assert {name for found in named for name, _ in found} == set(FIGURES)
    shown = re.findall(r"^!\[.+\]\(article/(\w+)\.png\)$", TEXT, re.MULTILINE)
    assert sorted(shown) == sorted(FIGURES)
    assert {file.stem for file in (DOCS / "article").iterdir()} == set(FIGURES)


def test_every_passage_has_a_link_to_the_page():
    assert all(LINK.findall(row[4]) for row in ROWS)


@pytest.fixture(scope="module", name="tab")
def _tab(tmp_path_factory, browser):
    """The page in a browser, without a network."""
    path = tmp_path_factory.mktemp("page") / "top.html"
    path.write_text(write_file(), encoding="utf-8")
    tab = browser.new_page()
    tab.add_init_script(UNDRAWN)
    tab.goto(path.as_uri())
    tab.wait_for_selector("#headline:not(:empty)", state="attached")
    yield tab
    tab.close()


@pytest.mark.parametrize("link", LINKS)
def test_a_link_starts_its_motion_whatever_moved_before(link, tab):
    tab.evaluate("location.hash = 'scene=friction'")
    tab.wait_for_function("symtop.run().events.at(-1).friction[0] > 0")
    count = tab.evaluate("symtop.run().events.length")
    tab.evaluate("(hash) => { location.hash = hash; }", link)
    fields = dict(parse_qsl(link, strict_parsing=True))
    if "lesson" in fields:
        tab.wait_for_function("document.body.classList.contains('in-lesson')")
        chosen = tab.eval_on_selector("#steps", "list => list.selectedIndex")
        assert chosen + 1 == int(fields["lesson"])
        return
    tab.wait_for_function("(count) => symtop.run().events.length > count", arg=count)
    event = tab.evaluate("symtop.run().events.at(-1)")
    assert tab.is_hidden("#refusal")
    motion = Motion(Top(*event["top"]), State(event["orientation"], event["angular_velocity"]))
    assert "precession" not in fields or motion.kind == "regular"
    assert not any([*event["friction"], *event["torque"]])
    for name in ("phi", "psi"):
        if f"{name}_dot" in fields:
            asked = float(fields[f"{name}_dot"])
            # rates are made of an angular velocity: rounding of sums of three products
            assert getattr(motion.start.euler_rates, f"{name}_dot") == pytest.approx(
                asked, abs=1e-11
            )


@pytest.mark.parametrize("name", choose(FIGURES, QUICK))
def test_a_picture_is_what_the_command_draws(name):
    assert_same_picture(DOCS / "article" / f"{name}.png", io.BytesIO(pack_figure(FIGURES[name])))
