"""The picture is lost and comes back; texts are those of now, in sight or not."""

import base64
import re

import pytest
from page.web.opened import FEW_FRAMES, UNDRAWN, read_motion

# Pictures that were begun, and rests of 500 ms before the next one.
NOTED = """
window.noted = [];
WebGL2RenderingContext.prototype.clear = () => window.noted.push("picture");
const setTimer = window.setTimeout.bind(window);
window.setTimeout = (act, time, ...given) => {
  if (time === 500) window.noted.push("rest");
  return setTimer(act, time, ...given);
};
"""


@pytest.mark.slow
def test_a_paused_page_that_nobody_touches_is_drawn_rarely(open_page):
    opened = open_page(script=UNDRAWN + NOTED)

    def read_last(count):
        return opened.tab.evaluate(f"noted.slice(-{count})")

    opened.press("Space")
    opened.until(lambda: read_last(4) == ["rest", "picture"] * 2)

    def is_awake():
        opened.press("h")  # again and again: a frame may come later than the page waits for it
        return read_last(2) == ["picture"] * 2

    opened.until(is_awake)


@pytest.mark.slow
def test_a_lost_picture_is_said_and_comes_back(open_page):
    opened = open_page(script=FEW_FRAMES)
    opened.show_arrows("torque", "L")
    labels = opened.tab.locator(".label:visible")
    opened.until(lambda: labels.count() > 1 and opened.tab.evaluate("looks.countColors") > 50)
    opened.tab.evaluate("acts.losePicture")
    opened.until(lambda: opened.tab.is_visible("#picture-lost"))
    assert opened.say("picture-lost").startswith("the picture is lost")
    opened.until(lambda: labels.count() == 0)
    opened.press("h")
    assert "higher" in opened.say("headline")
    opened.tab.evaluate("window.lost.restoreContext()")
    opened.until(lambda: not opened.tab.is_visible("#picture-lost"))
    opened.until(lambda: labels.count() > 1 and opened.tab.evaluate("looks.countColors") > 50)


def test_texts_out_of_sight_are_those_of_now_and_a_printer_gets_the_charts_of_now(opened):
    opened.tab.set_viewport_size({"width": 1280, "height": 400})
    opened.tab.locator("#charts").evaluate("(charts) => charts.scrollTo(0, 0)")
    opened.tab.evaluate("looks.waitUntilHidden", "#free")
    opened.press("Space")
    opened.enter("theta", "0.9")
    motion = read_motion(opened.read_events()[-1])
    energy = motion.top.energy(motion.start)
    opened.until(lambda: f"energy E{energy:.6g} J, constant" in opened.say("constants"))
    opened.until(lambda: opened.say("free-values").startswith("tilt theta 0.9 rad"))
    opened.tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert "0.9" in opened.tab.evaluate("document.querySelector('#free svg').textContent")


def test_a_page_with_its_open_charts_is_one_sheet_of_paper(opened):
    opened.tab.click("#hurry")
    opened.open_charts("theta", "phi_dot", "rule", "well", "ledger", "kinds")
    opened.tab.click("#reason summary")
    sheets = opened.tab.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b", sheets)) == 1
    opened.tab.emulate_media(media="print")
    assert opened.tab.is_visible("#headline")
    assert opened.tab.is_visible("#printed canvas")
    for name in ("#doing", "#tabs", "summary >> text=Constants"):
        assert not opened.tab.is_visible(name)


def test_a_saved_picture_has_the_sentence_and_the_labels(opened, tmp_path):
    opened.press("Space")
    opened.wait_for_frames()
    texts = []
    for name in ("", "torque"):
        if name:
            opened.show_arrows(name)
            opened.tab.locator(".label:visible", has_text=name).wait_for()
        picture = opened.save("Picture (PNG)", tmp_path).read_bytes()
        # the words of the legend have the colour of the label
        color = opened.tab.evaluate(
            "getComputedStyle(document.querySelector('[data-layer=torque] .word')).color"
        )
        arguments = [base64.b64encode(picture).decode(), color]
        texts.append(opened.tab.evaluate("looks.countPixels", arguments))
    (height, before), (_, after) = texts
    assert height > opened.tab.locator("#picture").bounding_box()["height"] + 20
    assert before == 0  # nothing is drawn here but texts
    assert after > 50


def test_a_key_makes_text_large_and_it_stays(opened):
    def read():
        name = "getComputedStyle(document.getElementById('headline')).fontSize"
        return float(opened.tab.evaluate(name)[:-2])

    before = read()
    opened.press("p")
    assert read() >= 1.5 * before
    opened.until(lambda: opened.is_stored("size", "projector"))
    opened.reload()
    opened.until(lambda: read() >= 1.5 * before)
    opened.press("p")
    assert read() == before
