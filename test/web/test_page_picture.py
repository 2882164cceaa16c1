"""The picture is lost and comes back; texts are those of now, in sight or not."""

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
