"""Turning circles and the well of the energy follow a motion with friction or a torque."""

import re

import numpy as np
import pytest
from web.opened import USUAL
from web.test_page_charts import read_axis
from web.test_page_numbers import NUMBER, Shown, is_rounded

SINGLE = 2.0**-23  # a coordinate of the scene, rounded
TENTH = 0.1001  # units of a chart: two coordinates are written in tenths, of a level and of a tick


def is_right(page, seconds):
    """Return True if all that is shown is that of a time, circles of the state at it included."""
    shown = Shown(page)
    try:
        shown.check(page)
    except AssertionError:
        return False
    circles, cosines = page.tab.evaluate("window.circles"), np.cos(shown.free.turning_angles)
    are_right = len(circles) == 2 and np.abs(circles - cosines).max() <= SINGLE
    return are_right and float(page.tab.get_attribute("body", "data-time")) == seconds


def read_well(page):
    """What the well shows: the energy of the state but for its spin, and the turning angles."""
    (*heights, names, curve), shown = page.tab.evaluate("looks.readWell"), Shown(page)
    first, lowest, scale = read_axis(page, "well")
    spin = shown.top.Iz * shown.state.angular_velocity[2] ** 2 / 2
    found = first + scale * (np.array(heights) - lowest)
    assert np.abs(found - (shown.top.energy(shown.state) - spin)).max() <= 2 * TENTH * abs(scale)
    angles = shown.free.turning_angles
    angles = angles if len(names) == 2 else [sum(angles) / 2]  # one name stands for both
    for name, angle in zip(names, angles, strict=True):
        assert is_rounded(re.match(NUMBER, name)[0], angle)
    return [*heights, curve]


@pytest.mark.parametrize(
    "scene", ["friction", pytest.param("vertical_torque", marks=pytest.mark.long)]
)
def test_circles_and_energy_are_those_of_a_driven_state_after_waiting_and_a_seek(open_page, scene):
    page = open_page(f"#scene={scene}", script=USUAL + "patches.keepCircles();")
    page.open_charts("well")
    page.tab.locator("#well > svg").scroll_into_view_if_needed()
    page.tab.select_option("#speed", "1")
    page.wait_for_time(1.0)
    page.press("Space")
    end, wells = page.read_run()["end"], []
    for time in (end, 0.3, end):
        page.seek(time)
        page.until(lambda time=time: is_right(page, time))
        page.wait_for_frames()
        wells.append(read_well(page))
    first, early, last = wells
    assert first == last != early
