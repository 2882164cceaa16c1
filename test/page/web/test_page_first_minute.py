"""The first minute: a question, a push that is seen, and the answer next to what happened."""

import re

import numpy as np
import pytest
from page.web.opened import find_time, read_motion, read_state
from page.web.test_page_sizes import is_inside
from trials import choose

from symtop_ros.page.web.join import LANGUAGES
from symtop_ros.physics import Motion, hurry

PERIODS = 1.1  # of a nutation, in which all of it is seen
LINKS = ("#lesson=2", "#scene=cusps", "#theta=0.6&psi_dot=150")
PARTS = ("#question", "#picture", "#answers", "#theta svg")


@pytest.fixture
def new(open_page):
    """The page in a browser that has never opened it."""
    return open_page(known="")


def read_kick(page):
    """Return the motions before and after the push, and the time of the push."""
    start, kick = page.read_events()[-2:]
    before = read_motion(start).at(find_time(start, kick))
    motion = read_motion(kick)
    return Motion(motion.top, before), motion, kick["time"]


@pytest.mark.slow
@pytest.mark.wording
def test_a_push_is_predicted_seen_and_compared(new):
    assert new.tab.is_visible("text=Will it rise or fall?")
    assert not new.tab.is_visible("#headline")
    assert not new.tab.is_visible("#hurry")
    new.tab.click("text=It will fall")
    before, motion, time = read_kick(new)
    hurried = hurry(before.start, 1.4, "spin_momentum")
    assert motion.start.angular_velocity.tolist() == hurried.angular_velocity.tolist()
    assert not new.tab.is_visible("#compared")  # it has not been seen yet
    assert new.tab.is_visible("text=In slow motion")
    new.wait_for_time(time + motion.nutation_period / 2)
    new.tab.wait_for_selector("#compared")
    assert new.say("compared") == "You: it falls. Seen: it rose."
    assert new.tab.is_visible("#headline")
    new.tab.click("#hurry")
    assert not new.tab.is_visible("#compared")


@pytest.mark.slow
def test_an_answer_is_compared_after_a_reload_in_slow_motion(new):
    new.tab.click("text=It will fall")
    _, motion, time = read_kick(new)
    new.reload()
    assert new.tab.evaluate("document.body.dataset.asked") == "watch"
    assert not new.tab.is_visible("#compared")
    new.wait_for_time(time + motion.nutation_period / 2)
    new.tab.wait_for_selector("#compared")
    assert new.say("compared") == "You: it falls. Seen: it rose."
    assert new.tab.is_visible("#second")
    new.reload()
    new.tab.wait_for_selector("#compared")  # it is still read
    new.tab.click("#hurry")
    new.reload()
    assert not new.tab.is_visible("#compared")


@pytest.mark.slow
@pytest.mark.wording
def test_the_same_is_asked_at_the_fast_precession_and_the_same_push_lowers_it(new):
    new.tab.click("text=It will rise")
    _, motion, time = read_kick(new)
    assert not new.tab.is_visible("#second")
    new.wait_for_time(time + motion.nutation_period / 2)
    new.tab.click("text=And at the fast precession?")
    new.tab.wait_for_selector("text=Will it rise or fall?")
    assert not new.tab.is_visible("#compared")
    start = new.read_events()[-1]
    fast = read_motion(start)
    assert fast.kind == "regular"
    assert fast.mean_precession_rate == pytest.approx(69.82, abs=0.01)
    new.tab.click("text=It will fall")
    before, motion, time = read_kick(new)
    assert motion.turning_angles[1] > before.turning_angles[1] + 0.05
    assert not new.tab.is_visible("#between")
    new.wait_for_time(time + motion.nutation_period / 2)
    new.tab.wait_for_selector("#compared")
    assert new.say("compared") == "You were right: it fell."
    assert "at the slow precession these are 6.50 and 52.31 rad/s" in new.say("between")
    assert "at the fast one 4.87 and 69.82 rad/s" in new.say("between")
    assert not new.tab.is_visible("#second")
    new.tab.click("#hurry")
    assert not new.tab.is_visible("#between")


@pytest.mark.slow
@pytest.mark.wording
def test_the_second_answer_does_not_replace_the_first_one(new):
    new.tab.click("text=It will rise")
    _, motion, time = read_kick(new)
    new.wait_for_time(time + motion.nutation_period / 2)
    new.tab.click("#second")
    new.tab.click("text=It will fall")
    assert new.tab.evaluate("Object.values(localStorage).includes('rises')")


@pytest.mark.slow
def test_who_comes_again_is_not_asked(new):
    new.tab.click("text=It will rise")
    other = new.context.new_page()
    other.goto(new.tab.url)
    other.wait_for_selector("#hurry")
    assert not other.is_visible("#question")


@pytest.mark.slow
@pytest.mark.parametrize("fragment", choose(LINKS, LINKS[:1]))
def test_who_follows_a_link_is_not_asked(open_page, fragment):
    page = open_page(fragment, known="")
    page.tab.wait_for_selector("#hurry")
    assert not page.tab.is_visible("#question")


def test_a_language_in_the_address_starts_nothing_so_that_the_question_is_asked(open_page):
    page = open_page("#lang=de", known="")
    assert page.tab.is_visible("text=sinkt der Kreisel?")


SMALL = [(360, 640), (683, 384)]  # the second one: a laptop at a zoom of 200 %


@pytest.mark.slow
@pytest.mark.parametrize("size", choose(SMALL, SMALL[:1]))
@pytest.mark.parametrize("language", choose(LANGUAGES, ["fr"]))
def test_both_answers_have_one_size_and_the_second_question_is_seen(open_page, language, size):
    width, height = size
    window = {"viewport": {"width": width, "height": height}}
    page = open_page(f"#lang={language}", known="", **window)
    buttons = page.tab.locator("[data-answer]").all()
    first, second = (button.bounding_box()["height"] for button in buttons)
    assert first == second
    assert not page.tab.is_visible("#charts details:nth-of-type(4)")  # Perry's rule
    page.tab.click("[data-answer=rises]")
    _, motion, time = read_kick(page)
    page.wait_for_time(time + motion.nutation_period / 2)
    page.tab.wait_for_selector("#second")
    assert is_inside(page.tab.locator("#second").bounding_box(), size)
    assert page.tab.locator("#strip").evaluate("e => e.scrollHeight <= e.clientHeight")


@pytest.mark.wording
def test_another_act_ends_the_question(new):
    new.press("d")
    assert not new.tab.is_visible("#question")
    assert "lower than without the push" in new.say("headline")


def test_a_page_that_prefers_no_motion_moves_when_it_is_answered(open_page):
    page = open_page(known="", reduced_motion="reduce")
    page.tab.click("text=It will rise")
    page.wait_for_time(page.read_events()[-1]["time"] + 0.01)


@pytest.mark.parametrize("size", choose(((390, 844), (360, 640)), [(360, 640)]))
def test_question_scene_buttons_and_chart_are_on_the_first_screen_of_a_phone(open_page, size):
    width, height = size
    page = open_page(known="", viewport={"width": width, "height": height})
    page.tab.wait_for_selector("#theta svg")
    boxes = [page.tab.locator(name).bounding_box() for name in PARTS]
    assert all(is_inside(box, size) for box in boxes), boxes
    assert boxes[1]["height"] > 0.35 * height


@pytest.mark.slow
@pytest.mark.wording
def test_the_first_nutation_is_slow_and_the_bracket_says_by_how_much_it_is_higher(opened):
    opened.tab.select_option("#speed", "1")
    opened.tab.click("#hurry")
    opened.until(lambda: opened.say("pace") == "slow motion")
    before, motion, time = read_kick(opened)
    bracket = opened.tab.locator(".label:visible", has_text="higher")
    opened.wait_for_time(time + motion.nutation_period / 8)
    opened.tab.click("#pause")
    opened.wait_for_frames(3)
    now = float(opened.tab.get_attribute("body", "data-theta"))
    shown = float(re.match(r"rises ([\d.]+) rad higher", bracket.text_content())[1])
    digits = 10 ** (np.floor(np.log10(shown)) - 1)
    assert shown == pytest.approx(before.turning_angles[0] - now, abs=0.5001 * digits)
    assert opened.tab.locator(".label:visible", has_text="push").count() == 2  # and "not pushed"
    opened.tab.click("#pause")
    opened.wait_for_time(time + PERIODS * motion.nutation_period)
    opened.until(lambda: opened.say("pace") == "")  # the speed that was chosen
    opened.until(lambda: bracket.text_content() == "rises 0.062 rad higher")


@pytest.mark.slow
def test_a_kick_is_a_step_in_the_chart_and_a_mark_at_the_time_slider(opened):
    opened.open_charts("phi_dot")
    opened.wait_for_time(0.02)
    opened.tab.click("#hurry")
    opened.wait_for_time(0.04)
    opened.tab.click("#pause")
    opened.wait_for_frames(4)
    curve = opened.tab.locator("#phi_dot path[stroke-width='1.8']").get_attribute("d")
    points = np.array(re.findall(r"[ML]([-\d.]+) ([-\d.]+)", curve), float)
    mark = opened.tab.locator("#phi_dot path.kick").get_attribute("d")
    place = float(re.match(r"M([\d.]+)", mark)[1])
    jump = np.flatnonzero(points[:, 0] == place)
    assert np.ptp(points[jump, 1]) > 0.8 * np.ptp(points[:, 1])
    assert np.ptp(points[points[:, 0] < place, 1]) < 0.2  # tenths: nothing begins before the kick
    _, kick = opened.read_events()
    end = float(opened.tab.get_attribute("#timeline", "max"))
    places = opened.tab.locator("#marks i").evaluate_all("all => all.map(e => e.style.left)")
    expected = pytest.approx([0.0, 100 * kick["time"] / end], abs=0.006)
    assert [float(place[:-1]) for place in places] == expected
    assert opened.tab.text_content("#clock") == f"{end:.2f} s"


@pytest.mark.wording
def test_numbers_are_in_degrees_at_first_and_in_rad_in_the_lesson(new):
    new.tab.click("text=It will rise")
    assert "°" in new.say("headline")
    new.open_tab("lesson")
    new.tab.locator("#lesson-acts button").first.click()
    assert "rad" in new.say("headline")
    assert read_state(new.read_events()[-1]).euler_angles.theta == pytest.approx(0.5)
