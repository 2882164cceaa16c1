"""The bars of the outer ring and of the stand, against torques and impulses of the library."""

import re

import pytest
from page.web.opened import read_motion

from symtop_ros.physics import gimbal_shares

NUMBER = r"([\d.]+(?:e-\d+)?)"
LABEL = re.compile(rf"outer ring: {NUMBER} (N m(?: s)?); stand: {NUMBER} N m")


def read_bars(page):
    """Return the numbers of ring and stand with their unit, and the widths of their bars."""
    label = page.tab.get_attribute("#hand svg", "aria-label")
    ring, unit, stand = LABEL.search(label).groups()
    widths = [float(page.tab.get_attribute(f"#hand-{name}", "width")) for name in ("ring", "stand")]
    return float(ring), float(stand), unit, widths


def open_hand(page):
    page.tab.click("#hand-chart > summary")
    page.tab.wait_for_selector("#hand-ring", state="attached")
    page.wait_for_frames()


def test_without_a_hand_there_is_no_chart_of_it(open_page):
    page = open_page("#theta=0.5&psi_dot=200")
    assert not page.tab.is_visible("#hand-chart")


@pytest.mark.wording
def test_of_a_push_ring_and_stand_have_the_shares_of_its_impulse(open_page):
    page = open_page("#theta=0.5&psi_dot=200&precession=slow")
    page.tab.click("text=Pause")
    page.tab.click("#hurry")
    open_hand(page)
    start, kick = (read_motion(each) for each in page.read_events()[-2:])
    before = start.at(page.read_events()[-1]["time"])
    top = kick.top
    shares = gimbal_shares(top.angular_momentum(kick.start) - top.angular_momentum(before))
    ring, stand, unit, widths = read_bars(page)
    assert unit == "N m s"
    assert (ring, stand) == pytest.approx((abs(shares.ring), shares.stand), rel=5e-3)
    assert widths[0] / widths[1] == pytest.approx(ring / stand, rel=0.02)


@pytest.mark.wording
def test_while_the_precession_is_held_the_bars_follow_the_torque_of_the_hand(open_page):
    page = open_page("#theta=0.5&psi_dot=200&precession=slow")
    page.tab.click("text=Pause")
    page.press("c")
    page.until(lambda: page.read_events()[-1]["kind"] == "clamp")
    open_hand(page)
    assert read_bars(page)[:3] == (0.0, 0.0, "N m")  # at rest there is nothing to turn
    page.tab.click("[data-act=step]")
    page.until(lambda: read_bars(page)[1] > 0)
    run = page.read_run()
    held = read_motion(run["events"][-1])
    passed = run["end"] - run["events"][-1]["time"]
    ring, stand, _, widths = read_bars(page)
    shares = gimbal_shares(held.added_torque(held.at(passed)))
    assert (ring, stand) == pytest.approx((abs(shares.ring), shares.stand), rel=5e-3)
    assert 0 < widths[0] < widths[1]  # the axle is steeper than 45 degrees
