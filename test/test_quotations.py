"""Quotations of documents and the lesson stand so in their sources, which are listed."""

import json
import re

import pytest
from documents import ROOT

# The sentences as they stand in what was read: the article's text, and Perry's lecture (1910).
ARTICLE = (
    "Why do we use constants of motion while studying the motion of a heavy symmetric top?",
    "Hurry on the precession, and the body rises in opposition to gravity",
    "more than one rate of change of angular momentum being equal to the same torque",
    "since there are angular accelerations",
    "in the beginning, torque causes a change both in the magnitude and direction",
    "otherwise the top slides",
)
PERRY = (
    "If I clamp this vertical axis so that precession is impossible, you will notice that the "
    "gyrostat falls just as if it were not spinning",
    "moves in opposition to the force which causes the precession",
    "in opposition to gravity",
)
TITLES = ("Precession and nutation of a gyroscope", "Operatives' Lecture")
MISCONCEPTIONS = (  # of students: nobody's words
    "a spinning top does not fall",
    "what is perpendicular to a torque is constant",
    "one torque makes one motion",
    "equal accelerations are equal motions",
    "the push lifts the top",
    "a centrifugal force lifts it",
    "who measures the motion knows the spin",
)
KNOWN = {*ARTICLE, *PERRY, *TITLES, *MISCONCEPTIONS}
PAGES = ("article", "derivation", "lesson", "library", "ros", "ros_reference")
RULE = ARTICLE[1]
FEWEST = 4  # words: less is a label
TEXTS = sorted((ROOT / "symtop_ros/page/web/texts").glob("*.json"))


def list_quotations(page):
    """The words between quotation marks in the prose of a page."""
    text = (ROOT / f"docs/{page}.md").read_text()
    prose = re.sub(r"^```.*?^```$|`[^`\n]*`", "", text, flags=re.M | re.S)
    for paragraph in prose.split("\n\n"):
        words = " ".join(paragraph.split())
        yield from (found.rstrip(".,") for found in re.findall(r'"([^"]+)"', words))


@pytest.mark.parametrize("page", PAGES)
def test_every_quotation_of_a_page_is_one_of_the_list(page):
    quoted = {each for each in list_quotations(page) if len(each.split()) >= FEWEST}
    assert quoted <= KNOWN


def test_every_quotation_of_the_list_is_on_a_page():
    quoted = {each for page in PAGES for each in list_quotations(page)}
    assert {*ARTICLE, *PERRY} <= quoted


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: path.stem)
def test_the_lesson_quotes_the_rule_and_says_whose_it_is_in_each_language(path):
    seen = json.loads(path.read_text())["lesson.hurry.seen"]
    assert RULE in seen
    assert all(name in seen for name in ("Thomson", "John Perry", "1890"))


def test_cited_sources_are_in_both_lists_of_references():
    references = (ROOT / "docs/article.md").read_text().partition("\n## References\n")[2]
    listed = (ROOT / "CITATION.cff").read_text()
    for name, title in (
        ("Tanr\u0131verdi", "Why do we use constants of motion"),
        ("Perry", "Spinning Tops"),
        ("Butikov", "Precession and nutation of a gyroscope"),
    ):
        assert re.search(rf"{name}, \*{title}", " ".join(references.split()))
        assert name in listed
        assert title in listed
