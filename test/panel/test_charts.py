"""Charts of the page: what hardly changes is a line, and not its rounding."""

import re
import time

import numpy as np
import pytest
from browser import running_browser

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.physics import regular_precession_rates

TIMEOUT = 20.0  # s
HEIGHT = 70.0  # of a chart between its axes, in units of its drawing
LEAST = 0.019  # of a quantity; a chart spans 2 % of it at least, and its ticks are rounded


@pytest.fixture(scope="module", name="charts")
def _charts():
    """The charts of a page, without its scene, which takes long to draw here."""
    page = Page(LocalTop("regular_precession", factor=0.1), LOCAL_HOST, 0)
    try:
        with running_browser() as browser:
            tab = browser.new_page(viewport={"width": 1280, "height": 720})
            tab.set_default_timeout(TIMEOUT * 1000)
            tab.route("**/scene?*", lambda route: route.fulfill(body="<title>scene</title>"))
            tab.goto(page.server.url)
            tab.locator("#psi_dot svg").wait_for()
            yield page, tab
    finally:
        page.close()


def until(tab, condition):
    deadline = time.monotonic() + TIMEOUT
    while not condition():
        assert time.monotonic() < deadline
        tab.wait_for_timeout(50)


def read_chart(tab, name):
    """Values of the curve of a chart, and the span of its axis, by the labels of its ticks."""
    ticks = tab.locator(f"#{name} text.tick[text-anchor=end]").evaluate_all(
        "all => all.map(e => [Number(e.textContent), Number(e.getAttribute('y')) - 3])"
    )
    (first, lowest), (last, highest) = ticks[0], ticks[-1]
    assert lowest != highest
    scale = (last - first) / (highest - lowest)
    (curve, *_) = tab.locator(f"#{name} path[stroke-width='1.8']").evaluate_all(
        "all => all.map(e => e.getAttribute('d'))"
    )
    heights = np.array([float(y) for y in re.findall(r"[ML][-\d.]+ ([-\d.]+)", curve)])
    return first + scale * (heights - lowest), abs(scale) * HEIGHT


def is_level(chart, size):
    """Return True for a level curve at a value: its coordinates are written in tenths."""
    values, span = chart
    tenth = 0.1001 * span / HEIGHT
    return len(values) > 5 and np.ptp(values) <= tenth and abs(values[-1] - size) <= tenth


@pytest.mark.parametrize("root", ["slow", "fast"])
def test_in_regular_precession_every_chart_spans_a_part_of_its_quantity(charts, root):
    page, tab = charts
    page.actions.start({"theta": 0.5, "psi_dot": 200.0, "precession": root})
    rates = regular_precession_rates(page.run.motion.top, 0.5, 200.0)
    sizes = {"theta": 0.5, "phi_dot": rates[root == "fast"], "psi_dot": 200.0}
    for name, size in sizes.items():
        until(tab, lambda name=name, size=size: is_level(read_chart(tab, name), size))
        _, span = read_chart(tab, name)
        assert span > LEAST * size, name


def test_what_changes_fills_its_chart(charts):
    page, tab = charts
    page.actions.start({"theta": 0.5, "psi_dot": 200.0, "phi_dot": 0.0})

    def is_filled(name):
        values, span = read_chart(tab, name)
        return np.ptp(values) > 0.8 * span

    for name in ("theta", "phi_dot"):
        until(tab, lambda name=name: is_filled(name))
