"""The picture is lost and comes back; texts are those of now, in sight or not."""

import base64
import re

from web.opened import FEW_FRAMES, read_motion

LOSE = """() => {
    window.lost = document.querySelector("canvas").getContext("webgl2")
        .getExtension("WEBGL_lose_context");
    window.lost.loseContext();
}"""


def count_colors(opened):
    """Return how many colours the picture has: one if nothing is drawn."""
    return opened.tab.evaluate(
        """() => {
            const gl = document.querySelector("canvas").getContext("webgl2");
            const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
            const pixels = new Uint8Array(4 * width * height);
            gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            return new Set(new Uint32Array(pixels.buffer)).size;
        }"""
    )


def test_a_lost_picture_is_said_and_comes_back(open_page):
    opened = open_page(script=FEW_FRAMES)
    opened.show_arrows("torque", "L")
    labels = opened.tab.locator(".label:visible")
    opened.until(lambda: labels.count() > 1 and count_colors(opened) > 50)
    opened.tab.evaluate(LOSE)
    opened.until(lambda: opened.tab.is_visible("#picture-lost"))
    assert opened.say("picture-lost").startswith("the picture is lost")
    opened.until(lambda: labels.count() == 0)
    opened.press("h")
    assert "higher" in opened.say("headline")
    opened.tab.evaluate("window.lost.restoreContext()")
    opened.until(lambda: not opened.tab.is_visible("#picture-lost"))
    opened.until(lambda: labels.count() > 1 and count_colors(opened) > 50)


def test_texts_out_of_sight_are_those_of_now(opened):
    opened.tab.set_viewport_size({"width": 1280, "height": 400})
    opened.tab.locator("#charts").evaluate("(charts) => charts.scrollTo(0, 0)")
    opened.until(lambda: opened.say("free-values"))
    opened.press("Space")
    before = opened.say("free-values")
    opened.enter("theta", "0.9")
    motion = read_motion(opened.read_events()[-1])
    energy = motion.top.energy(motion.start)
    opened.until(lambda: f"energy E{energy:.6g} J, constant" in opened.say("constants"))
    opened.until(lambda: opened.say("free-values") != before)
    assert opened.say("free-values").startswith("tilt theta 0.9 rad")


# The page watches its charts in the same way, and since before: it is told first.
KNOWN_TO_BE_OUT_OF_SIGHT = """() => new Promise((done) => new IntersectionObserver(([chart]) => {
  if (!chart.isIntersecting) done();
}).observe(document.querySelector("#free")))"""


def test_a_printer_gets_the_charts_of_now(opened):
    opened.tab.set_viewport_size({"width": 1280, "height": 400})
    opened.tab.evaluate(KNOWN_TO_BE_OUT_OF_SIGHT)
    opened.press("Space")
    opened.enter("theta", "0.9")
    opened.until(lambda: opened.say("free-values").startswith("tilt theta 0.9 rad"))
    opened.tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    ticks = opened.tab.evaluate("document.querySelector('#free svg').textContent")
    assert "0.9" in ticks


def test_a_page_with_its_open_charts_is_one_sheet_of_paper(opened):
    opened.tab.click("#hurry")
    opened.open_charts("theta", "phi_dot", "rule", "well", "ledger", "kinds")
    opened.tab.click("#reason summary")
    sheets = opened.tab.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b", sheets)) == 1
    opened.tab.emulate_media(media="print")
    assert opened.tab.is_visible("#headline")
    assert opened.tab.is_visible("canvas")
    for name in ("#doing", "#tabs", "summary >> text=Constants"):
        assert not opened.tab.is_visible(name)


# The size of a saved picture, and how many of its pixels have the colour of an arrow's frame.
COUNT = """async ([text, color]) => {
    const picture = new Image();
    picture.src = `data:image/png;base64,${text}`;
    await picture.decode();
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: picture.width, height: picture.height });
    const context = canvas.getContext("2d");
    context.drawImage(picture, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const wanted = [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16));
    let count = 0;
    for (let k = 0; k < data.length; k += 4)
        count += wanted.every((each, n) => data[k + n] === each);
    return [picture.height, count];
}"""


def test_a_saved_picture_has_the_sentence_and_the_labels(opened, tmp_path):
    opened.press("Space")
    texts = []
    for name in ("", "torque"):
        if name:
            opened.show_arrows(name)
            opened.tab.locator(".label:visible", has_text=name).wait_for()
        picture = opened.save("Picture (PNG)", tmp_path).read_bytes()
        color = opened.tab.evaluate(
            "getComputedStyle(document.documentElement).getPropertyValue('--torque')"
        )
        arguments = [base64.b64encode(picture).decode(), color]
        texts.append(opened.tab.evaluate(COUNT, arguments))
    (height, before), (_, after) = texts
    assert height > opened.tab.locator("canvas").bounding_box()["height"] + 20
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
