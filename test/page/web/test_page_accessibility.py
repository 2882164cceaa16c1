"""The page for people on phones, with zoom, with a keyboard or a screen reader, in the dark."""

from itertools import combinations

import numpy as np
import pytest
from colours import perceive

CONTRAST = {"runOnly": ["color-contrast"]}
TABS = ("push", "history", "view", "measure", "save", "lesson")  # the first one is open


def check(axe, page, options=None, parts=None):
    # what passes is not described, which takes half of the time
    wanted = {"resultTypes": ["violations"], **(options or {})}
    found = axe.run(page.tab, parts, wanted).response["violations"]
    assert [(each["id"], [n["html"][:120] for n in each["nodes"]]) for each in found] == []


# The dark page has the elements of the light one, in other colours.
@pytest.mark.slow
@pytest.mark.parametrize(("scheme", "options"), [("light", None), ("dark", CONTRAST)])
def test_there_is_no_finding_of_axe(open_page, scheme, options):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    page = open_page(color_scheme=scheme)
    page.tab.click("#hurry")
    page.open_charts()
    page.tab.click("#reason summary")
    page.enter("theta", "9")
    check(axe, page, options)
    for name in TABS:
        page.open_tab(name)
        check(axe, page, options, {"include": [["#tabs"], [f"#{name}"]]})


@pytest.mark.slow
def test_there_is_no_finding_of_axe_in_the_first_minute(open_page):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    page = open_page(known="")
    check(axe, page)
    page.tab.click("text=It will rise")
    check(axe, page)
    page.tab.wait_for_selector("#compared")
    check(axe, page, parts={"include": [["#compared"], ["#headline"]]})


def test_a_page_that_prefers_no_motion_begins_at_rest(open_page):
    page = open_page(reduced_motion="reduce")
    assert page.say("pause") == "Run"
    page.tab.click("#pause")
    page.wait_for_time(0)


def test_a_keyboard_reaches_the_tabs_and_gives_no_key_away_with_caps_lock_either(opened):
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
    opened.tab.keyboard.press("H")
    assert "higher" in opened.say("headline")


@pytest.mark.parametrize("key", ["Space", "Enter"])
def test_a_key_holds_a_button_as_a_pointer_does(opened, key):
    opened.open_tab("push")
    opened.tab.focus("[data-hold=grasp]")
    opened.tab.keyboard.down(key)
    assert [each["kind"] for each in opened.read_events()] == ["start", "clamp"]
    opened.tab.keyboard.up(key)
    assert [each["kind"] for each in opened.read_events()] == ["start", "clamp", "unclamp"]


def test_escape_puts_a_refusal_away_and_then_closes_the_panel(opened):
    opened.enter("theta", "9")
    opened.tab.focus("#scenes")
    opened.tab.keyboard.press("Escape")
    assert not opened.tab.is_visible("#refusal")
    assert opened.tab.is_visible("#start")
    opened.tab.keyboard.press("Escape")
    assert not opened.tab.is_visible("#start")
    assert opened.tab.evaluate("document.activeElement.id") == "tab-start"


def test_escape_in_a_field_takes_back_what_was_typed_and_closes_nothing(opened):
    opened.open_tab("start")
    opened.tab.fill("#field-theta", "9")
    opened.tab.press("#field-theta", "Escape")
    assert opened.tab.is_visible("#start")


def test_the_focus_is_on_what_is_said_when_a_key_has_answered(open_page):
    page = open_page(known="")
    page.tab.focus("[data-answer=falls]")
    page.tab.keyboard.press("Enter")
    assert page.tab.evaluate("document.activeElement.id") == "strip"


@pytest.mark.parametrize("name", ["measure", "push"])
def test_a_panel_of_a_phone_opens_at_its_beginning(open_page, name):
    page = open_page(viewport={"width": 390, "height": 844})
    page.open_charts()
    page.tab.evaluate("() => { document.querySelector('#rest').scrollTop = 1e4; }")
    page.open_tab(name)
    assert page.tab.evaluate("document.querySelector('#rest').scrollTop") == 0


@pytest.mark.parametrize(("key", "steps"), [("ArrowLeft", -1), ("ArrowUp", 1), ("PageDown", -10)])
def test_keys_move_the_sliders_of_a_run_and_a_chart_by_hundredths(opened, key, steps):
    opened.wait_for_time(0.1)
    opened.press("Space")
    opened.open_charts("free")
    opened.seek(0.05)
    opened.tab.evaluate("acts.change", ["free-place", 0.5])
    opened.wait_for_frames()
    for name in ("timeline", "free-place"):
        slider = opened.tab.locator(f"#{name}")
        opened.tab.focus(f"#{name}")
        before, end = slider.evaluate("each => [Number(each.value), Number(each.max)]")
        opened.tab.keyboard.press(key)
        after = slider.evaluate("each => Number(each.value)")
        assert (after - before) / end == pytest.approx(steps / 100, abs=1e-6)  # ns of a run


def test_symbols_are_formulas_and_explained_at_their_first_place(opened):
    opened.tab.click("#hurry")
    opened.tab.click("#reason summary")
    assert "theta''" in opened.say("why")
    assert opened.tab.locator("#why math mover").count() >= 2
    opened.open_tab("start")
    label = opened.tab.locator("label[for=field-phi_dot]")
    assert label.text_content() == "precession rate φ˙ (rad/s)"
    spoken = opened.tab.get_by_label("precession rate phi dot (rad/s)")
    assert spoken.count() == 2  # and its slider
    shown = opened.tab.inner_text("#start")
    for explained in ("weight times the distance of the centre of mass", "slow root"):
        assert explained in shown
    opened.open_tab("lesson")
    assert "'" not in opened.tab.inner_text("#charts h2 >> nth=0").replace("Perry's", "")


def read_marks(page):
    """Colours of the marks in the tab View, by the name of their layer."""
    page.open_tab("view")
    found = page.tab.locator("#layers label").evaluate_all(
        """all => all.map(label => [label.textContent.trim(), [...label.querySelectorAll("i")]
            .map(e => getComputedStyle(e).backgroundColor.match(/\\d+/g).map(Number))])"""
    )
    return {name: colors for name, colors in found if colors}


def test_arrows_come_one_by_one_by_their_words(opened):
    opened.press("Space")
    label = opened.tab.locator(".label:visible", has_text="torque")
    word = opened.tab.locator("#legend .word[data-layer=torque]")
    assert label.count() == 0
    word.hover()
    label.wait_for()
    opened.tab.mouse.move(5, 5)
    label.wait_for(state="detached")
    word.click()
    opened.tab.mouse.move(5, 5)
    opened.wait_for_frames()
    assert label.count() == 1
    assert word.get_attribute("aria-pressed") == "true"
    opened.open_tab("view")
    assert opened.tab.get_by_label("torque", exact=True).is_checked()


@pytest.mark.wording
def test_a_word_of_the_reason_has_the_colour_of_its_arrow_and_shows_it(opened):
    opened.tab.click("#hurry")
    opened.tab.click("#reason summary")
    word = opened.tab.locator("#because .word[data-layer=L]")
    legend = opened.tab.locator("#legend .word[data-layer=L]")
    read = "e => getComputedStyle(e).color"
    assert word.evaluate(read) == legend.evaluate(read)
    word.focus()
    opened.tab.locator(".label:visible", has_text="L").wait_for()


def test_the_arrows_are_of_different_colours_without_seeing_green_and_when_forced(opened):
    marks = read_marks(opened)
    arrows = [color for name in ("L", "ω", "torque", "trace") for color in marks[name]]
    torques = marks["fictitious torques"]
    assert len(arrows) == len(torques) == 4
    over = [marks["trace"][0], marks["measured points"][0]]
    for group in (arrows, torques, over, [marks["torque"][0], torques[0]]):
        pairs = combinations([perceive(color, "deuteranopia") for color in group], 2)
        assert min(np.linalg.norm(a - b) for a, b in pairs) > 35  # 2.3 can just be seen
    opened.tab.emulate_media(forced_colors="active")
    forced = [tuple(each) for colors in read_marks(opened).values() for each in colors]
    assert len(set(forced)) == len(forced) == 13
