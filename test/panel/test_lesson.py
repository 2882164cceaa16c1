"""The lesson on the page: a class presses through all steps in a real browser, without ROS."""

import time

import pytest
from browser import running_browser
from playwright.sync_api import expect

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.web.lesson import read_lesson
from symtop_ros.web.scene import HIDDEN_LAYERS

TIMEOUT = 60.0  # s; ends a test that hangs, and is never waited for
SECRET = "it falls, I think"
STEPS = read_lesson()
# Of each button in turn: the turning angles in rad to three digits.
ANGLES = (
    ((0.5, 0.664),),
    ((0.5, 0.664),),
    ((0.5, 0.907), (0.5, 0.559), (0.5, 0.664)),
    ((0.5, 0.5),),
    ((0.5, 0.5),),
    ((0.439, 0.5), (0.384, 0.5), (0.194, 0.5)),
    ((0.5, 0.587), (0.439, 0.5)),
    ((0.5, 0.5), (0.437, 0.5), (0.5, 0.5), (0.438, 0.5)),
    ((0.5, 0.5), (0.5, 0.713)),
    ((0.5, 0.5), (0.439, 0.5), (0.5, 0.5), (0.5, 0.528)),
    ((0.5, 0.5), (0.5, 0.544), (0.5, 0.5), (0.362, 0.5), (0.5, 0.5), (0.5, 0.8)),
)


@pytest.fixture(scope="module", name="browser")
def _browser():
    with running_browser() as browser:
        yield browser


@pytest.fixture(name="page")
def _page():
    page = Page(LocalTop("friction", factor=0.1), LOCAL_HOST, 0)
    yield page
    page.close()


def opened(browser, page, query="/#lesson", size=(1280, 720)):
    """The lesson in a window, without its scene, and the texts that it sends."""
    width, height = size
    tab = browser.new_page(viewport={"width": width, "height": height})
    tab.set_default_timeout(TIMEOUT * 1000)
    sent = []

    def note(text):
        sent.append(text)

    tab.on("websocket", lambda socket: socket.on("framesent", note))
    tab.on("request", lambda request: sent.append(f"{request.url} {request.post_data}"))
    tab.route("**/scene?*", lambda route: route.fulfill(body="<!doctype html><title>scene</title>"))
    tab.goto(page.server.url + query)
    tab.locator("#lesson-predict:not(:empty)").wait_for()
    return tab, sent


def until(tab, condition):
    deadline = time.monotonic() + TIMEOUT
    while not condition():
        assert time.monotonic() < deadline
        tab.wait_for_timeout(20)


def hidden_layers(tab):
    """For each layer that is hidden at first: is it, and what the legend says of it?"""
    boxes = [tab.get_by_label(layer, exact=True) for layer in HIDDEN_LAYERS]
    hidden = [not box.is_checked() for box in boxes]
    for layer, is_hidden in zip(HIDDEN_LAYERS, hidden, strict=True):
        for entry in tab.locator(f"#legend [data-layer='{layer}']").all():
            assert entry.is_visible() is not is_hidden
    return hidden


def angles(page):
    return page.run.motion.turning_angles


def is_new(moment, seen, name):
    """Return True for a moment after the one that was seen, with an event of this name."""
    return moment is not seen and moment.event.name == name


def test_a_class_presses_through_all_steps(browser, page):
    tab, sent = opened(browser, page)
    for number, (step, expected) in enumerate(zip(STEPS, ANGLES, strict=True), start=1):
        expect(tab.locator("#steps option:checked")).to_have_text(f"{number}. {step.title}")
        expect(tab.locator("#lesson-predict")).to_have_text(step.predict)
        until(tab, lambda: not page.run.segment.running)  # nothing moves before the prediction
        tab.get_by_label("Your prediction").fill(f"{SECRET} {number}")
        assert not tab.locator("#lesson-seen").is_visible()
        assert not tab.locator("#lesson-answer").is_visible()
        for act, turning in zip(step.acts, expected, strict=True):
            seen = page.run.announced
            tab.get_by_role("button", name=act.button, exact=True).click()
            name = "start" if act.start else "kick"
            until(tab, lambda seen=seen, name=name: is_new(page.run.announced, seen, name))
            until(tab, lambda: page.run.segment.running)
            # half of the last of three digits
            assert angles(page) == pytest.approx(turning, abs=5e-4)
            assert not page.run.motion.is_driven  # the friction of the first scene is gone
            if act.hurry:
                assert tab.get_by_role("button", name=act.button, exact=True).is_disabled()
        assert hidden_layers(tab) == [layer not in step.layers for layer in HIDDEN_LAYERS]
        looked = tab.locator(".looked")
        assert sorted(looked.evaluate_all("all => all.map(e => e.dataset.chart)")) == sorted(
            step.charts
        )
        for chart in looked.all():
            assert 0 <= chart.bounding_box()["y"] < 720 / 2
        for summary, text in (("What happens", "#lesson-seen"), ("Answer", "#lesson-answer")):
            tab.get_by_text(summary, exact=True).click()
            assert tab.locator(text).is_visible()
        if number < len(STEPS):
            tab.get_by_role("button", name="Next step").click()
    assert tab.get_by_role("button", name="Next step").is_disabled()
    tab.reload()
    expect(tab.get_by_label("Your prediction")).to_have_value(f"{SECRET} {len(STEPS)}")
    tab.get_by_role("button", name="Back").click()
    expect(tab.get_by_label("Your prediction")).to_have_value(f"{SECRET} {len(STEPS) - 1}")
    assert any("link" in str(text) for text in sent)
    assert [text for text in sent if SECRET[:8] in str(text)] == []  # it stays in the browser
    tab.close()


def test_a_keyboard_does_a_step(browser, page):
    tab, _ = opened(browser, page, "/#lesson=8", size=(390, 844))
    until(tab, lambda: not page.run.segment.running)
    tab.locator("#steps").focus()
    tab.keyboard.press("Tab")
    tab.keyboard.type("h s r ")  # letters of the prediction are no commands
    assert tab.get_by_label("Your prediction").input_value() == "h s r "
    assert not page.run.segment.running
    tab.keyboard.press("Tab")
    tab.keyboard.press("Enter")
    until(tab, lambda: page.run.segment.running)
    tab.get_by_role("button", name="Hurry it by 1.4").wait_for()
    tab.keyboard.press("Tab")
    tab.keyboard.press("Enter")
    until(tab, lambda: angles(page)[0] == pytest.approx(0.437, abs=5e-4))
    tab.locator("#step-next").focus()
    tab.keyboard.press("Space")
    expect(tab.locator("#steps")).to_be_focused()
    expect(tab.locator("#lesson-predict")).to_have_text(STEPS[8].predict)
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390
    tab.close()


def test_the_tab_opens_the_lesson_at_its_first_step(browser, page):
    tab = browser.new_page()
    tab.goto(page.server.url)
    tab.wait_for_selector("#headline:not(:empty)")
    tab.get_by_role("tab", name="Lesson").click()
    expect(tab.locator("#lesson-predict")).to_have_text(STEPS[0].predict)
    assert tab.locator(".looked").count() == len(STEPS[0].charts)
    until(tab, lambda: not page.run.segment.running)
    tab.close()
