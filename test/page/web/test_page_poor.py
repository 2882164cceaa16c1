"""The page in browsers of a school machine: without WebGL 2, and without WebAssembly."""

import math
import re

import pytest
from page.web.opened import KNOWN, UNDRAWN, read_motion

NO_PICTURE = """
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...rest);
};
"""
# Drivers exist that give a context and compile nothing.
NO_PROGRAMS = UNDRAWN + "WebGL2RenderingContext.prototype.getProgramParameter = () => false;"
NO_WEBASSEMBLY = (
    "delete globalThis.WebAssembly;",
    "WebAssembly.instantiate = () => Promise.reject(new Error('forbidden'));",
)
MIDDLE = 150.0, 115.0  # of the drawing


def read_circles(page):
    """Radii of the dashed circles, and the tilts that stand at them, in rad."""
    radii = page.tab.locator("#plain circle[stroke-dasharray]").evaluate_all(
        "all => all.map((each) => Number(each.getAttribute('r')))"
    )
    texts = page.tab.locator("#plain text").all_text_contents()
    return radii, [float(re.match(r"[\d.]+", text)[0]) for text in texts]


def read_place(x, y, scale):
    """The tilt, and the direction of a place of the drawing: east is that of x."""
    right, up = x - MIDDLE[0], MIDDLE[1] - y
    return math.hypot(right, up) * scale, math.atan2(up, right)


@pytest.mark.slow
@pytest.mark.parametrize("script", [NO_PICTURE, NO_PROGRAMS], ids=["no WebGL", "no programs"])
def test_without_a_picture_the_way_of_the_axle_is_drawn_and_all_else_works(open_page, script):
    page = open_page("#theta=0.5&psi_dot=200&phi_dot=-3", script=script, known=KNOWN)
    said = page.say("picture-lost")
    assert said.startswith("this browser draws no 3D picture: WebGL 2 is missing or blocked")
    page.wait_for_time(0.25)
    page.tab.click("#hurry")
    page.tab.click("#pause")
    page.wait_for_frames(3)
    assert page.say("picture-lost") == said  # no act takes it away
    assert not page.tab.is_visible("#refusal")
    radii, tilts = read_circles(page)
    scale = tilts[-1] / radii[-1]  # rad per unit of the drawing
    event = page.read_events()[-1]
    motion = read_motion(event)
    assert tilts == pytest.approx(motion.turning_angles, abs=0.0006)  # of three decimals
    assert [radius * scale for radius in radii] == pytest.approx(tilts, abs=0.002)
    time = float(page.tab.get_attribute("body", "data-time"))
    state = motion.at(time - event["time"])
    dot = page.tab.locator("#plain circle.axle")
    theta, way = read_place(*(float(dot.get_attribute(name)) for name in ("cx", "cy")), scale)
    # A unit of the drawing has one decimal.
    assert theta == pytest.approx(float(state.euler_angles.theta), abs=0.003)
    east, north, _ = state.to_world((0.0, 0.0, 1.0)).tolist()
    assert way == pytest.approx(math.atan2(north, east), abs=0.01)
    path = page.tab.get_attribute("#plain #way", "d")
    places = [tuple(map(float, each)) for each in re.findall(r"([-\d.]+) ([-\d.]+)", path)]
    assert places[-1] == pytest.approx([float(dot.get_attribute(each)) for each in ("cx", "cy")])
    for x, y in places:
        assert read_place(x, y, scale)[0] < 1.0
    page.open_charts("theta", "free")
    page.until(lambda: page.tab.locator("#theta path").count() > 1)


@pytest.mark.slow
def test_without_a_picture_the_teachers_sheet_has_the_ways_of_the_axle(open_page):
    page = open_page(script=NO_PICTURE, known=KNOWN)
    page.tab.evaluate("window.print = () => dispatchEvent(new Event('beforeprint'))")
    page.open_tab("lesson")
    page.tab.click("#print-teacher")
    assert page.tab.locator("#sheets svg").count() >= 14
    assert not page.tab.is_visible("#refusal")


@pytest.mark.parametrize("script", NO_WEBASSEMBLY)
def test_without_webassembly_the_page_says_so_for_good_and_in_its_language(browser, path, script):
    context = browser.new_context(offline=True, locale="de-DE")
    tab = context.new_page()
    tab.add_init_script(script)
    tab.goto(path.as_uri())
    tab.wait_for_selector("#lost:not([hidden])")
    said = tab.text_content("#lost")
    assert said.startswith("dieser Browser kann nicht rechnen: WebAssembly fehlt")
    assert "forbidden" not in said
    assert "not defined" not in said
    tab.mouse.click(400, 400)
    tab.keyboard.press("h")
    tab.keyboard.press("Escape")
    assert tab.text_content("#lost") == said
    controls = "button, input, select, textarea"
    assert tab.locator(controls).count() > 50
    assert tab.locator(controls).evaluate_all("all => all.every((each) => each.disabled)")
    context.close()
