"""The opening of a first visit: gravity's torque turns L sideways, and nothing waits for it."""

import numpy as np
import pytest
from page.web.test_page_sizes import is_inside
from page.web.test_present import draw_instants
from trials import choose

from symtop_ros.page.web.join import LANGUAGES
from symtop_ros.physics import ExactTimes, Motion, State, Top

END = 0.105  # s of the run
ARROWS = ["L", "torque", "change of L in 0.04 s", "gravity"]
# Of L, of which the change is a fourth or less: L is a sum of three products of doubles.
ROUNDING = 1e-12


@pytest.fixture
def new(open_page):
    """The page in a browser that has never opened it."""
    return open_page(known="")


def list_labels(page):
    page.wait_for_frames()
    texts = page.tab.locator(".label:visible")
    return texts.evaluate_all("all => all.map(e => e.dataset.text)")


def read_stage(page):
    return page.tab.evaluate("document.body.dataset.opening ?? ''")


@pytest.mark.wording
def test_a_first_visit_says_why_it_does_not_fall_and_asks_at_once(new):
    assert new.tab.is_visible("text=Why does this top not fall?")
    assert new.tab.is_visible("text=Will it rise or fall?")
    assert sorted(list_labels(new)) == sorted(ARROWS)
    new.tab.click("[data-answer=falls]")
    assert [each["kind"] for each in new.read_events()][-1] == "kick"
    assert not new.tab.is_visible("text=Why does this top not fall?")
    assert not set(list_labels(new)) & {*ARROWS, "along its precession"}


@pytest.mark.slow
def test_the_arrows_of_the_opening_give_way_to_that_of_the_question(new):
    new.wait_for_time(END)
    new.until(lambda: read_stage(new) == "read")
    assert list_labels(new) == ["along its precession"]
    assert new.tab.is_visible("text=Why does this top not fall?")
    assert not new.tab.is_visible("#skip")
    before = new.read_run()["end"]
    new.wait_for_time(before + 0.05)  # at the usual speed
    new.tab.click("[data-answer=falls]")
    assert "along its precession" not in list_labels(new)


@pytest.mark.parametrize("way", ["button", "key"])
def test_the_opening_can_be_skipped(new, way):
    if way == "button":
        new.tab.click("#skip")
    else:
        new.press("Escape")
    assert list_labels(new) == ["along its precession"]
    assert new.tab.is_visible("#question")


@pytest.mark.slow
def test_the_opening_is_not_shown_again(new):
    other = new.context.new_page()
    other.goto(new.tab.url)
    other.wait_for_selector("text=goes round steadily")  # it has not been answered
    assert not other.is_visible("#skip")
    assert not other.is_visible("text=Why does this top not fall?")


@pytest.mark.slow
def test_without_motion_all_arrows_stand_still_together(open_page):
    page = open_page(known="", reduced_motion="reduce")
    assert sorted(list_labels(page)) == sorted([*ARROWS, "along its precession"])
    places = page.read_labels()
    page.wait_for_texts()
    assert page.read_labels() == places
    page.tab.click("#skip")
    assert list_labels(page) == ["along its precession"]


def test_a_word_that_is_pointed_at_takes_no_arrow_of_the_opening_away(new):
    new.tab.hover("#question .word[data-layer=torque]")
    new.tab.mouse.move(0, 0)
    assert "torque" in list_labels(new)


@pytest.mark.slow
@pytest.mark.parametrize(
    "size", choose([(1280, 720), (390, 844), (360, 640), (683, 384)], [(360, 640)])
)
@pytest.mark.parametrize("language", choose(LANGUAGES, ["de"]))
def test_sentence_question_and_labels_are_inside(open_page, language, size):
    width, height = size
    window = {"viewport": {"width": width, "height": height}, "reduced_motion": "reduce"}
    page = open_page(f"#lang={language}", known="", **window)
    page.wait_for_frames()
    scene = page.tab.locator("#scene").bounding_box()
    for name in ("#question", "#skip"):
        assert is_inside(page.tab.locator(name).bounding_box(), size), name
    assert page.tab.locator("#strip").evaluate("e => e.scrollHeight <= e.clientHeight")
    boxes = [each.bounding_box() for each in page.tab.locator(".label:visible").all()]
    assert len(boxes) == len(ARROWS) + 1
    for box in boxes:
        assert box["x"] >= scene["x"] - 0.5
        assert box["x"] + box["width"] <= scene["x"] + scene["width"] + 0.5
        assert box["y"] >= scene["y"] - 0.5
        assert box["y"] + box["height"] <= scene["y"] + scene["height"] + 0.5


def test_the_change_of_l_is_that_of_the_motion_and_sideways(tab):
    acting = {"friction": [0, 0], "torque": [0, 0, 0], "clamped": False}
    cases = [each | acting for each in draw_instants(60)]
    for case, found in zip(cases, tab.evaluate("findChanges", cases), strict=True):
        top = Top(**case["top"])
        start = State(np.array(case["orientation"]), np.array(case["omega"]))
        motion = Motion(top, start)
        later = motion.at(ExactTimes(round(found["span"])))
        before, after = top.angular_momentum(start), top.angular_momentum(later)
        largest = np.linalg.norm(before)
        size = np.linalg.norm(after - before)
        np.testing.assert_allclose(found["change"], after - before, rtol=0, atol=ROUNDING * largest)
        assert abs(found["change"][2]) <= ROUNDING * largest  # gravity has no torque about z
        assert size <= 0.25 * 1.5 * largest  # one digit of the span rounds it by a half at most
        velocity = np.cross(start.to_world(start.angular_velocity), start.to_world((0, 0, 1)))
        np.testing.assert_allclose(
            found["way"], velocity / np.linalg.norm(velocity), rtol=0, atol=1e-9
        )
