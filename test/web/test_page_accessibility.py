"""The page for people on phones, with zoom, with a keyboard or a screen reader, in the dark."""

import re
from itertools import combinations

import numpy as np
import pytest
from colours import perceive

TABS = ("start", "push", "history", "view", "save", "lesson")


def check(axe, page, options=None):
    found = axe.run(page.tab, options=options).response["violations"]
    assert [(each["id"], [n["html"][:120] for n in each["nodes"]]) for each in found] == []


# The dark page has the elements of the light one, in other colours.
@pytest.mark.parametrize(
    ("scheme", "options"), [("light", None), ("dark", {"runOnly": ["color-contrast"]})]
)
def test_there_is_no_finding_of_axe(open_page, scheme, options):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    page = open_page(color_scheme=scheme)
    page.tab.click("#hurry")
    page.tab.click("summary")
    for name in TABS:
        page.open_tab(name)
        check(axe, page, options)
    page.enter("theta", "9")
    check(axe, page, options)


def test_a_page_that_prefers_no_motion_begins_at_rest(open_page):
    page = open_page(reduced_motion="reduce")
    assert page.say("pause") == "Run"
    page.tab.click("#pause")
    page.wait_for_time(0)


def test_a_keyboard_reaches_the_tabs_and_gives_no_key_away(opened):
    opened.tab.focus("#tab-start")
    opened.tab.keyboard.press("ArrowRight")
    assert opened.tab.is_visible("#push")
    opened.tab.keyboard.press("ArrowLeft")
    assert opened.tab.is_visible("#start")
    opened.tab.focus("text=Reset")
    opened.tab.keyboard.press("Space")  # presses the button that has the focus
    assert opened.say("pause") == "Pause"
    assert len(opened.read_events()) == 2
    opened.press("Space")
    assert opened.say("pause") == "Run"


def test_symbols_are_formulas_and_explained_at_their_first_place(opened):
    opened.tab.click("#hurry")
    opened.tab.click("summary")
    assert "theta''" in opened.say("why")
    assert opened.tab.locator("#why math mover").count() >= 2
    label = opened.tab.locator("label[for=field-phi_dot]")
    assert label.text_content() == "precession rate φ. (rad/s)"
    assert opened.tab.get_by_label("precession rate phi' (rad/s)").count() == 2  # and its slider
    shown = opened.tab.inner_text("#start")
    for explained in ("weight times the distance of the centre of mass", "slow root"):
        assert explained in shown
    opened.open_tab("lesson")
    assert "'" not in opened.tab.inner_text("#charts h2 >> nth=0").replace("Perry's", "")


def test_forced_colours_keep_the_marks_of_the_legend(open_page):
    page = open_page(forced_colors="active")
    marks = page.tab.locator("#legend li:visible i")
    colors = marks.evaluate_all("all => all.map(e => getComputedStyle(e).backgroundColor)")
    assert len(set(colors)) == len(colors) == 7


def test_the_legend_has_what_is_drawn(opened):
    def read():
        return opened.tab.locator("#legend li:visible").all_inner_texts()

    before = read()
    opened.open_tab("view")
    for name in ("torque", "ghost"):
        opened.tab.get_by_label(name, exact=True).uncheck()
    assert [each for each in before if each not in read()] == ["torque", "pale: ghost, not kicked"]
    opened.tab.get_by_label("fictitious torques").check()
    assert "Coriolis" in read()


def test_the_arrows_are_of_different_colours_without_seeing_green(opened):
    opened.open_tab("view")
    opened.tab.get_by_label("fictitious torques").check()
    entries = opened.tab.locator("#legend li:visible").evaluate_all(
        """all => all.map(e => [
            e.textContent, getComputedStyle(e.firstChild).backgroundColor.match(/\\d+/g).map(Number)
        ])"""
    )
    colors = {re.match(r"\w+", text)[0]: color for text, color in entries}
    for group in (("L", "ω", "torque", "trace"), ("gravity", "Coriolis", "centrifugal", "sum")):
        pairs = combinations([perceive(colors[name], "deuteranopia") for name in group], 2)
        assert min(np.linalg.norm(a - b) for a, b in pairs) > 35  # 2.3 can just be seen
