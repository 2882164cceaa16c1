"""Turning circles, the energy and its well follow a motion with friction or a torque."""

import math
import re

import numpy as np
import pytest
from web.opened import FEW_FRAMES, UNDRAWN
from web.test_page_numbers import NUMBER, Shown, is_rounded

# Two circles of 96 pieces, of six corners with eight numbers each; keeps the heights of all points.
CIRCLES = """
const load = WebGL2RenderingContext.prototype.bufferData;
window.circles = [];
WebGL2RenderingContext.prototype.bufferData = function (target, numbers, ...rest) {
    if (numbers.length === 2 * 96 * 6 * 8) {
        const circles = [0, 1].map((n) => [...Array(96).keys()].map((k) =>
            numbers[(n * 96 + k) * 48 + 2]));
        const areLevel = circles.every((all) => all.every((each) => each === all[0]));
        if (areLevel) window.circles = circles.map((all) => all[0]); // and no trace
    }
    load.call(this, target, numbers, ...rest);
};
"""
READ = """() => ({
    circles: window.circles,
    ticks: [...document.querySelectorAll("#well text.tick[text-anchor=end]")]
        .map((each) => [Number(each.textContent), Number(each.getAttribute("y")) - 3]),
    level: document.querySelector("#well path[stroke='var(--gold)']").getAttribute("d"),
    dot: document.querySelector("#well circle").getAttribute("cy"),
    named: [...document.querySelectorAll("#well text.tick[text-anchor=middle]")]
        .map((each) => each.textContent),
    curve: document.querySelector("#potential").getAttribute("d"),
})"""
SINGLE = 2.0**-23  # a coordinate of the scene, rounded
TENTH = 0.1001  # units of a chart: two coordinates are written in tenths, of a level and of a tick


class Drawn:
    """The circles and the well that are shown, and those that follow from the drawn state."""

    def __init__(self, page):
        self.found = page.tab.evaluate(READ)
        self.shown = Shown(page)
        top, state, angles = self.shown.top, self.shown.state, self.shown.free.turning_angles
        spin = top.Iz * float(state.angular_velocity[2]) ** 2 / 2
        self.rest, self.angles = float(top.energy(state)) - spin, angles

    def measure(self, height):
        """The energy at a height of the chart, and how far off it may be."""
        (first, lowest), (last, highest) = self.found["ticks"][0], self.found["ticks"][-1]
        scale = (last - first) / (highest - lowest)
        return first + scale * (height - lowest), 2 * TENTH * abs(scale)

    def is_right(self):
        """Circles, level, dot and names are those of the state."""
        cosines = [math.cos(each) for each in self.angles]
        circles = self.found["circles"]
        energy, error = self.measure(float(re.match(r"M44 ([\d.]+)H", self.found["level"])[1]))
        named = [re.match(NUMBER, each)[0] for each in self.found["named"]]
        named_angles = self.angles if len(named) == 2 else [sum(self.angles) / 2]
        return (
            len(circles) == 2
            and all(abs(a - b) <= SINGLE for a, b in zip(circles, cosines, strict=True))
            and abs(energy - self.rest) <= error
            and abs(self.measure(float(self.found["dot"]))[0] - self.rest) <= error
            and all(is_rounded(*each) for each in zip(named, named_angles, strict=True))
        )


def is_right(page):
    try:
        Shown(page).check(page)
    except AssertionError:
        return False
    return Drawn(page).is_right()


def wait_until_right(page, seconds):
    """Wait until the page shows a time, and all that follows from the state at it."""
    page.until(lambda: float(page.tab.get_attribute("body", "data-time")) == seconds)
    page.until(lambda: is_right(page))
    return Drawn(page)


def has_followed(page, before):
    """Return True if the circles of a page that runs are nearer to those of now than of before."""
    drawn = Drawn(page)
    now, found = np.cos(drawn.angles), np.array(drawn.found["circles"])
    return (np.abs(found - now) < np.abs(found - before)).all()


@pytest.mark.parametrize("scene", ["friction", "vertical_torque"])
def test_circles_and_energy_are_those_of_a_driven_state_after_waiting_and_a_seek(open_page, scene):
    page = open_page(f"#scene={scene}", script=FEW_FRAMES + UNDRAWN + CIRCLES)
    page.open_charts("well")
    page.tab.locator("#well > svg").scroll_into_view_if_needed()
    page.tab.select_option("#speed", "1")
    before = page.tab.evaluate(READ)["circles"]
    page.wait_for_time(1.0)
    page.until(lambda: has_followed(page, before))
    page.press("Space")
    end = page.read_run()["end"]
    late = wait_until_right(page, end)
    page.seek(0.3)
    early = wait_until_right(page, 0.3)
    assert early.found["circles"] != late.found["circles"]
    assert not np.isclose(early.rest, late.rest, rtol=1e-3)
    page.seek(end)
    assert wait_until_right(page, end).found == late.found
