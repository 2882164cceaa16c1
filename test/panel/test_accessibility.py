"""The page for people on phones, with zoom, with a keyboard or a screen reader, in the dark."""

import contextlib
import re
import time
from itertools import combinations

import numpy as np
import pytest
from browser import running_browser

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.web.page import FOLDER
from symtop_ros.web.scene import COLORS, FICTITIOUS_COLORS

TIMEOUT = 20.0  # s
TABS = ("Top", "Push", "History", "View", "Save", "Lesson")
# Windows of a laptop, a tablet held upright, a phone, and the laptop with a zoom of 200 %
SIZES = ((1280, 720), (820, 1180), (390, 844), (640, 360))


@pytest.fixture(scope="module", name="page")
def _page():
    page = Page(LocalTop("hurry_slow", factor=0.1), LOCAL_HOST, 0)
    yield page
    page.close()


@pytest.fixture(scope="module", name="browser")
def _browser():
    with running_browser() as browser:
        yield browser


@contextlib.contextmanager
def opened(browser, page, size=SIZES[0], **options):
    """The page in a window, without its scene, which has no words and is slow to draw here."""
    width, height = size
    tab = browser.new_page(viewport={"width": width, "height": height}, **options)
    tab.set_default_timeout(TIMEOUT * 1000)
    tab.route("**/scene?*", lambda route: route.fulfill(body="<!doctype html><title>scene</title>"))
    tab.goto(page.server.url)
    tab.wait_for_selector("#headline:not(:empty)")
    yield tab
    tab.close()


def until(tab, condition):
    """Wait, while the browser works, until a condition holds."""
    deadline = time.monotonic() + TIMEOUT
    while not condition():
        assert time.monotonic() < deadline
        tab.wait_for_timeout(20)


@pytest.mark.parametrize("scheme", [pytest.param("light", marks=pytest.mark.long), "dark"])
def test_there_is_no_serious_finding_of_axe(browser, page, scheme):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    with opened(browser, page, color_scheme=scheme) as tab:
        assert tab.locator("html").get_attribute("data-theme") == scheme
        for name in TABS:
            tab.get_by_role("tab", name=name).click()
            check(axe, tab)
        tab.get_by_role("tab", name="Top").click()
        tab.get_by_role("textbox", name="Ix").fill("x")
        tab.get_by_role("textbox", name="Ix").press("Enter")
        tab.locator("#refusal").wait_for()
        check(axe, tab)


def check(axe, tab):
    found = axe.run(tab).response["violations"]
    serious = [each for each in found if each["impact"] in ("serious", "critical")]
    assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in serious] == []


@pytest.mark.parametrize("size", SIZES)
def test_hurry_and_the_scene_are_in_the_window_and_the_charts_in_reach(browser, page, size):
    width, height = size
    with opened(browser, page, size) as tab:
        scene, hurry = (tab.locator(name).bounding_box() for name in ("iframe", "#hurry"))
        for box in (scene, hurry):
            assert box["x"] >= 0
            assert box["y"] >= 0
            assert box["x"] + box["width"] <= width + 0.5
            assert box["y"] + box["height"] <= height + 0.5
        assert min(scene["width"], scene["height"]) > 0.25 * min(width, height)
        apart = (
            hurry["y"] >= scene["y"] + scene["height"] - 0.5
            or hurry["x"] + hurry["width"] <= scene["x"] + 0.5
        )
        assert apart
        assert tab.evaluate("document.documentElement.scrollWidth") <= width
        for name in ("#psi_dot", "#constants"):
            tab.locator(name).scroll_into_view_if_needed()
            box = tab.locator(name).bounding_box()
            assert box["y"] < height
            assert box["width"] > 150
        after = tab.locator("#hurry").bounding_box()
        assert after == hurry  # it does not scroll away


def test_a_page_that_prefers_no_motion_begins_at_rest(browser, page):
    with opened(browser, page, reduced_motion="reduce") as tab:
        tab.get_by_role("button", name="Run", exact=True).wait_for()
        assert not page.run.segment.running
        tab.get_by_role("button", name="Run", exact=True).click()
        tab.get_by_role("button", name="Pause", exact=True).wait_for()


def test_a_keyboard_reaches_the_scenes_and_the_tabs(browser, page):
    with opened(browser, page) as tab:
        tab.get_by_role("tab", name="Top").focus()
        tab.keyboard.press("ArrowRight")
        assert tab.get_by_role("tabpanel", name="Push").is_visible()
        tab.keyboard.press("ArrowLeft")
        tab.get_by_role("combobox", name="scene").select_option("A slow top falls")
        tab.locator("#story").filter(has_text="little spin").wait_for()
        until(tab, lambda: page.run.motion.start.euler_rates.psi == pytest.approx(60.0))
        tab.get_by_role("button", name="Reset").focus()
        tab.keyboard.press("Space")  # presses the button that has the focus
        until(tab, lambda: page.run.segment.running)


def test_angles_are_shown_and_typed_in_degrees(browser, page):
    with opened(browser, page) as tab:
        tab.get_by_role("tab", name="View").click()
        tab.get_by_label("angles in").select_option("degrees")
        tab.get_by_role("tab", name="Top").click()
        field = tab.get_by_role("textbox", name="tilt theta (\u00b0)")
        field.fill("30")
        field.press("Enter")
        headline = tab.locator("#headline")
        before = headline.inner_text()
        for _ in range(100):
            if headline.inner_text() != before:
                break
            tab.wait_for_timeout(50)
        assert headline.inner_text() == page.pages.facts["degrees"]["headline"]
        assert page.run.motion.start.euler_angles.theta == pytest.approx(np.pi / 6, abs=1e-12)


# Of people who see no green (Machado, Oliveira and Fernandes 2009, severity 1), in linear RGB.
DEUTERANOPIA = np.array(
    [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]
)
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def to_lab(color):
    """CIE L*a*b* of a colour (sRGB, 0 to 255) as it is seen with deuteranopia."""
    share = np.array(color) / 255
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    x, y, z = np.cbrt(XYZ @ (DEUTERANOPIA @ linear).clip(0, 1) / (0.9505, 1.0, 1.089))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize(
    "colors", [[COLORS[name] for name in ("L", "omega", "torque")], [*FICTITIOUS_COLORS.values()]]
)
def test_the_arrows_are_of_different_colours_without_seeing_green(colors):
    distances = [np.linalg.norm(to_lab(a) - to_lab(b)) for a, b in combinations(colors, 2)]
    assert min(distances) > 35  # 2.3 can just be seen; omega and the torque had 30 before


def test_the_legend_has_the_colours_of_the_arrows():
    legend = (FOLDER / "page.js").read_text().partition("const LEGEND")[2].partition(";\n")[0]
    shown = [tuple(bytes.fromhex(color)) for color in re.findall(r'"#(\w{6})"', legend)]
    for color in (COLORS["L"], COLORS["omega"], COLORS["torque"], *FICTITIOUS_COLORS.values()):
        assert color in shown
