"""No text of the page is cut off or covered: all panels, charts and steps of the lesson."""

from pathlib import Path

import pytest
from other_browsers import running_firefox, running_webkit, until
from page.web.opened import UNDRAWN
from trials import choose

from symtop_ros.page.web.join import LANGUAGES

CUTS = Path(__file__).with_name("cuts.js").read_text()
# A laptop, a tablet held upright, a phone, and a laptop with a zoom of 200 %.
WINDOWS = ((1280, 720), (820, 1180), (390, 844), (640, 360))
WIDE_SPACES = "letter-spacing: 0.12em; word-spacing: 0.16em; line-height: 1.5;"  # WCAG 1.4.12
LONG = "Compared with no push the highest point is 3.55 degrees higher, the lowest one is the same."


@pytest.mark.slow
@pytest.mark.parametrize("size", WINDOWS)
@pytest.mark.parametrize("language", choose(LANGUAGES, ["de"]))
def test_no_text_is_cut_off_or_covered(open_page, language, size):
    width, height = size
    window = {"viewport": {"width": width, "height": height}}
    page = open_page(f"#lang={language}", script=UNDRAWN, **window)
    page.tab.evaluate(CUTS)
    assert page.tab.evaluate("cuts.walk()") == {}


@pytest.mark.long
@pytest.mark.parametrize("running", [running_firefox, running_webkit])
def test_no_text_is_cut_off_or_covered_in_other_browsers(running, path):
    found = {}
    for size in WINDOWS:  # one browser for each: the page was not there before
        with running() as driver:
            driver.open(path.as_uri() + "#theta=0.5&psi_dot=200&precession=slow")
            driver.resize(*size)
            until(driver, "document.querySelector('#headline')?.textContent")
            driver.run(CUTS)
            faults = driver.run("return await cuts.walk();")
            found |= {(fault, size): where for fault, where in faults.items()}
    assert not found, "\n".join(f"{each}: {where}" for each, where in found.items())


@pytest.mark.parametrize("size", choose(WINDOWS, WINDOWS[3:]))
def test_the_reason_can_be_asked_for_under_a_long_headline_with_wide_spaces(open_page, size):
    width, height = size
    page = open_page(viewport={"width": width, "height": height})
    page.tab.evaluate(
        """([style, text]) => {
            const sheet = new CSSStyleSheet();
            sheet.replaceSync(`* { ${style} }`);
            document.adoptedStyleSheets = [sheet];
            document.getElementById("headline").textContent = text;
        }""",
        [WIDE_SPACES, 2 * LONG],
    )
    strip, reason = (
        page.tab.locator(name).bounding_box() for name in ("#strip", "#reason > summary")
    )
    assert reason["y"] >= strip["y"]
    assert reason["y"] + reason["height"] <= strip["y"] + strip["height"]
    assert reason["x"] + reason["width"] <= strip["x"] + strip["width"]
